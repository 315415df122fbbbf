/// Uniform blocks, push constants, inputs and outputs: layout, indexing, linking of the two stages.
#include "tests/pipeline/compiler/shader_runner.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <numeric>

namespace quadrille::pipeline {
namespace {

std::vector<std::uint32_t> counting_words(std::size_t count) {
  std::vector<std::uint32_t> words(count);
  for (std::size_t k = 0; k < count; ++k) words[k] = std::bit_cast<std::uint32_t>(static_cast<float>(k));
  return words;
}

bool has_op(const models::Program& p, models::Op op) {
  return std::any_of(p.code.begin(), p.code.end(), [&](const models::Instruction& i) { return i.op == op; });
}

}  // namespace

TEST_CASE("uniform blocks: members are read at their std140 offsets") {
  RunInput input;
  input.blocks[{1, 3}] = counting_words(256);
  const std::string declarations = R"(
struct S { float f; vec3 v; mat2 m; };
layout(set=1, binding=3, std140) uniform U { float f; vec3 v; mat3 c; layout(row_major) mat2x3 r; S s[3]; float t[4]; } u;)";
  // Offsets in words: f 0, v 4, c 8 (columns of 4), r 20 (2x3 row-major: 3 rows of 2, stride 4), s 32 (f +0,
  // v +4, m +8; size 16), t 80 (stride 4).
  CHECK(run_snippet("color = vec4(u.f, u.v);", input, declarations).point(0) == Vec4{0, 4, 5, 6});
  CHECK(run_snippet("color = vec4(u.c[1], u.c[2].z);", input, declarations).point(0) == Vec4{12, 13, 14, 18});
  CHECK(run_snippet("color = vec4(u.r[0], u.r[1].y);", input, declarations).point(0) == Vec4{20, 24, 28, 25});
  CHECK(run_snippet("color = vec4(u.s[2].f, u.s[1].v.y, u.s[2].m[1].x, u.t[3]);", input, declarations)
            .point(0) == Vec4{64, 53, 76, 92});
  CHECK(run_snippet("vec2 w = vec2(2, 3); color = vec4(u.r * w, 0);", input, declarations).point(0) ==
        Vec4{103, 123, 143, 0});
}

TEST_CASE("uniform blocks: run-time indices select per lane and stay inside the array") {
  RunInput input;
  input.points = assorted_points(4);
  input.blocks[{0, 0}] = counting_words(128);
  const std::string declarations =
      "struct L { vec4 p; float w[2]; }; layout(set=0, binding=0, std140) uniform U { vec4 first; L l[5]; } "
      "u;";
  // l at word 4, 12 words each: p +0, w +4 and +8.
  const RunOutput out =
      run_snippet("color = vec4(u.l[abs(i.x) % 5].p.zw, u.l[abs(i.y) % 5].w[abs(i.z) % 2], u.l[i.w].p.x);",
                  input, declarations);
  for (int k = 0; k < models::kWarpQuads; ++k) {
    const auto& i = input.points[static_cast<std::size_t>(k)].i;
    const Vec4 color = out.point(k);
    CHECK(color[0] == static_cast<float>(4 + 12 * (std::abs(i[0]) % 5) + 2));
    CHECK(color[1] == color[0] + 1);
    CHECK(color[2] == static_cast<float>(4 + 12 * (std::abs(i[1]) % 5) + 4 + 4 * (std::abs(i[2]) % 2)));
    CHECK((color[3] >= 4 && color[3] < 64));
  }
}

TEST_CASE("uniform blocks: only the words that are read are in the constant file") {
  const std::string declarations =
      "layout(set=2, binding=1, std140) uniform U { vec4 a0[50]; vec4 late; } u; layout(push_constant) "
      "uniform P { vec4 x; mat4 m; vec4 "
      "tint; } p;";
  const models::Program program = compile_fragment(fragment_source("color = u.late * p.tint;", declarations));
  CHECK(program.constants.words == 8);
  REQUIRE(program.constants.ranges.size() == 2);
  CHECK(program.constants.ranges[0].source == models::ConstantLayout::Source::kPushConstant);
  CHECK(program.constants.ranges[0].byte_offset == 80);
  CHECK(program.constants.ranges[1].set == 2);
  CHECK(program.constants.ranges[1].binding == 1);
  CHECK(program.constants.ranges[1].byte_offset == 800);
  RunInput input;
  input.blocks[{2, 1}] = counting_words(204);
  input.push_constants = counting_words(24);
  CHECK(run_fragment(program, input).point(0) == Vec4{200 * 20, 201 * 21, 202 * 22, 203 * 23});
}

