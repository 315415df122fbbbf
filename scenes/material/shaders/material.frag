// Fragment shader of all materials: glTF's metallic-roughness model (its appendix B) under the scene's lights and a two-colour sky, or a map of the environment.
const float kMinAlpha = 0.002;  // squared roughness: keeps the highlight of a mirror finite

vec3 emitted() {
  vec3 color = material.emissive.rgb;
#ifdef EMISSIVE_UV
  color *= texture(emissive_texture, EMISSIVE_UV).rgb;
#endif
  return color;
}

#ifndef UNLIT
#if defined(NORMAL_UV) || defined(CLEARCOAT_NORMAL_UV)
// Moves the normal-map sample at `uv` into world space. Green points along -v, as glTF asks.
vec3 perturb(vec3 n, vec3 m, vec2 uv) {
#ifdef HAS_TANGENT
  return m.x * v_tangent.xyz + m.y * v_tangent.w * cross(n, v_tangent.xyz) + m.z * n;
#else
  // No tangents in the file: the frame that the texture coordinates span on the surface, from screen-space differences.
  vec3 px = dFdx(v_position), py = dFdy(v_position);
  vec2 tx = dFdx(uv), ty = dFdy(uv);
  vec3 across_y = cross(n, py), across_x = cross(px, n);  // window y points down, so these turn the other way than with y up
  vec3 t = across_y * tx.x + across_x * ty.x;
  vec3 b = across_y * tx.y + across_x * ty.y;
  float scale = inversesqrt(max(max(dot(t, t), dot(b, b)), 1e-30));
#ifdef DOUBLE_SIDED
  // Seen from behind, the normal points away (or, without one in the file, has been turned towards the viewer with the whole frame): t and b turn with it.
  scale = gl_FrontFacing ? scale : -scale;
#endif
  return (m.x * scale) * t - (m.y * scale) * b + m.z * n;
#endif
}
#endif

// The face's own normal, toward the viewer; not of unit length.
vec3 face_normal() { return cross(dFdy(v_position), dFdx(v_position)); }

vec3 surface_normal() {
#ifdef PARTIAL_NORMALS
  vec3 face = face_normal();
#ifdef DOUBLE_SIDED
  face = gl_FrontFacing ? face : -face;
#endif
  return normalize(dot(v_normal, v_normal) > 0.0 ? v_normal : face);
#elif defined(HAS_NORMAL)
  return normalize(v_normal);
#else
  return normalize(face_normal());
#endif
}

vec3 toward_viewer(vec3 n) {
#if defined(DOUBLE_SIDED) && defined(HAS_NORMAL)
  return gl_FrontFacing ? n : -n;
#else
  return n;
#endif
}

vec3 shading_normal() {
  vec3 n = surface_normal();
#ifdef NORMAL_UV
  vec3 m = texture(normal_texture, NORMAL_UV).xyz * 2.0 - 1.0;
  m.xy *= material.factors.z;
  n = normalize(perturb(n, m, NORMAL_UV));
#endif
  return toward_viewer(n);
}

struct Surface {
  vec3 n, v, diffuse, f0;
  float n_dot_v, alpha, roughness, occlusion;
#ifdef LAYERS
  Layers layers;
#endif
};

// Radiance that leaves toward the viewer per unit of irradiance from `l` at normal incidence, times pi and the cosine.
// Trowbridge-Reitz distribution, Smith visibility in Hammon's approximation, Schlick Fresnel.
vec3 reflect_light(Surface s, vec3 l) {
  float n_dot_l = clamp(dot(s.n, l), 0.0, 1.0);
  vec3 h = normalize(l + s.v);
  float n_dot_h = clamp(dot(s.n, h), 0.0, 1.0);
  float v_dot_h = clamp(dot(s.v, h), 0.0, 1.0);
  float a2 = s.alpha * s.alpha;
  float d = (n_dot_h * a2 - n_dot_h) * n_dot_h + 1.0;
  float visibility = 0.5 / (mix(2.0 * n_dot_l * s.n_dot_v, n_dot_l + s.n_dot_v, s.alpha) + 1e-4);
  float specular = a2 * visibility / (d * d);
  float k = 1.0 - v_dot_h;
  float k2 = k * k;
#ifndef LAYERS
  vec3 fresnel = s.f0 + (1.0 - s.f0) * (k2 * k2 * k);
  return (s.diffuse * (1.0 - fresnel) + specular * fresnel) * n_dot_l;
#else
  vec3 fresnel = s.f0 + (s.layers.f90 - s.f0) * (k2 * k2 * k);
  vec3 color = (s.diffuse * (1.0 - largest(fresnel)) + specular * fresnel) * n_dot_l;
#ifdef SHEEN
  color = color * s.layers.under_sheen + s.layers.sheen * sheen_lobe(s.layers, n_dot_l, s.n_dot_v, n_dot_h);
#endif
#ifdef CLEARCOAT
  float coat = s.layers.coat * (kCoatReflectance + (1.0 - kCoatReflectance) * (k2 * k2 * k));
  float lobe = coat_lobe(s.layers, clamp(dot(s.layers.coat_n, l), 0.0, 1.0), clamp(dot(s.layers.coat_n, h), 0.0, 1.0));
  color = mix(color, vec3(lobe), coat);
#endif
  return color;
#endif
}

