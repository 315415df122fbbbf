/// What a user can get wrong, and modules that no compiler made: always one clear line, never a crash.
#include "models/base/error.h"
#include "scenes/material/glsl.h"
#include "tests/pipeline/compiler/shader_runner.h"

#include <catch2/catch.hpp>
#include <spirv/unified1/spirv.hpp>

namespace quadrille::pipeline {
namespace {

/// The error of a fragment shader.
std::string error_of(const std::string& body, const std::string& declarations = {}) {
  try {
    (void)compile_fragment(fragment_source(body, declarations));
  } catch (const UserError& e) { return e.what(); }
  return "compiles";
}

const char* const kRichFragment = R"(#version 450
layout(location=0) in vec4 a; layout(location=1) in vec4 b; layout(location=2) flat in ivec4 i; layout(location=0) out vec4 color;
layout(set=1, binding=0) uniform sampler2D t; layout(set=0, binding=1, std140) uniform U { mat4 m; vec4 l[4]; int n; } u;
float sum(vec4 x) { for (int k = 0; k < 4; ++k) { if (x[k] < 0.0) continue; if (x[k] > 3.0) return x[k]; } return dot(x, b); }
void main() {
  vec4 c = u.m * texture(t, a.xy);
  for (int k = 0; k < u.n; ++k) { if (i.x == k) discard; c += u.l[k] * sum(c); }
  switch (i.y) { case 0: c *= 2.0; break; case 1: c -= a; default: c = normalize(c); }
  color = c + pow(b, a);
})";

}  // namespace

TEST_CASE("glsl: an error names file and line") {
  CHECK_THROWS_WITH(scenes::compile_glsl("#version 450\nvoid main() {\n  int x = nothing;\n}\n",
                                         traces::ShaderStage::kFragment, "my.frag"),
                    Catch::Contains("my.frag:3:") && Catch::Contains("nothing") && !Catch::Contains("\n"));
  CHECK_THROWS_WITH(scenes::compile_glsl("", traces::ShaderStage::kVertex, "empty.vert"),
                    Catch::Contains("empty.vert") && !Catch::Contains("\n"));
}

TEST_CASE("glsl: defines come before the first line") {
  const std::string defines[] = {"SCALE 3.0", "ON"};
  CHECK_NOTHROW(scenes::compile_glsl(
      "#version 450\nlayout(location=0) out vec4 c;\n#ifdef ON\nvoid main() { c = vec4(SCALE); }\n#endif\n",
      traces::ShaderStage::kFragment, "d.frag", defines));
  const std::string bad[] = {"A\nB"};
  CHECK_THROWS_AS(scenes::compile_glsl("", traces::ShaderStage::kFragment, "d.frag", bad), UserError);
}

TEST_CASE("unsupported features are refused by name and line") {
  CHECK_THAT(error_of("color = textureGrad(t, a, a.xyz, a.yzw);",
                      "layout(set=0,binding=0) uniform samplerCubeArray t;"),
             Catch::Contains("test.frag:") && Catch::Contains("10 words"));
  CHECK_THAT(error_of("color = texelFetch(t, i.x);", "layout(set=0,binding=0) uniform samplerBuffer t;"),
             Catch::Contains("'t'") && Catch::Contains("sampler"));
  CHECK_THAT(error_of("color = texture(t[0], a.xy);", "layout(set=0,binding=0) uniform sampler2D t[257];"),
             Catch::Contains("at most 256"));
  CHECK_THAT(error_of("s[i.x].x[0] = 1; color = a;", "layout(set=0,binding=0) buffer S { int x[]; } s[2];"),
             Catch::Contains("test.frag") && Catch::Contains("array of buffers"));
  CHECK_THAT(error_of("double d = double(a.x); color = vec4(d);"), Catch::Contains("test.frag"));
  CHECK_THAT(error_of("other = a; color = a;", "layout(location=8) out vec4 other;"),
             Catch::Contains("other"));
  CHECK_THAT(error_of("color = vec4(gl_ClipDistance[0]);", "in float gl_ClipDistance[1];"),
             Catch::Contains("gl_ClipDistance"));
  const auto vertex = vertex_spirv(
      "#version 450\nlayout(location=40) in vec2 p; void main() { gl_Position = vec4(p, 0, 1); }");
  const auto fragment =
      fragment_spirv("#version 450\nlayout(location=0) out vec4 c; void main() { c = vec4(1); }");
  CHECK_THROWS_WITH(compile_pipeline(vertex, "i.vert", fragment, "f.frag"),
                    Catch::Contains("i.vert") && Catch::Contains("'p'"));
  CHECK_THROWS_WITH(compile_pipeline(fragment, "i.vert", fragment, "f.frag"),
                    Catch::Contains("i.vert") && Catch::Contains("entry point"));
}