TEST_CASE("linking: outputs that nobody reads, their code and their vertex inputs are gone") {
  const auto vertex = vertex_spirv(R"(#version 450
layout(location=0) in vec3 p; layout(location=3) in vec4 unused; layout(location=5) in vec2 uv;
layout(location=0) out vec4 dead; layout(location=2) out vec2 v_uv; layout(location=4) flat out float id; layout(location=6) noperspective out float lin;
void main() { gl_Position = vec4(p, 1); dead = sin(unused); v_uv = uv * 2.0; id = p.z; lin = 4.0; })");
  const auto fragment = fragment_spirv(R"(#version 450
layout(location=2) in vec2 v_uv; layout(location=4) flat in float id; layout(location=6) noperspective in float lin; layout(location=0) out vec4 c;
void main() { c = vec4(v_uv.y, id, lin, 1); })");
  const CompiledPipeline p = compile_pipeline(vertex, "v", fragment, "f");
  using models::Interpolation;
  const std::vector<Interpolation> expected{Interpolation::kPerspective, Interpolation::kFlat,
                                            Interpolation::kLinear};
  CHECK(p.vertex.varyings == expected);
  CHECK(p.fragment.varyings == expected);
  CHECK_FALSE(has_op(p.vertex, models::Op::kFSin));
  REQUIRE(p.vertex.vertex_inputs.size() == 4);
  CHECK(p.vertex.vertex_inputs[3].location == 5);
  CHECK(p.vertex.vertex_inputs[3].component == 1);
  const auto out = run_vertex(p.vertex, [](int location, int component, int lane) {
    return static_cast<float>(location * 100 + component * 10 + lane);
  });
  REQUIRE(out.size() == 7);
  CHECK(std::bit_cast<float>(out[0][3]) == 3.0f);
  CHECK(std::bit_cast<float>(out[3][3]) == 1.0f);
  CHECK(std::bit_cast<float>(out[4][3]) == 1026.0f);
  CHECK(std::bit_cast<float>(out[5][3]) == 23.0f);
  CHECK(std::bit_cast<float>(out[6][3]) == 4.0f);
}

TEST_CASE("linking: a varying that is read but not written is an error with its location") {
  const auto vertex = vertex_spirv("#version 450\nvoid main() { gl_Position = vec4(0); }");
  const auto fragment = fragment_spirv(
      "#version 450\nlayout(location=7) in vec2 t; layout(location=0) out vec4 c; void main() { c = t.xyxy; "
      "}");
  CHECK_THROWS_WITH(compile_pipeline(vertex, "a.vert", fragment, "b.frag"),
                    Catch::Contains("b.frag") && Catch::Contains("location 7") && Catch::Contains("a.vert"));
}

TEST_CASE("built-ins: extra outputs follow the varyings, and the size only where points are drawn") {
  const auto vertex = vertex_spirv(R"(#version 450
layout(location = 0) out float v;
out gl_PerVertex { vec4 gl_Position; float gl_PointSize; float gl_ClipDistance[3]; float gl_CullDistance[2]; };
void main() {
  gl_Position = vec4(0); v = 9.0; gl_PointSize = 5.0;
  gl_ClipDistance[0] = 1.0; gl_ClipDistance[1] = 2.0; gl_CullDistance[0] = 3.0;
})");
  const auto fragment = fragment_spirv(
      "#version 450\nlayout(location=0) in float v; layout(location=0) out vec4 c; void main() { c = "
      "vec4(v, gl_PointCoord, 1); }");
  for (const bool points : {false, true}) {
    const CompiledPipeline p = compile_pipeline(vertex, "v", fragment, "f", {}, points);
    CHECK(p.vertex.extras == models::VertexExtras{points, 2, 1});
    CHECK(p.fragment.extras == models::VertexExtras{});
    CHECK(models::vertex_outputs(p.vertex) == 4 + 1 + (points ? 1 : 0) + 3);
    const auto out = run_vertex(p.vertex, [](int, int, int) { return 0.0f; });
    std::vector<float> written;
    for (std::size_t slot = 4;
         slot < out.size() && slot < static_cast<std::size_t>(models::vertex_outputs(p.vertex)); ++slot)
      written.push_back(std::bit_cast<float>(out[slot][3]));
    CHECK(written == (points ? std::vector<float>{9, 5, 1, 2, 3} : std::vector<float>{9, 1, 2, 3}));
    CHECK(models::assemble(models::disassemble(p.vertex), "v").extras == p.vertex.extras);
  }
}