// Light of the sky and the ground: irradiance is a blend by the normal's height; the reflection blurs the horizon by roughness. The directional
// albedo of the specular lobe is Karis' fit (Physically Based Shading on Mobile, 2014).
#ifdef ENVIRONMENT
// The same for a map of the environment. The diffuse part gets what the lobe leaves.
vec3 reflect_environment(inout Surface s) {
  vec3 irradiance = environment_irradiance(s.n);
  vec2 lobe = lobe_albedo(s.roughness, s.n_dot_v);
#ifdef LAYERS
  vec3 f90 = s.layers.f90;
#else
  vec3 f90 = vec3(1.0);
#endif
  vec3 once = s.f0 * lobe.x + f90 * lobe.y;
  vec3 again = again_reflected(once, s.f0, f90, lobe);
#ifdef LAYERS
  vec3 left = vec3(1.0 - min(largest(once + again), 1.0));
#else
  vec3 left = 1.0 - once - again;
#endif
  vec3 color = once * environment_radiance(mirrored(s.n, s.v, s.roughness), s.roughness) + (again + s.diffuse * left) * irradiance;
#ifdef TRANSMISSION
  s.layers.transmittance *= left;
#endif
#ifdef SHEEN
  float sheen = sheen_albedo(inversesqrt(s.layers.sheen_exponent), s.n_dot_v);
  color = color * s.layers.under_sheen + s.layers.sheen * (sheen * irradiance);
#ifdef TRANSMISSION
  s.layers.transmittance *= s.layers.under_sheen;
#endif
#endif
#ifdef CLEARCOAT
  vec2 coat_lobe = lobe_albedo(s.layers.coat_roughness, s.layers.coat_n_dot_v);
  float coat = s.layers.coat * (kCoatReflectance * coat_lobe.x + coat_lobe.y);
  color = mix(color, environment_radiance(mirrored(s.layers.coat_n, s.v, s.layers.coat_roughness), s.layers.coat_roughness), coat);
#ifdef TRANSMISSION
  s.layers.transmittance *= 1.0 - coat;
#endif
#endif
  return color * s.occlusion;
}
#elif !defined(LAYERS)
vec3 reflect_environment(Surface s) {
  vec3 irradiance = mix(frame.ground.rgb, frame.sky.rgb, s.n.y * 0.5 + 0.5);
  float up = 2.0 * dot(s.n, s.v) * s.n.y - s.v.y;
  vec3 radiance = mix(frame.ground.rgb, frame.sky.rgb, clamp(up / (2.0 * s.roughness + 0.2) + 0.5, 0.0, 1.0));
  vec4 r = s.roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float a = min(r.x * r.x, exp2(-9.28 * s.n_dot_v)) * r.x + r.y;
  vec3 specular = s.f0 * (r.z - 1.04 * a) + (r.w + 1.04 * a);
  return (s.diffuse * irradiance + specular * radiance) * s.occlusion;
}
#else
// The same with layers. The outer ones take from the inner ones, and from what passes through, the share that they reflect themselves.
vec3 reflect_environment(inout Surface s) {
  vec3 irradiance = mix(frame.ground.rgb, frame.sky.rgb, s.n.y * 0.5 + 0.5);
  vec2 lobe = specular_albedo(s.roughness, s.n_dot_v);
  vec3 specular = s.f0 * lobe.x + s.layers.f90 * lobe.y;
  vec3 color = s.diffuse * irradiance + specular * sky_radiance(2.0 * dot(s.n, s.v) * s.n.y - s.v.y, s.roughness);
#ifdef TRANSMISSION
  s.layers.transmittance *= 1.0 - min(largest(specular), 1.0);
#endif
#ifdef SHEEN
  float sheen = sheen_albedo(inversesqrt(s.layers.sheen_exponent), s.n_dot_v);
  color = color * s.layers.under_sheen + s.layers.sheen * (sheen * irradiance);
#ifdef TRANSMISSION
  s.layers.transmittance *= s.layers.under_sheen;
#endif
#endif
#ifdef CLEARCOAT
  vec2 coat_lobe = specular_albedo(s.layers.coat_roughness, s.layers.coat_n_dot_v);
  float coat = s.layers.coat * (kCoatReflectance * coat_lobe.x + coat_lobe.y);
  float up = 2.0 * dot(s.layers.coat_n, s.v) * s.layers.coat_n.y - s.v.y;
  color = mix(color, sky_radiance(up, s.layers.coat_roughness), coat);
#ifdef TRANSMISSION
  s.layers.transmittance *= 1.0 - coat;
#endif
#endif
  return color * s.occlusion;
}
#endif

