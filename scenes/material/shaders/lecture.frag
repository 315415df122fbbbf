// Fragment shader of the lectures' pipelines (docs/lectures.md): a fixed colour, or the base colour under Blinn's and Phong's light. Where that light was
// evaluated is the only difference between flat, Gouraud's and Phong's shading.
#ifdef MINIMAL
const vec3 kFixed = vec3(0.8, 0.4, 0.1);
#endif

#ifdef LIT_AT_VERTICES
layout(location = 6) ACROSS in vec3 v_diffuse;
layout(location = 7) ACROSS in vec3 v_specular;
#ifdef DOUBLE_SIDED
layout(location = 8) ACROSS in vec3 v_back_diffuse;
layout(location = 9) ACROSS in vec3 v_back_specular;
#endif
#endif

// What the surface sends of the light, given its colour.
vec3 lit(vec3 base) {
#ifdef LIT_AT_FRAGMENTS
  vec3 n = unit(v_normal);
#ifdef DOUBLE_SIDED
  n = gl_FrontFacing ? n : -n;
#endif
  Reflected l = reflect_lights(n, v_position);
  return base * l.diffuse + l.specular;
#elif defined(LIT_AT_VERTICES) && defined(DOUBLE_SIDED)
  return base * (gl_FrontFacing ? v_diffuse : v_back_diffuse) + (gl_FrontFacing ? v_specular : v_back_specular);
#elif defined(LIT_AT_VERTICES)
  return base * v_diffuse + v_specular;
#else
  return base;
#endif
}

void main() {
#ifdef MINIMAL
  out_color = vec4(kFixed, 1.0);
#else
  vec4 base = read_base_color();
  alpha_test(base.a);
#ifdef ALPHA_TO_COVERAGE
  base.a = alpha_coverage(base.a);
#endif
  out_color = vec4(lit(base.rgb), base.a);
#endif
}
