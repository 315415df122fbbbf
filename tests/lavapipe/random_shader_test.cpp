/// Random structured programs, compiled by us, against the Vulkan driver's compiler, pixel by pixel.
/// QUADRILLE_SHADER_SEEDS="FIRST COUNT" runs other seeds.
#include "tests/pipeline/compiler/random_shader_run.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>
#include <regex>
#include <string>

#include "models/base/error.h"
#include "scenes/material/glsl.h"
#include "tests/lavapipe/vulkan_renderer.h"

namespace quadrille::lavapipe {
namespace {

using pipeline::RandomShader;
using pipeline::RandomShaderResult;
using traces::ShaderStage;

constexpr std::uint32_t kColumns = 8, kBatch = 64;                ///< programs side by side in one picture
constexpr std::uint32_t kTileWidth = 16, kTileHeight = 2;         ///< a warp's worth of pixels
constexpr std::array<std::uint32_t, 4> kClear{11, 222, 33, 251};  ///< 255ths, where a program discarded

std::uint32_t clear_word() { return kClear[0] | kClear[1] << 8 | kClear[2] << 16 | kClear[3] << 24; }

traces::Index add_shader(traces::CommandStream& stream, const std::string& source, ShaderStage stage) {
  stream.shaders.push_back({"random", stage, scenes::compile_glsl(source, stage, "random")});
  return static_cast<traces::Index>(stream.shaders.size() - 1);
}

/// Every program, as GLSL, in a tile of its own.
traces::CommandStream stream_of(const std::vector<std::string>& programs) {
  traces::CommandStream stream;
  stream.name = "random shaders";
  const std::uint32_t width = kColumns * kTileWidth, height = (kBatch / kColumns) * kTileHeight;
  constexpr float kCorners[] = {-1, -1, 0, 1, 3, -1, 0, 1, -1, 3, 0, 1};
  stream.buffers.push_back({"corners", std::vector<std::byte>(sizeof(kCorners))});
  std::memcpy(stream.buffers[0].data.data(), kCorners, sizeof(kCorners));
  const traces::Index vertex =
      add_shader(stream, "#version 450\nlayout(location = 0) in vec4 p;\nvoid main() { gl_Position = p; }",
                 ShaderStage::kVertex);
  std::array<float, 4> clear{};
  for (std::size_t c = 0; c < 4; ++c) clear[c] = static_cast<float>(kClear[c]) / 255.0f;
  const traces::BeginPass pass = traces::make_pass(
      stream, {width, height, traces::Format::kR8G8B8A8Unorm, traces::Format::kUndefined}, clear);
  stream.commands = {pass,
                     traces::SetViewport{0, 0, static_cast<float>(width), static_cast<float>(height), 0, 1}};
  for (std::uint32_t k = 0; k < programs.size(); ++k) {
    traces::Pipeline pipeline;
    pipeline.vertex_shader = vertex;
    pipeline.fragment_shader = add_shader(stream, programs[k], ShaderStage::kFragment);
    pipeline.bindings = {{0, 4 * sizeof(float), false}};
    pipeline.attributes = {{0, 0, traces::Format::kR32G32B32A32Float, 0}};
    stream.pipelines.push_back(pipeline);
    stream.commands.emplace_back(traces::BindPipeline{k});
    stream.commands.emplace_back(traces::BindVertexBuffer{0, 0, 0});
    stream.commands.emplace_back(traces::SetScissor{static_cast<std::int32_t>(k % kColumns * kTileWidth),
                                                    static_cast<std::int32_t>(k / kColumns * kTileHeight),
                                                    kTileWidth, kTileHeight});
    traces::Draw draw;
    draw.count = 3;
    stream.commands.emplace_back(draw);
  }
  stream.commands.emplace_back(traces::EndPass{});
  traces::validate(stream);
  return stream;
}

/// What the driver drew in tile `k`, in the order of a warp's lanes.
RandomShaderResult tile_of(const Rendered& image, std::uint32_t k) {
  RandomShaderResult result{};
  for (std::size_t lane = 0; lane < result.size(); ++lane) {
    const std::size_t x = k % kColumns * kTileWidth + 2 * (lane / 4) + lane % 2,
                      y = k / kColumns * kTileHeight + lane % 4 / 2;
    result[lane] = image.color[y * image.width + x];
  }
  return result;
}

/// Ours, with the clear colour where the program discarded; nothing for a program beyond a limit of the
/// machine.
std::optional<RandomShaderResult> ours(const RandomShader& shader) {
  try {
    RandomShaderResult result = pipeline::run_compiled(shader);
    for (std::uint64_t& pixel : result) {
      if (pixel == pipeline::kDiscarded) pixel = clear_word();
    }
    return result;
  } catch (const UserError&) { return std::nullopt; }  // the reference's test judges refusals
}

/// What the driver draws where every lane of its vector is the same pixel: a program for each pixel, with the
/// pixel's place in it as a constant.
///
/// Beside other pixels, llvmpipe (Mesa 22.3) goes wrong in two ways, both shown below. A discarded pixel only
/// loses its coverage and runs on: in a loop whose body always ends in a discard it never comes to the next
/// step, and goes round until the 65535 rounds that all loops of a program share are used up; from then on
/// the loops of the pixels beside it end after one round. And what a loop computes in its last round, and is
/// read after it, is computed again for pixels that have left the loop, from what they have made of its
/// operands since, as long as a pixel beside them goes round.
RandomShaderResult drawn_alone(VulkanRenderer& renderer, const RandomShader& shader) {
  RandomShaderResult result{};
  std::vector<std::string> programs;
  for (std::size_t lane = 0; lane < result.size(); ++lane) {
    const std::string place = fmt::format("vec2({}.5, {}.5)", 2 * (lane / 4) + lane % 2, lane % 4 / 2);
    programs.push_back(std::regex_replace(shader.source(), std::regex("gl_FragCoord"), place));
  }
  const Rendered image = renderer.render(stream_of(programs));
  for (std::uint32_t lane = 0; lane < result.size(); ++lane) result[lane] = tile_of(image, lane)[lane];
  return result;
}

bool differs(VulkanRenderer& renderer, const RandomShader& shader) {
  try {
    const std::optional<RandomShaderResult> expected = ours(shader);
    return expected && tile_of(renderer.render(stream_of({shader.source()})), 0) != *expected &&
           drawn_alone(renderer, shader) != *expected;
  } catch (const UserError&) { return false; }  // what was left out of it made it no program
}

/// None on a machine without the driver, which is said.
std::unique_ptr<VulkanRenderer> driver() {
  try {
    return std::make_unique<VulkanRenderer>();
  } catch (const UserError& error) {
    WARN("skipped: " << error.what());
    return nullptr;
  }
}

RandomShader program_of(const std::string& statements) {
  RandomShader shader;
  shader.functions.push_back(
      {"void main() {\n  int x0 = int(gl_FragCoord.x) & 15, x1 = int(gl_FragCoord.y) & 1, x2 = (x0 * 5 + x1 "
       "* 3) & 7;\n",
       "  color = vec4(x0, x1, x2, 1) / 255.0;\n",
       {{{statements}, {}}}});
  return shader;
}

/// `by_hand` computes x0, x1 and x2 of a pixel, and whether it lives.
void check_by_hand(const std::string& statements,
                   bool (*by_hand)(std::uint32_t& x0, std::uint32_t& x1, std::uint32_t& x2)) {
  const RandomShader shader = program_of(statements);
  RandomShaderResult expected{};
  for (std::uint32_t lane = 0; lane < expected.size(); ++lane) {
    std::uint32_t x0 = 2 * (lane / 4) + lane % 2, x1 = lane % 4 / 2, x2 = (x0 * 5 + x1 * 3) & 7;
    expected[lane] = by_hand(x0, x1, x2) ? x0 | x1 << 8 | x2 << 16 | 1u << 24 : clear_word();
  }
  CHECK(ours(shader) == expected);
  const std::unique_ptr<VulkanRenderer> renderer = driver();
  if (!renderer) return;
  CHECK(drawn_alone(*renderer, shader) == expected);
  if (tile_of(renderer->render(stream_of({shader.source()})), 0) == expected)
    WARN(renderer->info().name
         << " draws this right beside other pixels too: drawn_alone is not needed for it");
}

}  // namespace

TEST_CASE("lavapipe random shaders: a loop whose body always ends in a discard") {
  check_by_hand(
      "[[dont_unroll]] for (int i = 3; i > 0; --i) { ++x1; for (int k = 0, end = (x2 & 3); k < end; ++k) { "
      "discard; } }",
      [](std::uint32_t&, std::uint32_t& x1, std::uint32_t& x2) {
        x1 += 3;
        return (x2 & 3) == 0;
      });
}

TEST_CASE("lavapipe random shaders: what the last round of a loop computes") {
  check_by_hand(
      "int k = 0, end = (x2 & 3); do { ++k; x0 = (x1 * 5 + x2) & 255; x2 = min(x2, 200) + 2; } while (k < "
      "end);",
      [](std::uint32_t& x0, std::uint32_t& x1, std::uint32_t& x2) {
        const std::uint32_t rounds = std::max(x2 & 3, 1u);
        x2 += 2 * rounds;
        x0 = x1 * 5 + x2 - 2;
        return true;
      });
}

TEST_CASE("lavapipe random shaders: every pixel is the driver's") {
  const std::unique_ptr<VulkanRenderer> renderer = driver();
  if (!renderer) return;
  const pipeline::Seeds seeds = pipeline::seeds_or({2000, 4 * kBatch});
  fmt::print("random shaders: QUADRILLE_SHADER_SEEDS=\"{} {}\"\n", seeds.first, seeds.count);
  std::uint32_t compared = 0;
  for (std::uint32_t first = 0; first < seeds.count; first += kBatch) {
    std::vector<RandomShader> programs;
    std::vector<std::string> sources;
    for (std::uint32_t k = first; k < std::min(first + kBatch, seeds.count); ++k) {
      programs.push_back(pipeline::random_shader(seeds.first + k, ShaderStage::kFragment));
      sources.push_back(programs.back().source());
    }
    const Rendered image = renderer->render(stream_of(sources));
    for (std::uint32_t k = 0; k < programs.size(); ++k) {
      const std::optional<RandomShaderResult> expected = ours(programs[k]);
      if (!expected) continue;
      ++compared;
      if (tile_of(image, k) == *expected || drawn_alone(*renderer, programs[k]) == *expected) continue;
      const RandomShader small = pipeline::shrink(
          programs[k], [&](const RandomShader& candidate) { return differs(*renderer, candidate); });
      FAIL_CHECK("seed " << seeds.first + first + k << " differs from " << renderer->info().name << "\n"
                         << small.source());
    }
  }
  CHECK(compared * 50 >= seeds.count * 49);
}

}  // namespace quadrille::lavapipe
