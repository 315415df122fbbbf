// The material's parameters, textures and inputs, and what of them decides the alpha test; shared by the colour and the visibility shader.
layout(set = 1, binding = 0, std140) uniform Material {
  vec4 base_color;     // rgba, linear
  vec4 emissive;       // rgb; w: alpha cut-off
  vec4 factors;        // metallic, roughness, normal scale, occlusion strength
  vec4 uv_rows[10];    // slot i: u' = dot(uv_rows[2 i].xyz, (u, v, 1)), v' by uv_rows[2 i + 1]
#ifdef LAYERS
  vec4 specular;       // rgb: reflectance at normal incidence; w: weight
  vec4 clearcoat;      // weight, roughness, normal scale
  vec4 sheen;          // rgb: colour; w: roughness
  vec4 transmission;   // rgb: log2 of what the thickness lets through; w: share that is transmitted
  vec4 layer_uv_rows[18];  // slots 5 to 13
#endif
} material;

#if defined(NEEDS_POSITION) && !defined(LIT_AT_VERTICES)
layout(location = 0) in vec3 v_position;
#endif
#if defined(HAS_NORMAL) && !defined(LIT_AT_VERTICES)
layout(location = 1) in vec3 v_normal;
#endif
#ifdef HAS_TANGENT
layout(location = 2) in vec4 v_tangent;
#endif
#ifdef HAS_UV0
layout(location = 3) in vec2 v_uv0;
#endif
#ifdef HAS_UV1
layout(location = 4) in vec2 v_uv1;
#endif
#ifdef HAS_COLOR
layout(location = 5) in vec4 v_color;
#endif
layout(location = 0) out vec4 out_color;

#ifdef BASE_COLOR_UV
layout(set = 1, binding = 1) uniform sampler2D base_color_texture;
#endif
#ifdef METALLIC_ROUGHNESS_UV
layout(set = 1, binding = 2) uniform sampler2D metallic_roughness_texture;
#endif
#ifdef NORMAL_UV
layout(set = 1, binding = 3) uniform sampler2D normal_texture;
#endif
#ifdef OCCLUSION_UV
layout(set = 1, binding = 4) uniform sampler2D occlusion_texture;
#endif
#ifdef EMISSIVE_UV
layout(set = 1, binding = 5) uniform sampler2D emissive_texture;
#endif
#ifdef SPECULAR_UV
layout(set = 1, binding = 6) uniform sampler2D specular_texture;
#endif
#ifdef SPECULAR_COLOR_UV
layout(set = 1, binding = 7) uniform sampler2D specular_color_texture;
#endif
#ifdef CLEARCOAT_UV
layout(set = 1, binding = 8) uniform sampler2D clearcoat_texture;
#endif
#ifdef CLEARCOAT_ROUGHNESS_UV
layout(set = 1, binding = 9) uniform sampler2D clearcoat_roughness_texture;
#endif
#ifdef CLEARCOAT_NORMAL_UV
layout(set = 1, binding = 10) uniform sampler2D clearcoat_normal_texture;
#endif
#ifdef SHEEN_COLOR_UV
layout(set = 1, binding = 11) uniform sampler2D sheen_color_texture;
#endif
#ifdef SHEEN_ROUGHNESS_UV
layout(set = 1, binding = 12) uniform sampler2D sheen_roughness_texture;
#endif
#ifdef TRANSMISSION_UV
layout(set = 1, binding = 13) uniform sampler2D transmission_texture;
#endif
#ifdef THICKNESS_UV
layout(set = 1, binding = 14) uniform sampler2D thickness_texture;
#endif

#ifdef LAYERS
vec2 transform_layer_uv(int slot, vec2 uv) {
  vec3 p = vec3(uv, 1.0);
  return vec2(dot(material.layer_uv_rows[2 * slot - 10].xyz, p), dot(material.layer_uv_rows[2 * slot - 9].xyz, p));
}
#endif

// KHR_texture_transform of one slot.
vec2 transform_uv(int slot, vec2 uv) {
  vec3 p = vec3(uv, 1.0);
  return vec2(dot(material.uv_rows[2 * slot].xyz, p), dot(material.uv_rows[2 * slot + 1].xyz, p));
}

vec4 read_base_color() {
  vec4 color = material.base_color;
#ifdef BASE_COLOR_UV
  vec4 texel = texture(base_color_texture, BASE_COLOR_UV);
#ifdef PREMULTIPLIED
  // Filtered as colour times alpha, so that transparent texels count for nothing.
  texel.rgb /= max(texel.a, 1e-6);
#endif
  color *= texel;
#endif
#ifdef HAS_COLOR
  color *= v_color;
#endif
  return color;
}

void alpha_test(float alpha) {
#ifdef ALPHA_MASK
  if (alpha < material.emissive.w) discard;
#endif
}

#ifdef ALPHA_TO_COVERAGE
// How much of the pixel the alpha test would leave: its edge, where alpha is at the cut-off, is one pixel wide, and a half there.
float alpha_coverage(float alpha) {
  return clamp((alpha - material.emissive.w) / max(fwidth(alpha), 1.0 / 256.0) + 0.5, 0.0, 1.0);
}
#endif