TEST_CASE("a refusal names what is not supported, where it is, and what to write instead") {
  const std::string sampler = "layout(set=0,binding=0) uniform sampler2D t;";
  CHECK_THAT(error_of("double d = double(a.x); color = vec4(d);"),
             Catch::Contains("test.frag:5:") && Catch::Contains("64-bit floats (double)"));
  CHECK_THAT(error_of("color = vec4(int64_t(i.x) * 3);",
                      "#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require"),
             Catch::Contains("test.frag:5:") && Catch::Contains("64-bit integers"));
  CHECK_THAT(error_of("imageStore(s, ivec2(0), a); color = a;",
                      "layout(set=0,binding=0,rgba8) uniform writeonly image2D s;"),
             Catch::Contains("'s'") && Catch::Contains("sampler2D"));
  CHECK_THAT(
      error_of("color = interpolateAtOffset(a, vec2(0.25));"),
      Catch::Contains("test.frag:5:") && Catch::Contains("interpolateAtOffset") && Catch::Contains("dFdx"));
  CHECK_THAT(error_of("uint h, l; umulExtended(uint(i.x), 3u, h, l); color = vec4(h, l, 0, 0);"),
             Catch::Contains("test.frag:5:") && Catch::Contains("umulExtended"));
  CHECK_THAT(error_of("uint c; uint s = uaddCarry(uint(i.x), 3u, c); color = vec4(s, c, 0, 0);"),
             Catch::Contains("OpIAddCarry"));
  CHECK_THAT(error_of("color = vec4(subgroupElect());", "#extension GL_KHR_shader_subgroup_basic : require"),
             Catch::Contains("test.frag:5:") && Catch::Contains("OpGroupNonUniformElect"));
}

TEST_CASE("an entry point of another name or stage is named") {
  const auto vertex = vertex_spirv(plain_vertex_source());
  CHECK_THROWS_WITH(
      compile_pipeline(vertex, "v.vert", vertex, "f.frag"),
      Catch::Contains("f.frag") && Catch::Contains("fragment stage; it has 'main' of another stage"));
}

TEST_CASE("spir-v: what other entry points of a module compute is not looked at") {
  const auto vertex = vertex_spirv(plain_vertex_source());
  std::vector<std::uint32_t> fragment =
      fragment_spirv(fragment_source("vec4 v[2] = vec4[2](a, b); color = v[i.x & 1];"));
  // A second entry point for the same function under another name, and "main" for one of nothing.
  std::vector<std::uint32_t> both(fragment.begin(), fragment.begin() + 5);
  const std::uint32_t bound = fragment[3], nothing = bound, label = bound + 1;
  both[3] = bound + 2;
  std::uint32_t void_type = 0, function_type = 0, main_function = 0;
  for (std::size_t at = 5; at < fragment.size(); at += fragment[at] >> 16) {
    const auto op = static_cast<spv::Op>(fragment[at] & 0xffff);
    const std::vector<std::uint32_t> words(
        fragment.begin() + static_cast<std::ptrdiff_t>(at),
        fragment.begin() + static_cast<std::ptrdiff_t>(at + (fragment[at] >> 16)));
    both.insert(both.end(), words.begin(), words.end());
    if (op == spv::OpEntryPoint) {
      both[both.size() - words.size() + 3] = 0x6e69616e;  // "nain"
      std::vector<std::uint32_t> again = words;
      again[2] = nothing;
      both.insert(both.end(), again.begin(), again.end());
    }
    if (op == spv::OpExecutionMode) both.insert(both.end(), {words[0], nothing, words[2]});
    if (op == spv::OpFunction) void_type = words[1], function_type = words[4], main_function = words[2];
  }
  REQUIRE(main_function != 0);
  both.insert(both.end(),
              {5u << 16 | spv::OpFunction, void_type, nothing, 0, function_type, 2u << 16 | spv::OpLabel,
               label, 1u << 16 | spv::OpReturn, 1u << 16 | spv::OpFunctionEnd});
  CHECK(compile_pipeline(vertex, "v", both, "f").fragment.varyings.empty());
}

TEST_CASE("a loop that nothing leads out of is refused with its line, whatever it computes") {
  const auto endless = Catch::Contains("a loop without an end");
  for (const char* body :
       {"for (;;) {}", "while (true) { color.x += 1.0; }",
        "while (1 < 2) { color.x += 1.0; if (color.x > 5.0) continue; }", "do { ++r; } while (true);",
        "if (a.x > 0.0) for (;;) {}", "while (true) { while (true) { if (++r > 3) break; } }",
        "while (a.x > 0.0) { for (;;) {} }", "switch (i.x) { case 0: for (;;) {} default: ++r; }"}) {
    CAPTURE(body);
    CHECK_THAT(error_of("color = a; int r = i.x;\n" + std::string(body)),
               Catch::StartsWith("test.frag:") && endless);
  }
  CHECK_THAT(
      error_of("color = f(a);",
               "vec4 g(vec4 x) { while (true) x += b; return x; }\nvec4 f(vec4 x) { return g(x) + x; }"),
      endless);
}