#if POINT_LIGHTS + SPOT_LIGHTS > 0
// Inverse square with the smooth cut at the range that KHR_lights_punctual recommends.
float attenuation(Light light, float distance_squared) {
  float x = distance_squared * light.position.w * light.position.w;
  return clamp(1.0 - x * x, 0.0, 1.0) / max(distance_squared, 1e-4);
}
#endif

// Lights come in the order directional, point, spot; every intensity is divided by pi on the host.
vec3 reflect_lights(Surface s) {
  vec3 sum = vec3(0.0);
  LOOP_HINT for (int i = 0; i < DIRECTIONAL_LIGHTS; ++i) sum += frame.lights[i].color.rgb * reflect_light(s, frame.lights[i].direction.xyz);
#if POINT_LIGHTS > 0
  LOOP_HINT for (int i = DIRECTIONAL_LIGHTS; i < DIRECTIONAL_LIGHTS + POINT_LIGHTS; ++i) {
    vec3 to_light = frame.lights[i].position.xyz - v_position;
    float distance_squared = dot(to_light, to_light);
    sum += frame.lights[i].color.rgb * (attenuation(frame.lights[i], distance_squared) * reflect_light(s, to_light * inversesqrt(max(distance_squared, 1e-12))));
  }
#endif
#if SPOT_LIGHTS > 0
  LOOP_HINT for (int i = DIRECTIONAL_LIGHTS + POINT_LIGHTS; i < DIRECTIONAL_LIGHTS + POINT_LIGHTS + SPOT_LIGHTS; ++i) {
    vec3 to_light = frame.lights[i].position.xyz - v_position;
    float distance_squared = dot(to_light, to_light);
    vec3 l = to_light * inversesqrt(max(distance_squared, 1e-12));
    float cone = clamp(dot(frame.lights[i].direction.xyz, l) * frame.lights[i].cone.x + frame.lights[i].cone.y, 0.0, 1.0);
    sum += frame.lights[i].color.rgb * (attenuation(frame.lights[i], distance_squared) * cone * cone * reflect_light(s, l));
  }
#endif
  return sum;
}

#ifdef LAYERS
#ifdef CLEARCOAT
void add_clearcoat(inout Surface s) {
  s.layers.coat = material.clearcoat.x;
  s.layers.coat_roughness = material.clearcoat.y;
#ifdef CLEARCOAT_UV
  s.layers.coat *= texture(clearcoat_texture, CLEARCOAT_UV).r;
#endif
#ifdef CLEARCOAT_ROUGHNESS_UV
  s.layers.coat_roughness *= texture(clearcoat_roughness_texture, CLEARCOAT_ROUGHNESS_UV).g;
#endif
  vec3 n = surface_normal();
#ifdef CLEARCOAT_NORMAL_UV
  vec3 m = texture(clearcoat_normal_texture, CLEARCOAT_NORMAL_UV).xyz * 2.0 - 1.0;
  m.xy *= material.clearcoat.z;
  n = normalize(perturb(n, m, CLEARCOAT_NORMAL_UV));
#endif
  s.layers.coat_n = toward_viewer(n);
  s.layers.coat_n_dot_v = clamp(dot(s.layers.coat_n, s.v), 0.0, 1.0);
  s.layers.coat_alpha = max(s.layers.coat_roughness * s.layers.coat_roughness, kMinAlpha);
}
#endif

#ifdef SHEEN
void add_sheen(inout Surface s) {
  s.layers.sheen = material.sheen.rgb;
  float roughness = material.sheen.w;
#ifdef SHEEN_COLOR_UV
  s.layers.sheen *= texture(sheen_color_texture, SHEEN_COLOR_UV).rgb;
#endif
#ifdef SHEEN_ROUGHNESS_UV
  roughness *= texture(sheen_roughness_texture, SHEEN_ROUGHNESS_UV).a;
#endif
  roughness = max(roughness, 0.1);  // below, the lobe is too narrow to be met by a light
  s.layers.sheen_exponent = 1.0 / (roughness * roughness);
  s.layers.under_sheen = 1.0 - largest(s.layers.sheen) * sheen_albedo(roughness, s.n_dot_v);
}
#endif

