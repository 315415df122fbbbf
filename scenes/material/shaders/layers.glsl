// The layers that extensions of glTF add to metallic-roughness (docs/materials.md). From the surface outward: transmission beside the diffuse part, the specular
// lobe of a reflectance of its own, sheen, clear coat. Only for materials that have one (LAYERS).
#ifdef LAYERS
struct Layers {
  vec3 f90;  // reflectance at grazing angles
#ifdef CLEARCOAT
  vec3 coat_n;
  float coat, coat_roughness, coat_alpha, coat_n_dot_v;
#endif
#ifdef SHEEN
  vec3 sheen;
  float sheen_exponent;  // 1 / squared roughness
  float under_sheen;     // what the sheen leaves to the layers below
#endif
#ifdef TRANSMISSION
  vec3 transmittance;  // what passes through; the Fresnel term and the layers above still take their part
#endif
};

float largest(vec3 v) { return max(max(v.r, v.g), v.b); }

float fifth_power(float x) {
  float x2 = x * x;
  return x2 * x2 * x;
}

// Karis' fit of the specular lobe's directional albedo: x times f0 plus y times f90.
vec2 specular_albedo(float roughness, float n_dot_v) {
  vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float a = min(r.x * r.x, exp2(-9.28 * n_dot_v)) * r.x + r.y;
  return vec2(r.z - 1.04 * a, r.w + 1.04 * a);
}

// The sky and the ground in a direction of this height, with the horizon blurred by the roughness.
vec3 sky_radiance(float up, float roughness) {
  return mix(frame.ground.rgb, frame.sky.rgb, clamp(up / (2.0 * roughness + 0.2) + 0.5, 0.0, 1.0));
}

#ifdef CLEARCOAT
// The coat's index of refraction is 1.5.
const float kCoatReflectance = 0.04;

// Trowbridge-Reitz with Hammon's visibility, as for the base.
float coat_lobe(Layers s, float n_dot_l, float n_dot_h) {
  float a2 = s.coat_alpha * s.coat_alpha;
  float d = (n_dot_h * a2 - n_dot_h) * n_dot_h + 1.0;
  return a2 * 0.5 / ((mix(2.0 * n_dot_l * s.coat_n_dot_v, n_dot_l + s.coat_n_dot_v, s.coat_alpha) + 1e-4) * d * d) * n_dot_l;
}
#endif

#ifdef SHEEN
// Charlie distribution of Estevez and Kulla with Ashikhmin's visibility, times pi.
float sheen_lobe(Layers s, float n_dot_l, float n_dot_v, float n_dot_h) {
  float sine2 = max(1.0 - n_dot_h * n_dot_h, 1e-6);
  float d = (1.0 + 0.5 * s.sheen_exponent) * pow(sine2, 0.5 * s.sheen_exponent);
  return d / (4.0 * (n_dot_l + n_dot_v - n_dot_l * n_dot_v) + 1e-4) * n_dot_l;
}

// The share of white light that the sheen lobe reflects: a fit to its integral over the hemisphere, within 0.06.
float sheen_albedo(float roughness, float n_dot_v) {
  float u = 1.0 / roughness;
  return min(exp2(-1.2685 + (0.5675 - 0.0259 * u) * u - n_dot_v * (0.2507 + (1.8346 + 0.0129 * u) * u)), 1.0);
}
#endif
#endif  // LAYERS