TEST_CASE(
    "a loop that a break, a return or a discard can end, or that is never reached, is none without an end") {
  for (const char* body :
       {"while (true) { if (++r > 3) break; }", "for (;;) { color.x += 1.0; if (color.x > 5.0) return; }",
        "while (true) { if (color.x > 0.5) discard; color.x += 1.0; }", "if (false) for (;;) {}",
        "while (true) { color.x += 1.0; h(color.x); }", "while (true) { k(color.x += 1.0); }",
        "while (true) { switch (r) { case 3: color.x = f(a.x); return; default: ++r; } }"}) {
    CAPTURE(body);
    CHECK(error_of("color = a; int r = 0;\n" + std::string(body),
                   "void h(float x) { if (x > 5.0) discard; }\nvoid k(float x) { if (x > 3.0) h(x); }\n"
                   "float unused(float x) { for (;;) x += 1.0; return x; }\nfloat f(float x) { while (true) "
                   "{ x += 1.0; if (x > 9.0) "
                   "return x; } }") == "compiles");
  }
}

TEST_CASE("limits are refused with the number that was needed") {
  std::string body = "float s = 0.0;";
  for (int k = 0; k < 300; ++k)
    body += " float v" + std::to_string(k) + " = exp2(a.x * " + std::to_string(k) + ".5);";
  body += " if (i.x > 0) discard;";
  for (int k = 0; k < 300; ++k) body += " s += v" + std::to_string(k) + " * s;";
  for (int k = 0; k < 300; ++k) body += " s *= v" + std::to_string(k) + ";";
  CHECK_THAT(error_of(body + " color = vec4(s);"), Catch::Contains("registers"));
  std::string nest = "int r = 0;", end;
  for (int k = 0; k < 40; ++k) {
    nest += " for (int j" + std::to_string(k) + " = 0; j" + std::to_string(k) + " < i.x; ++j" +
            std::to_string(k) + ") {";
    end += " }";
  }
  CHECK_THAT(error_of(nest + " ++r;" + end + " color = vec4(r);"), Catch::Contains("nested"));
  std::string calls = "float f0(float x) { return x * a.x + x; }\n";
  for (int k = 1; k < 24; ++k) {
    const std::string below = "f" + std::to_string(k - 1);
    calls +=
        "float f" + std::to_string(k) + "(float x) { return " + below + "(x) + " + below + "(x + 1.0); }\n";
  }
  CHECK_THAT(error_of("color = vec4(f23(a.y));", calls), Catch::Contains("expanded in place"));
}

TEST_CASE("spir-v: nothing, text and other byte orders are refused") {
  const auto vertex = vertex_spirv(plain_vertex_source());
  const std::vector<std::uint32_t> nothing, text(64, 0x64616548u), swapped(64, 0x03022307u);
  for (const auto* words : {&nothing, &text, &swapped}) {
    CHECK_THROWS_WITH(compile_pipeline(vertex, "v", *words, "bad.spv"), Catch::Contains("bad.spv"));
    CHECK_THROWS_WITH(compile_pipeline(*words, "bad.spv", vertex, "v"),
                      Catch::Contains("bad.spv") || Catch::Contains("entry point"));
  }
}

TEST_CASE("spir-v: truncated and damaged modules never crash") {
  const auto vertex = vertex_spirv(plain_vertex_source());
  const auto fragment = fragment_spirv(kRichFragment);
  int refused = 0, accepted = 0;
  const auto attempt = [&](const std::vector<std::uint32_t>& words) {
    try {
      (void)compile_pipeline(vertex, "v", words, "f");
      ++accepted;
    } catch (const UserError& e) {
      ++refused;
      CHECK(std::string_view(e.what()).find('\n') == std::string_view::npos);
    }
  };
  for (std::size_t size = 0; size < fragment.size(); size += 7)
    attempt({fragment.begin(), fragment.begin() + static_cast<std::ptrdiff_t>(size)});
  Random random(1234);
  for (int k = 0; k < 2500; ++k) {
    std::vector<std::uint32_t> damaged = fragment;
    for (std::uint32_t n = random() % 3 + 1; n > 0; --n) {
      std::uint32_t& word = damaged[5 + random() % (damaged.size() - 5)];
      switch (random() % 4) {
        case 0: word ^= 1u << (random() % 32); break;
        case 1: word = random() % 300; break;
        case 2: word = damaged[5 + random() % (damaged.size() - 5)]; break;
        default: word += random() % 3 - 1; break;
      }
    }
    attempt(damaged);
  }
  CHECK(refused > 1000);
  CHECK(accepted > 0);
}

}  // namespace quadrille::pipeline
