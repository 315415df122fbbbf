// Illumination as lectures teach it: Phong's model of ambient, diffuse and specular light [P: Phong 1975], with Blinn's half vector [P: Blinn 1977]. It does not matter to it where it is
// evaluated, so the vertex shader uses it for Gouraud's shading and the fragment shader for Phong's.
#ifdef DIRECTIONAL_LIGHTS  // of a stage that is told of lights
const float kSpecular = 0.5;  // of the light, white; the exponent is 32

// Both are light alone: the surface's colour multiplies the first.
struct Reflected {
  vec3 diffuse, specular;
};

vec3 unit(vec3 v) { return v * inversesqrt(max(dot(v, v), 1e-30)); }

void add_light(inout Reflected sum, vec3 n, vec3 v, vec3 l, vec3 light) {
  float n_dot_l = dot(n, l);
  float n_dot_h = max(dot(n, unit(l + v)), 0.0);
  float h2 = n_dot_h * n_dot_h, h4 = h2 * h2, h8 = h4 * h4, h16 = h8 * h8;
  sum.diffuse += light * max(n_dot_l, 0.0);
  sum.specular += light * (n_dot_l > 0.0 ? kSpecular * h16 * h16 : 0.0);
}

#if POINT_LIGHTS + SPOT_LIGHTS > 0
// As in material.frag: inverse square, cut at the range.
float fading(Light light, float distance_squared) {
  float x = distance_squared * light.position.w * light.position.w;
  return clamp(1.0 - x * x, 0.0, 1.0) / max(distance_squared, 1e-4);
}
#endif

// `position` is relative to the eye, `n` of unit length.
Reflected reflect_lights(vec3 n, vec3 position) {
#ifdef ORTHOGRAPHIC
  vec3 v = frame.toward_viewer.xyz;
#else
  vec3 v = unit(-position);
#endif
  Reflected sum = Reflected(0.5 * (frame.sky.rgb + frame.ground.rgb), vec3(0.0));
  LOOP_HINT for (int i = 0; i < DIRECTIONAL_LIGHTS; ++i) add_light(sum, n, v, frame.lights[i].direction.xyz, frame.lights[i].color.rgb);
#if POINT_LIGHTS > 0
  LOOP_HINT for (int i = DIRECTIONAL_LIGHTS; i < DIRECTIONAL_LIGHTS + POINT_LIGHTS; ++i) {
    vec3 to_light = frame.lights[i].position.xyz - position;
    add_light(sum, n, v, unit(to_light), frame.lights[i].color.rgb * fading(frame.lights[i], dot(to_light, to_light)));
  }
#endif
#if SPOT_LIGHTS > 0
  LOOP_HINT for (int i = DIRECTIONAL_LIGHTS + POINT_LIGHTS; i < DIRECTIONAL_LIGHTS + POINT_LIGHTS + SPOT_LIGHTS; ++i) {
    vec3 to_light = frame.lights[i].position.xyz - position;
    vec3 l = unit(to_light);
    float cone = clamp(dot(frame.lights[i].direction.xyz, l) * frame.lights[i].cone.x + frame.lights[i].cone.y, 0.0, 1.0);
    add_light(sum, n, v, l, frame.lights[i].color.rgb * (fading(frame.lights[i], dot(to_light, to_light)) * cone * cone));
  }
#endif
  return sum;
}
#endif

// How what vertices are lit with goes to fragments. Flat shading takes the first vertex's for the whole face, whose three vertices have the face's normal.
#ifdef SHADED_FLAT
#define ACROSS flat
#else
#define ACROSS smooth
#endif
