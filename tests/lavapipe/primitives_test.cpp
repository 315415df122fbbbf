/// Points, lines, and triangles drawn by their edges or corners: the machine's picture against lavapipe's,
/// pixel by pixel.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <random>
#include <vector>

#include "models/base/error.h"
#include "pipeline/render.h"
#include "tests/lavapipe/hand_made_stream.h"
#include "tests/lavapipe/shared_renderer.h"

namespace quadrille::lavapipe {
namespace {

using traces::Format;
using traces::LineMode;
using traces::PolygonMode;
using traces::Topology;

constexpr std::uint32_t kSide = 128;

constexpr std::string_view kVertex = R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec2 value;
layout(location = 0) out vec2 v_value;
void main() {
  gl_Position = position;
  gl_PointSize = 1.0 + 15.0 * value.x;
  v_value = value;
})";
constexpr std::string_view kFragment = R"(#version 450
layout(location = 0) in vec2 v_value;
layout(location = 0) out vec4 color;
void main() { color = vec4(v_value, gl_FragCoord.z, 1.0); })";

struct Differences {
  std::size_t drawn = 0;     ///< pixels that either draws
  std::size_t coverage = 0;  ///< drawn by one alone
  std::size_t colors = 0;    ///< drawn by both, a channel apart by more than 2
};

/// `border`: pixels at each side of the target that are not looked at.
Differences compare(const traces::CommandStream& stream, std::size_t border = 0) {
  const Rendered theirs = renderer()->render(stream);
  const auto ours = pipeline::render_functional_frame(stream, {}).image;
  Differences d;
  for (std::size_t i = 0; i < ours.color.size(); ++i) {
    const std::uint32_t a = ours.color[i], b = theirs.color[i];
    const std::size_t x = i % kSide, y = i / kSide;
    if (std::min(std::min(x, y), kSide - 1 - std::max(x, y)) < border) continue;
    if (a == 0 && b == 0) continue;
    ++d.drawn;
    if ((a == 0) != (b == 0)) {
      ++d.coverage;
      continue;
    }
    bool apart = false;
    for (int c = 0; c < 32; c += 8)
      apart = apart || std::abs(static_cast<int>(a >> c & 0xffu) - static_cast<int>(b >> c & 0xffu)) > 2;
    d.colors += apart ? 1u : 0u;
  }
  return d;
}

class Corners {
 public:
  explicit Corners(unsigned seed) : engine_(seed) {}
  float real(float low, float high) {
    return low + (high - low) * static_cast<float>(engine_() >> 8) * 0x1p-24F;
  }
  /// Within `reach` half targets of the middle.
  std::vector<Corner> some(int count, float reach, bool perspective = false) {
    std::vector<Corner> corners;
    for (int i = 0; i < count; ++i) {
      const float w = perspective ? real(0.5F, 3) : 1;
      corners.push_back({{real(-reach, reach) * w, real(-reach, reach) * w, real(0.1F, 0.9F) * w, w},
                         {real(0, 1), real(0, 1)}});
    }
    return corners;
  }

 private:
  std::mt19937 engine_;
};

HandMadeStream made(Topology topology, std::span<const Corner> corners, std::string_view vertex = kVertex,
                    std::string_view fragment = kFragment) {
  HandMadeStream stream(kSide, kSide, Format::kR8G8B8A8Unorm, Format::kUndefined);
  stream.shaders(vertex, fragment).corners(corners).draw(static_cast<std::uint32_t>(corners.size()));
  stream.pipeline().topology = topology;
  return stream;
}

}  // namespace

// Lavapipe also draws points whose centre is beside the view volume; Vulkan clips them.
TEST_CASE("primitives: points are lavapipe's, with their sizes and coordinates") {
  if (renderer() == nullptr) return;
  const auto coordinates = R"(#version 450
layout(location = 0) in vec2 v_value;
layout(location = 0) out vec4 color;
void main() { color = vec4(gl_PointCoord, v_value.y, 1.0); })";
  for (unsigned seed = 0; seed < 8; ++seed) {
    const Differences d = compare(
        made(Topology::kPointList, Corners(seed).some(60, 0.99F, true), kVertex, coordinates).finish());
    INFO("seed " << seed << ", " << d.drawn << " pixels");
    CHECK(d.coverage == 0);
    CHECK(d.colors == 0);
  }
}

/// The parts of pixels that may differ: rectangles are equal, and Bresenham lines but for ends that
/// lavapipe's floats place on the other side of a diamond's edge.
constexpr double kRectangleLimit = 1e-4, kBresenhamLimit = 2e-3;

// Lavapipe cuts lines at the view volume, where the cut is as wide as the line; so pixels near the target's
// border are left out of lines that reach beyond.
TEST_CASE("primitives: lines are lavapipe's") {
  if (renderer() == nullptr) return;
  const auto mode = GENERATE(LineMode::kBresenham, LineMode::kRectangular);
  const auto width = GENERATE(1.0F, 2.0F, 5.0F);
  const auto reach = GENERATE(0.9F, 1.5F);
  std::size_t drawn = 0, coverage = 0, colors = 0;
  for (unsigned seed = 0; seed < 8; ++seed) {
    HandMadeStream stream = made(Topology::kLineList, Corners(seed).some(40, reach, true));
    stream.pipeline().line_mode = mode;
    stream.pipeline().line_width = width;
    const Differences d = compare(stream.finish(), reach > 1 ? 8 : 0);
    drawn += d.drawn, coverage += d.coverage, colors += d.colors;
  }
  INFO("mode " << static_cast<int>(mode) << ", width " << width << ", reach " << reach << ": " << drawn
               << " pixels, coverage differs on " << coverage << ", colours on " << colors);
  // A cut end is snapped to the grid, which turns the line a little.
  const double limit = mode == LineMode::kBresenham || reach > 1 ? kBresenhamLimit : kRectangleLimit;
  CHECK(static_cast<double>(coverage) <= limit * static_cast<double>(drawn));
  CHECK(static_cast<double>(colors) <= limit * static_cast<double>(drawn));
}