#ifdef TRANSMISSION
void add_transmission(inout Surface s, vec3 base, float metallic) {
  float share = material.transmission.w;
#ifdef TRANSMISSION_UV
  share *= texture(transmission_texture, TRANSMISSION_UV).r;
#endif
  vec3 depth = material.transmission.rgb;
#ifdef THICKNESS_UV
  depth *= texture(thickness_texture, THICKNESS_UV).g;
#endif
  s.layers.transmittance = base * exp2(depth) * (share * (1.0 - metallic));
  s.diffuse *= 1.0 - share;
}
#endif

// Reflectance of the base: of a dielectric or a metal, or as specular-glossiness says.
void set_reflectance(inout Surface s, vec3 base, float metallic) {
#ifdef SPECULAR
  vec3 f0 = material.specular.rgb;
  float weight = material.specular.w;
#ifdef SPECULAR_COLOR_UV
  vec4 color = texture(specular_color_texture, SPECULAR_COLOR_UV);
  f0 *= color.rgb;
#endif
#ifdef SPECULAR_GLOSSINESS
#ifdef SPECULAR_COLOR_UV
  s.roughness = 1.0 - (1.0 - s.roughness) * color.a;
  s.alpha = max(s.roughness * s.roughness, kMinAlpha);
#endif
  s.f0 = f0;
  s.diffuse = base * (1.0 - largest(f0));
  s.layers.f90 = vec3(1.0);
#else
#ifdef SPECULAR_UV
  weight *= texture(specular_texture, SPECULAR_UV).a;
#endif
  s.f0 = mix(min(f0, 1.0) * weight, base, metallic);
  s.layers.f90 = vec3(mix(weight, 1.0, metallic));
#endif
#else
  s.layers.f90 = vec3(1.0);
#endif
}
#endif  // LAYERS

Surface surface(vec3 base) {
  Surface s;
  float metallic = material.factors.x, roughness = material.factors.y;
  s.occlusion = 1.0;
#ifdef METALLIC_ROUGHNESS_UV
  vec4 sampled = texture(metallic_roughness_texture, METALLIC_ROUGHNESS_UV);
  metallic *= sampled.b;
  roughness *= sampled.g;
#endif
#ifdef OCCLUSION_IN_METALLIC_ROUGHNESS
  s.occlusion = 1.0 + material.factors.w * (sampled.r - 1.0);
#endif
#ifdef OCCLUSION_UV
  s.occlusion = 1.0 + material.factors.w * (texture(occlusion_texture, OCCLUSION_UV).r - 1.0);
#endif
  s.n = shading_normal();
#ifdef ORTHOGRAPHIC
  s.v = frame.toward_viewer.xyz;
#else
  s.v = normalize(-v_position);
#endif
  s.n_dot_v = clamp(dot(s.n, s.v), 0.0, 1.0);
  s.roughness = roughness;
  s.alpha = max(roughness * roughness, kMinAlpha);
  s.diffuse = base * (1.0 - metallic);
  s.f0 = mix(vec3(0.04), base, metallic);
#ifdef LAYERS
  set_reflectance(s, base, metallic);
#ifdef SHEEN
  add_sheen(s);
#endif
#ifdef CLEARCOAT
  add_clearcoat(s);
#endif
#ifdef TRANSMISSION
  add_transmission(s, base, metallic);
#endif
#endif
  return s;
}
#endif  // !UNLIT

void main() {
  vec4 base = read_base_color();
  alpha_test(base.a);
#ifdef ALPHA_TO_COVERAGE
  base.a = alpha_coverage(base.a);
#endif
#ifdef UNLIT
  vec3 color = base.rgb;
#else
  Surface s = surface(base.rgb);
  vec3 color = reflect_lights(s) + reflect_environment(s);
#ifdef EMISSIVE
#ifdef CLEARCOAT
  color += emitted() * (1.0 - s.layers.coat * (kCoatReflectance + (1.0 - kCoatReflectance) * fifth_power(1.0 - s.layers.coat_n_dot_v)));
#else
  color += emitted();
#endif
#endif
#endif
#ifdef TRANSMISSION
  // Grey of the picture behind, sharp; what is missing to the colour or blurred by roughness, from the sky and the ground in that direction.
  float seen = min(min(s.layers.transmittance.r, s.layers.transmittance.g), s.layers.transmittance.b) * (1.0 - s.roughness);
#ifdef ENVIRONMENT
  color += (s.layers.transmittance - seen) * environment_radiance(-s.v, s.roughness);
#else
  color += (s.layers.transmittance - seen) * sky_radiance(-s.v.y, s.roughness);
#endif
#ifdef ALPHA_BLEND
  out_color = vec4(color * base.a, base.a * (1.0 - seen));
#else
  out_color = vec4(color, 1.0 - seen);
#endif
#elif defined(ALPHA_BLEND) || defined(ALPHA_TO_COVERAGE)
  out_color = vec4(color, base.a);
#else
  out_color = vec4(color, 1.0);
#endif
}
