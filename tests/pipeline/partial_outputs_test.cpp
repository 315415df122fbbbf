/// Outputs that programs write on some paths only: what is left unwritten is zero on every machine, never
/// what an older warp wrote.
#include "scenes/material/glsl.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/storage_stream.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::pipeline::test;

namespace {

constexpr const char* kVertex = R"(#version 450
layout(location = 0) in vec4 position; layout(location = 1) in vec4 color;
layout(location = 0) out vec4 v_color;
void main() {
  if (gl_VertexIndex % 5 != 3) gl_Position = position;
  if (gl_VertexIndex % 4 != 1) v_color = color;
})";

constexpr const char* kFragment = R"(#version 450
layout(location = 0) in vec4 v_color;
layout(location = 0) out vec4 o;
void main() {
  for (int i = 0; i < int(v_color.b * 4.0); ++i) o.b = v_color.b * float(i) / 4.0;
  if (v_color.r > 0.5) { o.rg = v_color.rg; if (v_color.g > 0.3) o.a = 1.0; }
})";

/// Triangles with programs that write everything, and the same again with ones that do not.
traces::CommandStream partial_stream(std::uint64_t seed) {
  traces::CommandStream stream = storage_stream(seed, {});
  const auto first = static_cast<traces::Index>(stream.shaders.size());
  const auto add = [&](const char* source, traces::ShaderStage stage) {
    stream.shaders.push_back({"partial", stage, scenes::compile_glsl(source, stage, "partial")});
  };
  add(kVertex, traces::ShaderStage::kVertex);
  add(kFragment, traces::ShaderStage::kFragment);
  stream.pipelines[0].depth = {};
  stream.pipelines.push_back(stream.pipelines[0]);
  stream.pipelines[1].vertex_shader = first;
  stream.pipelines[1].fragment_shader = first + 1;
  const traces::Command draw = stream.commands[stream.commands.size() - 2];
  stream.commands.insert(stream.commands.end() - 1, {traces::BindPipeline{1}, draw, traces::BindPipeline{0},
                                                     draw, traces::BindPipeline{1}, draw});
  traces::validate(stream);
  return stream;
}

}  // namespace

TEST_CASE("partial outputs: twenty random machines draw what the functional run draws") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const traces::CommandStream stream = partial_stream(1 + seed / 5);
    INFO("machine " << seed);
    CHECK(machine_faults(stream, seed) == "");
  }
}