TEST_CASE("primitives: each joint of a strip is drawn once") {
  if (renderer() == nullptr) return;
  std::size_t drawn = 0, coverage = 0, colors = 0;
  for (unsigned seed = 0; seed < 8; ++seed) {
    HandMadeStream stream = made(Topology::kLineStrip, Corners(seed).some(30, 0.9F), kVertex, R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(0.125); })");
    stream.pipeline().blend[0] = {true,
                                  traces::BlendFactor::kOne,
                                  traces::BlendFactor::kOne,
                                  traces::BlendFactor::kOne,
                                  traces::BlendFactor::kOne,
                                  traces::BlendOp::kAdd,
                                  traces::BlendOp::kAdd,
                                  0xf};
    const Differences d = compare(stream.finish());
    drawn += d.drawn, coverage += d.coverage, colors += d.colors;
  }
  INFO(drawn << " pixels, coverage differs on " << coverage << ", colours on " << colors);
  CHECK(static_cast<double>(coverage) <= kBresenhamLimit * static_cast<double>(drawn));
  CHECK(static_cast<double>(colors) <= kBresenhamLimit * static_cast<double>(drawn));
}

TEST_CASE("primitives: triangles by their edges or corners are lavapipe's") {
  if (renderer() == nullptr) return;
  const auto polygon = GENERATE(PolygonMode::kLine, PolygonMode::kPoint);
  const auto cull = GENERATE(traces::CullMode::kNone, traces::CullMode::kBack);
  std::size_t drawn = 0, coverage = 0, colors = 0;
  for (unsigned seed = 0; seed < 8; ++seed) {
    HandMadeStream stream = made(Topology::kTriangleStrip, Corners(seed).some(24, 1.0F, true));
    stream.pipeline().polygon_mode = polygon;
    stream.pipeline().cull = cull;
    const Differences d = compare(stream.finish());
    drawn += d.drawn, coverage += d.coverage, colors += d.colors;
  }
  INFO("polygon mode " << static_cast<int>(polygon) << ": " << drawn << " pixels, coverage differs on "
                       << coverage << ", colours on " << colors);
  CHECK(static_cast<double>(coverage) <= kBresenhamLimit * static_cast<double>(drawn));
  CHECK(static_cast<double>(colors) <= kBresenhamLimit * static_cast<double>(drawn));
}

TEST_CASE("primitives: clip and cull distances are lavapipe's") {
  if (renderer() == nullptr) return;
  const auto topology = GENERATE(Topology::kTriangleList, Topology::kLineList, Topology::kPointList);
  constexpr std::string_view kDistances = R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec2 value;
layout(location = 0) out vec2 v_value;
out gl_PerVertex { vec4 gl_Position; float gl_PointSize; float gl_ClipDistance[2]; float gl_CullDistance[1]; };
void main() {
  gl_Position = position;
  gl_PointSize = 5.0;
  gl_ClipDistance[0] = position.x + 0.5 * position.w;
  gl_ClipDistance[1] = value.x - 0.25;
  gl_CullDistance[0] = 0.5 * position.w - position.y;
  v_value = value;
})";
  std::size_t drawn = 0, coverage = 0, colors = 0;
  for (unsigned seed = 0; seed < 8; ++seed) {
    HandMadeStream stream = made(topology, Corners(seed).some(30, 1.0F, true), kDistances);
    const Differences d = compare(stream.finish());
    drawn += d.drawn, coverage += d.coverage, colors += d.colors;
  }
  INFO("topology " << static_cast<int>(topology) << ": " << drawn << " pixels, coverage differs on "
                   << coverage << ", colours on " << colors);
  CHECK(static_cast<double>(coverage) <= kBresenhamLimit * static_cast<double>(drawn));
  CHECK(static_cast<double>(colors) <= kBresenhamLimit * static_cast<double>(drawn));
}

TEST_CASE("primitives: a special index ends strips and fans as lavapipe has it") {
  if (renderer() == nullptr) return;
  const auto topology = GENERATE(Topology::kTriangleStrip, Topology::kTriangleFan, Topology::kLineStrip);
  const std::vector<std::uint8_t> indices{255, 0, 1, 2,  3,   4,  255, 5,  6,  255, 255,
                                          7,   8, 9, 10, 255, 11, 12,  13, 14, 15,  255};
  std::size_t drawn = 0, coverage = 0, colors = 0;
  for (unsigned seed = 0; seed < 8; ++seed) {
    HandMadeStream stream(kSide, kSide, Format::kR8G8B8A8Unorm, Format::kUndefined);
    stream.shaders(kVertex, kFragment).corners(Corners(seed).some(20, 0.95F)).draw_indexed(indices);
    stream.pipeline().topology = topology;
    stream.pipeline().primitive_restart = true;
    const Differences d = compare(stream.finish());
    drawn += d.drawn, coverage += d.coverage, colors += d.colors;
  }
  INFO("topology " << static_cast<int>(topology) << ": " << drawn << " pixels, coverage differs on "
                   << coverage << ", colours on " << colors);
  CHECK(drawn > 5000);
  CHECK(static_cast<double>(coverage) <= kBresenhamLimit * static_cast<double>(drawn));
  CHECK(static_cast<double>(colors) <= kBresenhamLimit * static_cast<double>(drawn));
}

}  // namespace quadrille::lavapipe
