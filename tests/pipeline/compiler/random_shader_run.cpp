#include "tests/pipeline/compiler/random_shader_run.h"

#include "models/reference/shader_program.h"
#include "models/shader/warp.h"
#include "pipeline/compiler/compile.h"
#include "scenes/material/glsl.h"
#include "tests/pipeline/compiler/shader_runner.h"

#include <bit>
#include <cmath>
#include <limits>

namespace quadrille::pipeline {
namespace {

using models::kWarpLanes;
using traces::ShaderStage;

constexpr std::uint32_t kFirstVertex = 96;

const std::vector<std::uint32_t>& plain_vertex() {
  static const auto words = vertex_spirv("#version 450\nvoid main() { gl_Position = vec4(0, 0, 0, 1); }");
  return words;
}
const std::vector<std::uint32_t>& plain_fragment() {
  static const auto words = fragment_spirv(
      "#version 450\nlayout(location = 0) flat in vec4 v; layout(location = 0) out vec4 color;\nvoid main() "
      "{ color = v; }");
  return words;
}

std::vector<std::uint32_t> words_of(const RandomShader& shader) {
  return scenes::compile_glsl(shader.source(), shader.stage, "random");
}

std::uint64_t byte_of(double value, int channel) {
  return static_cast<std::uint64_t>(std::lround(value * 255)) << (8 * channel);
}

/// Runs to the end and packs the four output rows from `first_row`.
RandomShaderResult run_warp(models::Warp& warp, const models::Program& program,
                            std::span<models::LaneWords> outputs, std::size_t first_row) {
  warp.outputs = outputs.data();
  const std::vector<std::uint32_t> constants = constant_file(program.constants, {});
  warp.launch(program, constants.data(), 0xffffffffu);
  while (models::run_clause(warp).end != models::ClauseEnd::kProgramEnd) {}
  RandomShaderResult result{};
  for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
    for (int c = 0; c < 4; ++c)
      result[lane] |=
          byte_of(std::bit_cast<float>(outputs[first_row + static_cast<std::size_t>(c)][lane]), c);
    if ((warp.killed >> lane & 1u) != 0) result[lane] = kDiscarded;
  }
  return result;
}

RandomShaderResult run_fragment_program(const models::Program& program) {
  models::FragmentInputs in{};
  for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
    in.x[lane] = place_of_lane(lane).x;
    in.y[lane] = place_of_lane(lane).y;
    in.inv_w[lane] = 1;
  }
  std::array<models::LaneWords, models::kFragmentOutputs> outputs{};
  models::Warp warp;
  warp.fragment = &in;
  return run_warp(warp, program, outputs, 0);
}

RandomShaderResult run_vertex_program(const models::Program& program) {
  models::VertexInputs in{};
  for (std::uint32_t lane = 0; lane < kWarpLanes; ++lane) in.vertex_index[lane] = kFirstVertex + lane;
  std::array<models::LaneWords, 8> outputs{};
  models::Warp warp;
  warp.vertex = &in;
  return run_warp(warp, program, outputs, 4);
}

}  // namespace

LanePlace place_of_lane(std::size_t lane) {
  const std::size_t quad = lane / 4, pixel = lane % 4, row = pixel / 2;
  return {16.5f + static_cast<float>(2 * quad + pixel % 2), 20.5f + static_cast<float>(row)};
}

RandomShaderResult run_compiled(const RandomShader& shader, const ShaderTarget& target) {
  const std::vector<std::uint32_t> words = words_of(shader);
  if (shader.stage == ShaderStage::kVertex)
    return run_vertex_program(compile_pipeline(words, "random", plain_fragment(), "plain", target).vertex);
  return run_fragment_program(compile_pipeline(plain_vertex(), "plain", words, "random", target).fragment);
}

RandomShaderResult run_in_reference(const RandomShader& shader) {
  namespace reference = models::reference;
  const reference::ShaderProgram program =
      reference::decode_shader({"random", shader.stage, words_of(shader)});
  RandomShaderResult result{};
  for (std::size_t first = 0; first < kWarpLanes; first += reference::kLanes) {
    reference::Lanes lanes;
    lanes.cells = program.initial;
    lanes.discard_margin.fill(std::numeric_limits<double>::infinity());
    for (int k = 0; k < reference::kLanes; ++k) {
      const std::size_t lane = first + static_cast<std::size_t>(k);
      if (const auto slot = program.builtins.vertex_index; slot != reference::kNoSlot)
        lanes.at(slot)->set_u(k, kFirstVertex + static_cast<std::uint32_t>(lane));
      if (const auto slot = program.builtins.frag_coord; slot != reference::kNoSlot) {
        lanes.at(slot)->set_f(k, static_cast<double>(place_of_lane(lane).x));
        lanes.at(slot + 1)->set_f(k, static_cast<double>(place_of_lane(lane).y));
      }
    }
    reference::execute(program, lanes, reference::kAllLanes);
    for (int k = 0; k < reference::kLanes; ++k) {
      std::uint64_t& bytes = result[first + static_cast<std::size_t>(k)];
      for (const reference::Port& port : program.outputs)
        bytes |= byte_of(lanes.at(port.slot)->f(k), static_cast<int>(port.component));
      if ((lanes.killed >> k & 1u) != 0) bytes = kDiscarded;
    }
  }
  return result;
}

}  // namespace quadrille::pipeline