TEST_CASE("built-ins: more than eight clip and cull distances are refused") {
  const auto vertex = vertex_spirv(R"(#version 450
out gl_PerVertex { vec4 gl_Position; float gl_ClipDistance[6]; float gl_CullDistance[3]; };
void main() { gl_Position = vec4(0); gl_ClipDistance[5] = 1.0; gl_CullDistance[2] = 1.0; })");
  const auto fragment =
      fragment_spirv("#version 450\nlayout(location=0) out vec4 c; void main() { c = vec4(1); }");
  CHECK_THROWS_WITH(compile_pipeline(vertex, "far.vert", fragment, "f"),
                    Catch::Contains("far.vert") && Catch::Contains("6 clip and 3 cull distances"));
}

TEST_CASE("built-ins: vertex and instance index, fragment coordinates, facing, depth") {
  const auto vertex = vertex_spirv(
      "#version 450\nvoid main() { gl_PointSize = 1.0; gl_Position = vec4(gl_VertexIndex, gl_InstanceIndex, "
      "0, 1); }");
  const auto fragment = fragment_spirv(R"(#version 450
layout(location=0) out vec4 c;
void main() { c = vec4(gl_FragCoord.xyz, gl_FrontFacing ? 1.0 : float(gl_PrimitiveID)); gl_FragDepth = gl_FragCoord.w * 0.5; })");
  const CompiledPipeline p = compile_pipeline(vertex, "v", fragment, "f");
  CHECK(p.fragment.writes_depth);
  CHECK_FALSE(p.fragment.uses_discard);
  const auto out = run_vertex(p.vertex, [](int, int, int) { return 0.0f; });
  CHECK(std::bit_cast<float>(out[0][5]) == 105.0f);
  CHECK(std::bit_cast<float>(out[1][5]) == 7.0f);
  const RunOutput pixels = run_fragment(p.fragment, {});
  CHECK(pixels.color[1] == Vec4{11.5f, 20.5f, 0.25f, 1.0f});
  CHECK(pixels.color[14] == Vec4{16.5f, 21.5f, 0.25f, 3.0f});
  CHECK(pixels.depth[0] == 0.25f);
}

TEST_CASE("outputs: may be read back, written in branches and by component") {
  RunInput input;
  input.points = assorted_points(6);
  const RunOutput out = run_snippet(
      "color = a; color.y += 1.0; if (i.x > 0) color.zw = color.xy * 2.0; color[abs(i.y) % 4] = 9.0;", input);
  for (int k = 0; k < models::kWarpQuads; ++k) {
    const Point& p = input.points[static_cast<std::size_t>(k)];
    Vec4 want = p.a;
    want[1] += 1;
    if (p.i[0] > 0) {
      want[2] = want[0] * 2;
      want[3] = want[1] * 2;
    }
    want[static_cast<std::size_t>(std::abs(p.i[1]) % 4)] = 9;
    CHECK(out.point(k) == want);
  }
}

TEST_CASE("specialisation constants take their defaults") {
  CHECK(run_snippet("color = vec4(float(n) * k, n * 2 + 1, on ? 1 : 0, 0);", {},
                    "layout(constant_id=0) const int n = 3; layout(constant_id=1) const float k = 2.5; "
                    "layout(constant_id=2) const bool on = true;")
            .point(0) == Vec4{7.5f, 7, 1, 0});
}

TEST_CASE(
    "compiler: integer vertex inputs are read as they are, and the pipeline says which locations they are") {
  const auto vertex = vertex_spirv(
      "#version 450\nlayout(location=0) in vec2 p; layout(location=3) in uvec4 i; void main() { gl_Position "
      "= vec4(p, float(i.y + 7u), 1); "
      "}");
  const auto fragment =
      fragment_spirv("#version 450\nlayout(location=0) out vec4 c; void main() { c = vec4(1); }");
  const CompiledPipeline p = compile_pipeline(vertex, "v", fragment, "f");
  CHECK(p.integer_inputs == 8);
  CHECK(std::ranges::any_of(p.vertex.vertex_inputs,
                            [](const auto& use) { return use.location == 3 && use.component == 1; }));
}

