/// Cases of quantity: targets of one pixel and of 67 million, frames without anything, a million triangles
/// smaller than a pixel.
#include "studies/stability/measures.h"
#include "studies/stability/stability.h"
#include "studies/stability/stream_builder.h"

#include <algorithm>

#include <fmt/format.h>

#include "models/memory/device_memory.h"
#include "scenes/record/recorder.h"

namespace quadrille::studies::stability {

namespace {

std::uint64_t bytes_of(const Observed& o, std::string_view client,
                       std::uint64_t pipeline::ClientFigures::*member) {
  const auto& all = o.exact.figures.bandwidth;
  const auto found = std::ranges::find(all, client, &pipeline::ClientFigures::name);
  return found == all.end() ? 0 : (*found).*member;
}

std::uint64_t pixels_other_than(const Observed& o, std::uint32_t color) {
  return static_cast<std::uint64_t>(
      std::ranges::count_if(o.image().color, [=](std::uint32_t c) { return c != color; }));
}

// one pixel
// --------------------------------------------------------------------------------------------------

traces::CommandStream one_pixel() {
  StreamBuilder stream("target-1x1", 1, 1, true);
  stream.clear({0, 0, 1, 1}).state({.depth = {true, true, traces::CompareOp::kLess}});
  // A triangle around the pixel, one behind it, and one that misses the sample by a 256th of a pixel.
  const auto at = [](double x, double y, float z, const glm::vec4& color) {
    return Corner{at_pixel(x, y, 1, 1, z), color, {}};
  };
  const glm::vec4 green(0.2F, 1, 0.2F, 1), red(1, 0, 0, 1);
  return stream.draw(Corners{at(-9, -9, 0.25F, green), at(-9, 20, 0.25F, green), at(20, -9, 0.25F, green)})
      .draw(Corners{at(-9, -9, 0.75F, red), at(-9, 20, 0.75F, red), at(20, -9, 0.75F, red)})
      .draw(Corners{at(129.0 / 256, -9, 0.1F, red), at(129.0 / 256, 9, 0.1F, red), at(9, 0, 0.1F, red)})
      .finish();
}

void check_one_pixel(const Observed& o, Findings& f) {
  f.is("the pixel, as alpha, blue, green, red", fmt::format("{:08x}", o.pixel(0, 0)), "ff33ff33");
  f.is("its depth", fmt::format("{}", o.image().depth[0]), "0.25");
}

// 8192 x 8192
// --------------------------------------------------------------------------------------------------

constexpr std::uint32_t kHuge = 8192;

/// A band one pixel wide along the last row and column, a square in each corner, and a needle from corner to
/// corner.
traces::CommandStream huge_target() {
  StreamBuilder stream("target-8192x8192", kHuge, kHuge);
  stream.clear({0.1F, 0.1F, 0.15F, 1});
  const auto rectangle = [&](double left, double top, double right, double bottom, const glm::vec4& color) {
    const glm::vec4 low = at_pixel(left, top, kHuge, kHuge), high = at_pixel(right, bottom, kHuge, kHuge);
    stream.draw(quad({low.x, low.y}, {high.x, high.y}, 0.5F, color));
  };
  const auto at = [](double x, double y) {
    return Corner{at_pixel(x, y, kHuge, kHuge), {1, 0.8F, 0.2F, 1}, {}};
  };
  stream.draw(Corners{at(0, 0), at(kHuge, kHuge - 100), at(kHuge - 100, kHuge)});
  constexpr double kSquare = 600, kLast = kHuge;
  rectangle(0, 0, kSquare, kSquare, {1, 0, 0, 1});
  rectangle(kLast - kSquare, 0, kLast, kSquare, {0, 1, 0, 1});
  rectangle(0, kLast - kSquare, kSquare, kLast, {0, 0, 1, 1});
  rectangle(kLast - kSquare, kLast - kSquare, kLast, kLast, {1, 1, 1, 1});
  rectangle(0, kLast - 1, kLast, kLast, {0, 1, 1, 1});
  rectangle(kLast - 1, 0, kLast, kLast, {0, 1, 1, 1});
  return stream.finish();
}

void check_huge_target(const Observed& o, Findings& f) {
  constexpr std::uint32_t kCyan = 0xffffff00u;
  std::uint64_t wrong = 0;
  for (std::uint32_t i = 0; i < kHuge; ++i)
    wrong += (o.pixel(i, kHuge - 1) != kCyan ? 1 : 0) + (o.pixel(kHuge - 1, i) != kCyan ? 1 : 0);
  f.equal("pixels of the last row and column that are not drawn", wrong, 0);
  f.is("the first pixel, as alpha, blue, green, red", fmt::format("{:08x}", o.pixel(0, 0)), "ff0000ff");
  f.is("the first square's last pixel, and the one beside it",
       fmt::format("{:08x} {:08x}", o.pixel(599, 0), o.pixel(600, 0)), "ff0000ff ff261a1a");
  f.equal("bytes scanned out", bytes_of(o, "scan_out", &pipeline::ClientFigures::read_bytes),
          std::uint64_t{4} * kHuge * kHuge);
}

// nothing
// --------------------------------------------------------------------------------------------------

constexpr std::uint32_t kEmptySide = 256;

void check_empty(const Observed& o, Findings& f) {
  constexpr std::uint64_t kBytes = std::uint64_t{4} * kEmptySide * kEmptySide;
  f.equal("pixels that differ from the first", pixels_other_than(o, o.pixel(0, 0)), 0);
  f.equal(
      "fragments, triangles and draws",
      o.exact.figures.frame.fragments_covered + o.exact.figures.frame.triangles + o.exact.figures.frame.draws,
      0);
  f.equal("bytes of colour written", bytes_of(o, "color", &pipeline::ClientFigures::write_bytes), kBytes);
  f.equal("bytes scanned out", bytes_of(o, "scan_out", &pipeline::ClientFigures::read_bytes), kBytes);
  // Every line goes from its ROP to the L2 cache, a line a cycle and link, and then from there to scan-out.
  const double lines = static_cast<double>(kBytes) / models::kLineBytes;
  const double least =
      lines / (o.machine->gpu.partitions * o.machine->gpu.channels) + lines / o.machine->gpu.channels;
  f.at_least("cycles against clear, flush and scan-out at full rate",
             static_cast<double>(o.exact.figures.frame.cycles), least);
  f.at_most("cycles", static_cast<double>(o.exact.figures.frame.cycles), 4 * least + 1000);
}

traces::CommandStream empty_scene() {
  scenes::SceneData scene;
  scene.name = "empty-scene";
  scenes::SceneOptions options;
  options.width = options.height = kEmptySide;
  return scenes::Recorder(scene, options).record();
}

// a million triangles
// --------------------------------------------------------------------------------------------------

constexpr std::uint32_t kColumns = 1000, kRows = 500, kMillionSide = 200;

/// A mesh of 500,000 cells and wandering corners, a fifth by two fifths of a pixel each, from below the
/// scissor's first pixel to beyond its last.
traces::CommandStream million() {
  Chance chance(3);
  Corners corners;
  corners.reserve((kColumns + 1) * (kRows + 1));
  for (std::uint32_t y = 0; y <= kRows; ++y) {
    for (std::uint32_t x = 0; x <= kColumns; ++x) {
      const bool rim = x == 0 || y == 0 || x == kColumns || y == kRows;
      const double dx = rim ? 0 : chance.between(-0.3, 0.3), dy = rim ? 0 : chance.between(-0.3, 0.3);
      corners.push_back({at_pixel((x + dx) * kMillionSide / kColumns, (y + dy) * kMillionSide / kRows,
                                  kMillionSide, kMillionSide),
                         glm::vec4(1),
                         {}});
    }
  }
  std::vector<std::uint32_t> indices;
  indices.reserve(std::size_t{6} * kColumns * kRows);
  for (std::uint32_t y = 0; y < kRows; ++y) {
    for (std::uint32_t x = 0; x < kColumns; ++x) {
      const std::uint32_t a = y * (kColumns + 1) + x, b = a + 1, c = a + kColumns + 1, d = c + 1;
      indices.insert(indices.end(), {a, b, c, c, b, d});
    }
  }
  StreamBuilder stream("million-triangles", kMillionSide, kMillionSide);
  stream.area({0, 0, kMillionSide, kMillionSide}, {8, 8, kMillionSide - 16, kMillionSide - 16})
      .state({.paint = Paint::kCount});
  return stream.draw_indexed(corners, indices).finish();
}

void check_million(const Observed& o, Findings& f) {
  f.equal("triangles assembled", o.exact.figures.frame.triangles, 1'000'000);
  f.equal("pixels not covered exactly once", not_once(o), 0);
  f.equal("fragments written", o.exact.figures.frame.fragments_written, std::uint64_t{184} * 184);
}

}  // namespace

void add_target_cases(std::vector<Case>& cases) {
  cases.push_back({.name = "target-1x1",
                   .group = "numbers",
                   .purpose = "a target of one pixel, with depth",
                   .must = "the nearest triangle over the sample is seen",
                   .build = one_pixel,
                   .check = check_one_pixel});
  cases.push_back(
      {.name = "target-8192x8192",
       .group = "numbers",
       .purpose = "a target of 67 million pixels",
       .must =
           "its last row and column are drawn; every byte is scanned out once; time and memory within limits",
       .build = huge_target,
       .check = check_huge_target,
       .seconds = 1800,
       .memory_mib = 2600,
       .slow = true});
  cases.push_back(
      {.name = "empty-pass",
       .group = "numbers",
       .purpose = "a render pass without a draw",
       .must = "the clear colour; the cycles of clear, flush and scan-out",
       .build =
           [] {
             return StreamBuilder("empty-pass", kEmptySide, kEmptySide).clear({0.2F, 0.4F, 0.6F, 1}).finish();
           },
       .check = check_empty});
  cases.push_back({.name = "empty-scene",
                   .group = "numbers",
                   .purpose = "a scene without anything in it",
                   .must = "its background; the cycles of clear, flush and scan-out",
                   .build = empty_scene,
                   .check = check_empty});
  cases.push_back(
      {.name = "million-triangles",
       .group = "numbers",
       .purpose = "a million triangles, each a twenty-fifth of a pixel",
       .must = "each pixel is covered exactly once, and no triangle is lost",
       .build = million,
       .check = check_million,
       .picture = [](const Observed& o) { return count_picture(o.image(), drawn_area(o.stream)); },
       .slow = true});
}

}  // namespace quadrille::studies::stability
