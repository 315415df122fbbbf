/// Texture instructions: operands, grouping into clauses, and results that arrive late.
#include "models/base/error.h"
#include "models/shader/isa.h"
#include "tests/pipeline/compiler/shader_runner.h"

#include <catch2/catch.hpp>
#include <spirv/unified1/spirv.hpp>

#include <algorithm>

namespace quadrille::pipeline {
namespace {

int longest_texture_run(const models::Program& p) {
  int run = 0, longest = 0;
  for (const models::Instruction& i : p.code) {
    run = models::issue_class(i.op) == models::IssueClass::kTex ? run + 1 : 0;
    longest = std::max(longest, run);
  }
  return longest;
}

std::string samplers(int count) {
  std::string text;
  for (int k = 0; k < count; ++k)
    text +=
        "layout(set=1, binding=" + std::to_string(k) + ") uniform sampler2D t" + std::to_string(k) + ";\n";
  return text;
}

}  // namespace

TEST_CASE("textures: coordinates, bias and level reach the request, colours come back") {
  RunInput input;
  input.points = assorted_points(2);
  input.texture = [](int binding, float u, float v, float level) {
    return Vec4{u, v, level, static_cast<float>(binding)};
  };
  const std::string s = samplers(3);
  const auto check = [&](const char* body, auto expected) {
    const RunOutput out = run_snippet(body, input, s);
    for (int k = 0; k < models::kWarpQuads; ++k)
      CHECK(out.point(k) == expected(input.points[static_cast<std::size_t>(k)]));
  };
  check("color = texture(t0, a.xy);", [](const Point& p) { return Vec4{p.a[0], p.a[1], 0, 0}; });
  check("color = texture(t1, -a.yx, b.z);", [](const Point& p) { return Vec4{-p.a[1], -p.a[0], p.b[2], 0}; });
  check("color = textureLod(t2, a.xy + b.xy, abs(a.z));", [](const Point& p) {
    return Vec4{p.a[0] + p.b[0], p.a[1] + p.b[1], std::abs(p.a[2]), 0};
  });
  check("color = textureProj(t0, vec3(a.xy, b.x)).gbra;", [](const Point& p) {
    return Vec4{p.a[1] / p.b[0], 0, p.a[0] / p.b[0], 0};
  });
  check("color = vec4(textureSize(t0, 0), textureSize(t0, 1));", [](const Point&) {
    return Vec4{64, 32, 32, 16};
  });
}

TEST_CASE("textures: independent ones of a block are one clause, dependent ones follow") {
  RunInput input;
  input.points = assorted_points(2);
  const std::string body =
      "vec4 x = texture(t0, a.xy); x += texture(t1, a.zw) * x.w; x *= texture(t2, b.xy); x += texture(t3, "
      "x.xy); color = x + texture(t4, "
      "b.zw);";
  const models::Program p = compile_fragment(fragment_source(body, samplers(5)));
  CHECK(longest_texture_run(p) == 4);
  CHECK(p.uses_derivatives);
  REQUIRE(p.textures.size() == 5);
  CHECK(p.textures[4] == models::TextureBinding{1, 4});
  const RunOutput out = run_snippet(body, input, samplers(5));
  CHECK(out.clauses == 3);
}

TEST_CASE("textures: a group never exceeds the clause limit and every result is right") {
  RunInput input;
  input.points = assorted_points(8);
  input.texture = [](int, float u, float v, float level) { return Vec4{u + level, v, u * v, 1}; };
  std::string body = "color = vec4(0);";
  for (int k = 0; k < 20; ++k)
    body += " color += textureLod(t0, a.xy * " + std::to_string(k + 1) + ".0, " + std::to_string(k) + ".0);";
  const models::Program p = compile_fragment(fragment_source(body, samplers(1)));
  CHECK(longest_texture_run(p) <= models::kMaxClauseRequests);
  const RunOutput out = run_snippet(body, input, samplers(1));
  for (int k = 0; k < models::kWarpQuads; ++k) {
    const Vec4& a = input.points[static_cast<std::size_t>(k)].a;
    Vec4 want{};
    for (int n = 0; n < 20; ++n) {
      const float u = a[0] * static_cast<float>(n + 1), v = a[1] * static_cast<float>(n + 1);
      want = {want[0] + (u + static_cast<float>(n)), want[1] + v, want[2] + u * v, want[3] + 1};
    }
    CHECK(out.point(k) == want);
  }
}

TEST_CASE("textures: results that nobody reads do not overwrite other values") {
  RunInput input;
  input.points = assorted_points(8);
  input.texture = [](int, float, float, float) { return Vec4{100, 200, 300, 400}; };
  const RunOutput out = run_snippet(
      "vec4 t = textureLod(t0, a.xy, 0.0); float x = a.x * b.x, y = a.y * b.y, z = a.z * b.z; color = "
      "vec4(x, y, z, t.x);",
      input, samplers(1));
  for (int k = 0; k < models::kWarpQuads; ++k) {
    const Point& p = input.points[static_cast<std::size_t>(k)];
    CHECK(out.point(k) == Vec4{p.a[0] * p.b[0], p.a[1] * p.b[1], p.a[2] * p.b[2], 100});
  }
}

TEST_CASE("textures: inside divergent control flow only the lanes that ask are answered") {
  RunInput input;
  input.points = assorted_points(7);
  const RunOutput out = run_snippet(
      "vec4 t = vec4(5); for (int k = 0; k < abs(i.x) % 4; ++k) t = textureLod(t0, t.yx + float(k), 0.0); "
      "color = t;",
      input, samplers(1));
  for (int k = 0; k < models::kWarpQuads; ++k) {
    Vec4 t{5, 5, 5, 5};
    for (int n = 0; n < std::abs(input.points[static_cast<std::size_t>(k)].i[0]) % 4; ++n)
      t = {t[1] + static_cast<float>(n), t[0] + static_cast<float>(n), 0, 1};
    CHECK(out.point(k) == t);
  }
}

TEST_CASE("textures: a vertex shader samples at an explicit level") {
  const auto vertex = vertex_spirv(
      "#version 450\nlayout(set=0,binding=2) uniform sampler2D t; layout(location=0) in vec2 p;\nvoid main() "
      "{ gl_Position = texture(t, "
      "p); }");
  const auto fragment =
      fragment_spirv("#version 450\nlayout(location=0) out vec4 c; void main() { c = vec4(1); }");
  const CompiledPipeline p = compile_pipeline(vertex, "v", fragment, "f");
  CHECK(std::any_of(p.vertex.code.begin(), p.vertex.code.end(),
                    [](const models::Instruction& i) { return i.op == models::Op::kTexLod; }));
  RunInput input;
  input.texture = [](int, float u, float v, float) { return Vec4{v, u, 3, 4}; };
  const auto out = run_vertex(
      p.vertex, [](int, int component, int lane) { return static_cast<float>(lane + component * 50); },
      input);
  CHECK(std::bit_cast<float>(out[0][9]) == 59.0f);
  CHECK(std::bit_cast<float>(out[1][9]) == 9.0f);
}

namespace {

/// What is said of a program whose textures are turned into such of several samples, or back.
std::string said_of_samples(const std::string& body, const std::string& sampler, std::uint32_t multisampled) {
  std::vector<std::uint32_t> words =
      fragment_spirv(fragment_source(body, "layout(set=0,binding=0) uniform " + sampler + " t;"));
  for (std::size_t at = 5; at < words.size(); at += words[at] >> 16)
    if ((words[at] & 0xffff) == spv::OpTypeImage) words[at + 6] = multisampled;
  try {
    (void)compile_pipeline(vertex_spirv(plain_vertex_source()), "v", words, "f");
  } catch (const UserError& error) { return error.what(); }
  return "compiles";
}

}  // namespace

TEST_CASE("textures: samples of a texel are fetched by a word of their own, and are counted") {
  const models::Program p = compile_fragment(fragment_source(
      "ivec3 n = textureSize(s); color = texelFetch(t, i.xy, i.z) + texelFetch(s, i.xyz, 2) + "
      "vec4(textureSize(t), n.z + textureSamples(s), 0);",
      "layout(set=1, binding=0) uniform sampler2DMS t; layout(set=1, binding=1) uniform "
      "sampler2DMSArray s;"));
  REQUIRE(p.textures.size() == 2);
  for (const models::TextureBinding& texture : p.textures)
    CHECK(texture.view == (texture.binding == 0 ? models::ViewKind::k2DMultisampled
                                                : models::ViewKind::k2DMultisampledArray));
  REQUIRE(p.texture_operations.size() == 2);
  for (const models::TextureOperation& operation : p.texture_operations) {
    CHECK(operation.ask == models::TextureAsk::kFetch);
    CHECK(operation.level == models::LevelFrom::kLevel);
  }
  const std::string listing = models::disassemble(p);
  CHECK_THAT(listing, Catch::Contains(" 2d-ms\n") && Catch::Contains(" 2d-ms-array\n"));
  CHECK(models::disassemble(models::assemble(listing, p.name)) == listing);
}

/// Most of it by SPIR-V's own rules.
TEST_CASE("textures: of several samples a texel nothing but fetches and sizes is asked") {
  const auto refused = [](const char* body, const char* what, bool multisampled = true) {
    const std::string said =
        said_of_samples(body, multisampled ? "sampler2D" : "sampler2DMS", multisampled ? 1 : 0);
    CHECK_THAT(said, Catch::StartsWith("f:") && Catch::Contains(what));
    CHECK(said.find('\n') == std::string::npos);
  };
  refused("color = texture(t, a.xy);", "Sampling operation is invalid for multisample image");
  refused("color = textureLod(t, a.xy, 1.0);", "Sampling operation is invalid for multisample image");
  refused("color = textureProj(t, a.xyz);", "'MS' parameter to be 0");
  refused("color = textureGather(t, a.xy);", "Gather operation is invalid for multisample image");
  refused("color = vec4(textureQueryLod(t, a.xy), 0, 0);",
          "f:5: OpImageQueryLod of a texture of several samples is not supported");
  refused("color = vec4(textureQueryLevels(t));",
          "f:5: OpImageQueryLevels of a texture of several samples is not supported");
  refused("color = vec4(textureSize(t, 0), 0, 0);", "'MS' must be 0");
  refused("color = texelFetch(t, i.xy, 0);", "Sample is required");
  refused("color = texelFetch(t, i.xy, 1);", "Sample requires non-zero 'MS'", false);
  refused("color = vec4(textureSize(t), 0, 0);", "'MS'=1", false);
  refused("color = vec4(textureSamples(t));", "'MS' must be 1", false);
}

}  // namespace quadrille::pipeline
