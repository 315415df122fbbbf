/// Two thousand random pipelines, every target of theirs pixel by pixel beside the driver's. A frame that
/// differs is shrunk, and left as a trace.
#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "models/base/format.h"
#include "models/memory/surface.h"
#include "pipeline/driver/frame_builder.h"
#include "pipeline/functional/functional.h"
#include "tests/lavapipe/shared_renderer.h"
#include "tests/pipeline/random_pipelines.h"
#include "tests/pipeline/shrink_stream.h"
#include "traces/trace_file.h"

namespace quadrille::lavapipe {
namespace {

using Codes = std::vector<models::PixelCode>;

/// The targets of a stream's last pass, or what they are resolved to, with their formats.
struct Target {
  models::Format format;
  Codes codes;
};
std::vector<Target> our_targets(const traces::CommandStream& stream) {
  pipeline::DeviceFrame frame(std::uint64_t{1} << 30);
  pipeline::build_frame(stream, {}, frame);
  (void)pipeline::render_functional(frame.frame, frame.memory);
  const hw::PassState& pass = frame.frame.passes.back();
  std::vector<Target> targets;
  for (std::size_t c = 0; c < pass.colors; ++c) {
    const hw::AttachmentState& shown = (pass.resolved >> c & 1u) != 0 ? pass.resolve[c] : pass.color[c];
    targets.push_back({shown.format, models::detile_codes(frame.memory, shown.surface)});
  }
  return targets;
}

/// Components may differ by a hundredth and a half, or by as much of themselves: rounding, a few blends long.
/// Integers may not.
bool alike(models::Format format, const models::PixelCode& a, const models::PixelCode& b) {
  if (models::is_integer_format(format)) return a == b;
  const std::array<float, 4> x = models::decode_color(format, a), y = models::decode_color(format, b);
  for (std::size_t c = 0; c < 4; ++c) {
    const float most = std::max(std::abs(x[c]), std::abs(y[c]));
    if (std::abs(x[c] - y[c]) > 0.016f * std::max(1.0f, most)) return false;
  }
  return true;
}

/// The part of the pixels that are alike, of the target with the least.
double part_alike(VulkanRenderer& vulkan, const traces::CommandStream& stream) {
  const std::vector<Target> ours = our_targets(stream);
  const std::vector<Codes> theirs = vulkan.render(stream).targets;
  double least = 1;
  for (std::size_t t = 0; t < ours.size(); ++t) {
    std::size_t same = 0;
    for (std::size_t i = 0; i < ours[t].codes.size(); ++i)
      same += alike(ours[t].format, ours[t].codes[i], theirs[t][i]) ? 1 : 0;
    least = std::min(least, static_cast<double>(same) / static_cast<double>(ours[t].codes.size()));
  }
  return least;
}

constexpr double kLeast = 0.98;
constexpr int kDraws = 16;
constexpr std::uint64_t kStreams = 128;

/// What there is to look at: the stream shrunk to what still differs, as a trace.
std::string report(VulkanRenderer& vulkan, std::uint64_t seed, const traces::CommandStream& stream) {
  const traces::CommandStream small = pipeline::test::shrink(
      stream, [&](const traces::CommandStream& s) { return part_alike(vulkan, s) < kLeast; });
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / fmt::format("pipelines_{}.qtrace", seed);
  traces::write_trace(small, file.string());
  return fmt::format("seed {}: {:.4f} of the pixels are alike; {} draws of {} still differ: {} ({})", seed,
                     part_alike(vulkan, stream), pipeline::test::draws_of(small), kDraws, file.string(),
                     pipeline::test::states_of(small));
}

}  // namespace

TEST_CASE("pipelines: two thousand at random draw the driver's pixels at one and at four samples", "[slow]") {
  VulkanRenderer* const vulkan = renderer();
  if (vulkan == nullptr) return;
  STATIC_REQUIRE(kStreams * kDraws >= 2000);
  const char* const given = std::getenv("QUADRILLE_FIRST_SEED");
  const std::uint64_t first = given == nullptr ? 1 : std::strtoull(given, nullptr, 10);
  for (std::uint64_t seed = first; seed < first + kStreams; ++seed) {
    const traces::CommandStream stream =
        pipeline::test::random_pipelines(seed, {.depth_bounds = false,
                                                .small_floats = false,
                                                .sample_masks = false,
                                                .sample_shading = false,
                                                .sample_scissors = false,
                                                .samples = seed % 3 == 0 ? 4u : 1u,
                                                .draws = kDraws});
    if (part_alike(*vulkan, stream) < kLeast) {
      UNSCOPED_INFO(report(*vulkan, seed, stream));
      CHECK(false);
    }
  }
}

}  // namespace quadrille::lavapipe
