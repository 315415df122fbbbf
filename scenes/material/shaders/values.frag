// Fragment shader of the pictures that show something else than colours (docs/lectures.md). The target is UNORM, so what is written here is what can be read
// off the picture, in 255ths. The alpha test is the material's.

#if defined(SHOW_LEVEL) && defined(BASE_COLOR_UV)
// Red where level 0 is reduced to fit, one colour a level towards violet, grey where it is magnified.
vec3 level_color(float level) {
  const vec3 ramp[7] = vec3[](vec3(0.9, 0.1, 0.1), vec3(0.9, 0.5, 0.0), vec3(0.9, 0.9, 0.1), vec3(0.1, 0.7, 0.1), vec3(0.1, 0.7, 0.9),
                              vec3(0.1, 0.2, 0.9), vec3(0.6, 0.1, 0.8));
  vec3 color = level < 0.0 ? mix(vec3(0.5), ramp[0], max(level + 1.0, 0.0)) : ramp[6];
  [[unroll]] for (int l = 0; l < 6; ++l)
    if (level >= float(l) && level < float(l + 1)) color = mix(ramp[l], ramp[l + 1], level - float(l));
  return color;
}
#endif

void main() {
#ifdef ALPHA_MASK
  alpha_test(read_base_color().a);
#endif
  vec3 value = vec3(0.0);
#ifdef SHOW_DEPTH
  value = vec3(1.0 - (gl_FragCoord.z - frame.eye.w) * frame.toward_viewer.w);
#endif
#ifdef SHOW_OVERDRAW
  value = vec3(1.0 / 255.0);  // added up by blending; overdraw.frag makes colours of the sums
#endif
#ifdef SHOW_UV
#ifdef HAS_UV0
  value = vec3(fract(v_uv0), 0.0);
#else
  value.b = 0.25;
#endif
#endif
#ifdef SHOW_NORMAL
#ifdef HAS_NORMAL
  vec3 n = v_normal * inversesqrt(max(dot(v_normal, v_normal), 1e-30));
#ifdef DOUBLE_SIDED
  n = gl_FrontFacing ? n : -n;
#endif
  value = n * 0.5 + 0.5;
#else
  value.b = 0.25;
#endif
#endif
#ifdef SHOW_TRIANGLE
  // The factor is odd, so that each of 2^24 numbers has its own colour, and that of the background is nobody's.
  uint code = (draw.first_triangle + uint(gl_PrimitiveID) + 1u) * 2654435761u;
  value = vec3(uvec3(code, code >> 8, code >> 16) & 255u) / 255.0;
#endif
#ifdef SHOW_LEVEL
#ifdef BASE_COLOR_UV
  // Of the longer side of a pixel's footprint: before limits of the sampler and of the chain. [VK1.3 #textures-level-of-detail-operation]
  vec2 size = vec2(textureSize(base_color_texture, 0));
  vec2 dx = dFdx(BASE_COLOR_UV) * size, dy = dFdy(BASE_COLOR_UV) * size;
  value = level_color(0.5 * log2(max(max(dot(dx, dx), dot(dy, dy)), 1e-12)));
#else
  value.b = 0.25;
#endif
#endif
#ifdef SHOW_SAMPLES
  // Dark blue where the primitive covers all samples of the pixel, else from red (one) to yellow.
  int covered = 0;
  [[unroll]] for (int s = 0; s < SAMPLES; ++s) covered += gl_SampleMaskIn[0] >> s & 1;
  value = covered == SAMPLES ? vec3(0.05, 0.1, 0.3) : vec3(1.0, float(covered - 1) / float(SAMPLES), 0.0);
#endif
  out_color = vec4(value, 1.0);
}