TEST_CASE("compiler: a program says what it writes to each location, and what its textures' texels are") {
  const auto vertex = vertex_spirv(plain_vertex_source());
  const auto fragment = fragment_spirv(
      "#version 450\nlayout(location=0) out uvec4 a; layout(location=1) out vec2 b; layout(location=3) out "
      "int c;\n"
      "layout(set=0,binding=1) uniform usampler2D u; layout(set=0,binding=2) uniform isampler2D s;\n"
      "layout(set=0,binding=3) uniform sampler2D f;\n"
      "void main() { a = textureLod(u, vec2(0.5), 0.0); b = textureLod(f, vec2(0.5), 0.0).xy;\n"
      "  c = textureLod(s, vec2(0.5), 0.0).w; }");
  const CompiledPipeline p = compile_pipeline(vertex, "v", fragment, "f");
  using models::NumberKind;
  CHECK(p.fragment.color_kinds[0] == NumberKind::kUint);
  CHECK(p.fragment.color_kinds[1] == NumberKind::kFloat);
  CHECK(p.fragment.color_kinds[3] == NumberKind::kSint);
  CHECK(std::ranges::count(p.fragment.textures, models::TextureBinding{0, 1, NumberKind::kUint}) == 1);
  CHECK(std::ranges::count(p.fragment.textures, models::TextureBinding{0, 2, NumberKind::kSint}) == 1);
  CHECK(std::ranges::count(p.fragment.textures, models::TextureBinding{0, 3}) == 1);
  CHECK(models::assemble(models::disassemble(p.fragment), "f").color_kinds == p.fragment.color_kinds);
}

TEST_CASE("compiler: the number of a viewport is the last output of a vertex, and fragments do not read it") {
  const auto vertex = vertex_spirv(
      "#version 450\n#extension GL_ARB_shader_viewport_layer_array : require\nlayout(location=0) in vec2 p;\n"
      "out float gl_ClipDistance[2];\n"
      "void main() { gl_Position = vec4(p, 0, 1); gl_ViewportIndex = int(p.x); gl_ClipDistance[0] = p.x; "
      "gl_ClipDistance[1] = p.y; }");
  const auto fragment =
      fragment_spirv("#version 450\nlayout(location=0) out vec4 c; void main() { c = vec4(1); }");
  const models::Program p = compile_pipeline(vertex, "v", fragment, "f").vertex;
  CHECK(p.extras == models::VertexExtras{false, 2, 0, true});
  const int last = models::first_extra_output(p) + 2;
  CHECK(models::vertex_outputs(p) == last + 1);
  CHECK(std::ranges::count_if(p.code, [&](const models::Instruction& i) {
          return i.op == models::Op::kOutput && i.imm == last;
        }) == 1);
  CHECK(models::assemble(models::disassemble(p), "v") == p);
  const auto reads = fragment_spirv(
      "#version 450\nlayout(location=0) out vec4 c; void main() { c = vec4(gl_ViewportIndex); }");
  CHECK_THROWS_WITH(compile_pipeline(vertex, "v", reads, "f.frag"), Catch::Contains("gl_ViewportIndex"));
}

TEST_CASE(
    "specialisation constants may be floats and vectors chosen by others, and what is computed of them") {
  const std::string declarations =
      R"(layout(constant_id = 0) const int N = 3; layout(constant_id = 1) const bool B = true;
layout(constant_id = 2) const float F = 0.5; layout(constant_id = 3) const uint U = 0xfffffff0u;
const float S = N == 3 ? 1.0 : F; const vec3 V = B ? vec3(F, 2.0, 3.0) : vec3(0.0); const vec2 W = N > 5 ? vec2(1.0) : V.yx;
const ivec3 I = ivec3(N, N + 6, N * 7) % 4; const uint X = (U >> 2) ^ uint(N); const bvec2 P = bvec2(B, !B); const vec2 Q = P.y ? V.xy : W;
const int M = (N << 4) / (N - 1) - (~N & 5); const bool O = (uint(N) < U) == (B != false);)";
  const std::string sum =
      R"(S + V.x + 10.0 * V.z + 100.0 * W.x + 1000.0 * Q.y + float(I.x * 3 - I.y + M) + (O ? 0.25 : 0.0) + (X == 0x3fffffffu ? 1000.0 : 0.0))";
  CHECK(run_snippet("color = vec4(" + sum + ");", {}, declarations).point(0)[0] == 1759.75f);
}

}  // namespace quadrille::pipeline
