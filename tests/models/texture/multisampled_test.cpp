/// Single samples of surfaces: which lines a fetch reads, what it finds there, and what lies outside.
#include "models/memory/surface.h"
#include "models/texture/sample.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cstring>
#include <memory>

using namespace quadrille::models;

namespace {

constexpr std::uint32_t kWidth = 20, kHeight = 12, kSamples = 4;

/// A surface of integers that say where they lie: 10000 times the sample, 100 times y, x.
struct Surface {
  explicit Surface(std::uint32_t bytes) : layout(allocate_surface(memory, kWidth, kHeight, kSamples, bytes)) {
    for (std::uint32_t s = 0; s < kSamples; ++s)
      for (std::uint32_t y = 0; y < kHeight; ++y)
        for (std::uint32_t x = 0; x < kWidth; ++x) {
          const std::uint32_t value = 10000 * s + 100 * y + x;
          const std::uint64_t in_tile = layout.pixel_address(x, y) - layout.tile_address(x / 8, y / 8);
          std::memcpy(memory.write(layout.tile_address(x / 8, y / 8, s) + in_tile, bytes).data(), &value,
                      bytes);
        }
    view = view_of_surfaces({&layout, 1}, bytes == 4 ? Format::kR32Uint : Format::kR16Uint);
    view.kind = ViewKind::k2DMultisampled;
  }
  DeviceMemory memory{std::uint64_t{1} << 20};
  SurfaceLayout layout;
  TextureView view;
};

/// Fetches of a warp that covers 8 x 4 pixels from (8, 0) on, quad by quad.
struct Fetch {
  Fetch() {
    operation.ask = TextureAsk::kFetch;
    request.op = Op::kTexOp;
    request.operation = &operation;
    request.active = ~0u;
    for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
      const std::size_t quad = lane / 4, pixel = lane % 4;
      set(0, lane, static_cast<std::int32_t>(8 + quad % 4 * 2 + pixel % 2));
      set(1, lane, static_cast<std::int32_t>(quad / 4 * 2 + pixel / 2));
    }
  }
  void set(std::size_t word, std::size_t lane, std::int32_t value) {
    (word == 0 ? request.u : word == 1 ? request.v : request.lod)[lane] = std::bit_cast<float>(value);
  }
  std::array<LaneFloats, 4> of(const Surface& surface) {
    plan_texture(surface.view, {}, request, {}, *plan);
    std::array<LaneFloats, 4> rgba;
    filter_texture(*plan, surface.memory, rgba);
    return rgba;
  }
  TextureOperation operation;
  TextureRequest request;
  std::unique_ptr<TexturePlan> plan = std::make_unique<TexturePlan>();
};

}  // namespace

TEST_CASE("multisampled: one sample of half a tile is the lines of its plane, and of two samples of two") {
  const Surface surface(4);
  Fetch fetch;
  for (std::int32_t sample = 0; sample < static_cast<std::int32_t>(kSamples); ++sample) {
    for (std::size_t lane = 0; lane < kWarpLanes; ++lane) fetch.set(2, lane, sample);
    const auto rgba = fetch.of(surface);
    REQUIRE(fetch.plan->line_count == 1);
    CHECK(std::uint64_t{fetch.plan->lines[0].line} * kLineBytes ==
          surface.layout.tile_address(1, 0, static_cast<std::uint32_t>(sample)));
    CHECK(fetch.plan->lines[0].sectors == 0xf);
    CHECK(fetch.plan->texels == kWarpLanes);
    for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
      const auto x = std::bit_cast<std::uint32_t>(fetch.request.u[lane]),
                 y = std::bit_cast<std::uint32_t>(fetch.request.v[lane]);
      CHECK(std::bit_cast<std::uint32_t>(rgba[0][lane]) ==
            10000 * static_cast<std::uint32_t>(sample) + 100 * y + x);
    }
  }
  for (std::size_t lane = 0; lane < kWarpLanes; ++lane) fetch.set(2, lane, lane % 2 == 0 ? 1 : 3);
  (void)fetch.of(surface);
  CHECK(fetch.plan->line_count == 2);
}

TEST_CASE("multisampled: what lies outside is 0, and is not read") {
  const Surface surface(2);
  Fetch fetch;
  const std::int32_t beyond[] = {-1, kSamples, 1 << 30};
  for (std::size_t lane = 0; lane < kWarpLanes; ++lane) fetch.set(2, lane, beyond[lane % 3]);
  fetch.set(2, 5, 3);
  const auto rgba = fetch.of(surface);
  CHECK(fetch.plan->line_count == 1);
  CHECK(fetch.plan->texels == 1);
  for (std::size_t lane = 0; lane < kWarpLanes; ++lane)
    CHECK((std::bit_cast<std::uint32_t>(rgba[0][lane]) == 0) == (lane != 5));
}
