/// A material of realistic size: metallic-roughness with five textures, normal mapping and a loop over up to
/// four lights.
#include "tests/pipeline/compiler/shader_runner.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace quadrille::pipeline {
namespace {

const char* const kVertex = R"(#version 450
layout(set=0, binding=0, std140) uniform Frame { mat4 view_projection; vec4 eye; } frame;
layout(push_constant) uniform Draw { mat4 model; mat4 normal; } draw;
layout(location=0) in vec3 position; layout(location=1) in vec3 normal; layout(location=2) in vec4 tangent; layout(location=3) in vec2 uv;
layout(location=0) out vec3 v_position; layout(location=1) out vec3 v_normal; layout(location=2) out vec4 v_tangent; layout(location=3) out vec2 v_uv;
void main() {
  vec4 world = draw.model * vec4(position, 1.0);
  gl_Position = frame.view_projection * world;
  v_position = world.xyz; v_normal = mat3(draw.normal) * normal; v_tangent = vec4(mat3(draw.model) * tangent.xyz, tangent.w); v_uv = uv;
})";

const char* const kFragment = R"(#version 450
struct Light { vec4 position; vec4 color; };
layout(set=0, binding=0, std140) uniform Frame { mat4 view_projection; vec4 eye; Light lights[4]; int count; } frame;
layout(set=1, binding=0, std140) uniform Material { vec4 base; vec4 emissive; float metallic, roughness, normal_scale, occlusion; } material;
layout(set=1, binding=1) uniform sampler2D base_map; layout(set=1, binding=2) uniform sampler2D orm_map; layout(set=1, binding=3) uniform sampler2D normal_map;
layout(set=1, binding=4) uniform sampler2D occlusion_map; layout(set=1, binding=5) uniform sampler2D emissive_map;
layout(location=0) in vec3 v_position; layout(location=1) in vec3 v_normal; layout(location=2) in vec4 v_tangent; layout(location=3) in vec2 v_uv;
layout(location=0) out vec4 color;
void main() {
  vec4 base = texture(base_map, v_uv) * material.base;
  vec2 mr = texture(orm_map, v_uv).bg * vec2(material.metallic, material.roughness);
  vec3 m = (texture(normal_map, v_uv).xyz * 2.0 - 1.0) * vec3(material.normal_scale, material.normal_scale, 1.0);
  vec3 n = normalize(v_normal), t = normalize(v_tangent.xyz - n * dot(n, v_tangent.xyz));
  n = normalize(mat3(t, cross(n, t) * v_tangent.w, n) * m);
  vec3 v = normalize(frame.eye.xyz - v_position);
  float alpha = max(mr.y * mr.y, 0.001), nv = max(dot(n, v), 1e-4);
  vec3 f0 = mix(vec3(0.04), base.rgb, mr.x), sum = vec3(0.0);
  for (int k = 0; k < min(frame.count, 4); ++k) {
    vec3 to = frame.lights[k].position.xyz - v_position * frame.lights[k].position.w;
    vec3 l = normalize(to), h = normalize(l + v);
    float nl = clamp(dot(n, l), 0.0, 1.0), nh = clamp(dot(n, h), 0.0, 1.0), vh = clamp(dot(v, h), 0.0, 1.0);
    float a2 = alpha * alpha, d = nh * nh * (a2 - 1.0) + 1.0;
    float ggx = a2 / (3.14159265 * d * d), vis = 0.5 / (nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2));
    vec3 f = f0 + (1.0 - f0) * pow(1.0 - vh, 5.0);
    sum += frame.lights[k].color.rgb * nl * ((1.0 - f) * base.rgb * (1.0 - mr.x) / 3.14159265 + f * ggx * vis);
  }
  float occlusion = mix(1.0, texture(occlusion_map, v_uv).r, material.occlusion);
  color = vec4(sum + base.rgb * 0.03 * occlusion + texture(emissive_map, v_uv).rgb * material.emissive.rgb, base.a);
})";

}  // namespace

TEST_CASE("material: a glTF-like fragment shader stays within what its size should cost") {
  const CompiledPipeline p = compile_pipeline(vertex_spirv(kVertex), "v", fragment_spirv(kFragment), "f");
  const auto& code = p.fragment.code;
  const auto count = [&](models::Op op) {
    return std::count_if(code.begin(), code.end(), [&](const models::Instruction& i) { return i.op == op; });
  };
  CHECK(count(models::Op::kTexImplicit) == 5);
  CHECK(count(models::Op::kInterp) == 12);
  CHECK(count(models::Op::kLoop) == 1);
  CHECK(p.fragment.varyings.size() == 12);
  CHECK(p.fragment.num_regs <= 48);
  CHECK(code.size() <= 240);
  CHECK(p.vertex.num_regs <= 16);
  CHECK(p.vertex.code.size() <= 80);
}

TEST_CASE("material: one light straight above a flat grey surface gives the closed form") {
  const CompiledPipeline p = compile_pipeline(vertex_spirv(kVertex), "v", fragment_spirv(kFragment), "f");
  RunInput input;
  std::vector<std::uint32_t> frame(64), material(16);
  const auto set = [](std::vector<std::uint32_t>& words, std::size_t at,
                      std::initializer_list<float> values) {
    for (const float v : values) words[at++] = std::bit_cast<std::uint32_t>(v);
  };
  set(frame, 16, {0, 0, 5, 1});              // eye
  set(frame, 20, {0, 0, 1, 0, 2, 2, 2, 0});  // a directional light along z
  frame[52] = 1;
  set(material, 0, {0.5f, 0.5f, 0.5f, 0.75f, 0, 0, 0, 0, 0, 1, 1, 1});
  input.blocks = {{{0, 0}, frame}, {{1, 0}, material}};
  input.texture = [](int binding, float, float, float) {
    return binding == 2 ? Vec4{0.5f, 0.5f, 1, 1} : Vec4{1, 1, 1, 1};
  };
  for (Point& q : input.points) {  // packed: position xyz, normal x | normal yz, tangent xy | tangent zw, uv
    q.a = {0, 0, 0, 0};
    q.b = {0, 1, 1, 0};
    q.i = {0, std::bit_cast<std::int32_t>(1.0f), 0, 0};
  }
  const Vec4 color = run_fragment(p.fragment, input).point(0);
  // D = 1/pi, visibility 1/4 at normal incidence and roughness 1
  const double specular = 0.04 * (1.0 / 3.14159265) * 0.25;
  const double expected = 2.0 * (0.96 * 0.5 / 3.14159265 + specular) + 0.5 * 0.03;
  CHECK(color[0] == Approx(expected).epsilon(1e-4));
  CHECK(color[3] == 0.75f);
}

}  // namespace quadrille::pipeline
