/// SPIR-V modules: the compiler, with the module as either stage, and the reference's own decoder.
#include <cstring>

#include "models/reference/decode.h"
#include "pipeline/compiler/compile.h"
#include "scenes/material/glsl.h"
#include "tests/fuzz/refusal.h"
#include "tests/fuzz/targets.h"

namespace quadrille::fuzz {
namespace {

using Words = std::vector<std::uint32_t>;

/// Writes every location that the corpus's fragment shaders read.
constexpr std::string_view kVertex = R"(#version 450
layout(location=0) out vec4 a; layout(location=1) out vec4 b; layout(location=2) flat out ivec4 i;
void main() { a = vec4(1); b = vec4(2); i = ivec4(3); gl_Position = vec4(0); })";
constexpr std::string_view kFragment =
    "#version 450\nlayout(location=0) out vec4 color;\nvoid main() { color = vec4(1); }";

}  // namespace

void run_spirv(Bytes bytes) {
  using traces::ShaderStage;
  static const Words vertex = scenes::compile_glsl(kVertex, ShaderStage::kVertex, "plain.vert");
  static const Words fragment = scenes::compile_glsl(kFragment, ShaderStage::kFragment, "plain.frag");
  Words words(bytes.size() / 4);
  if (!words.empty()) std::memcpy(words.data(), bytes.data(), words.size() * 4);
  done_or_refused("", [&] { (void)pipeline::compile_pipeline(vertex, "plain.vert", words, "given.frag"); });
  done_or_refused("", [&] { (void)pipeline::compile_pipeline(words, "given.vert", fragment, "plain.frag"); });
  for (const ShaderStage stage : {ShaderStage::kVertex, ShaderStage::kFragment})
    done_or_refused("given", [&] { (void)models::reference::decode_shader({"given", stage, words}); });
}

}  // namespace quadrille::fuzz
