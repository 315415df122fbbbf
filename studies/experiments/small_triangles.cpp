/// Cycles of a frame by the size of its triangles, against what the counted work needs, on the default
/// machine and on machines after three cards.
#include <fmt/format.h>

#include <algorithm>

#include "studies/experiments/experiment.h"
#include "studies/experiments/triangle_work.h"
#include "studies/plot.h"

namespace quadrille::studies::experiments {
namespace {

struct Tile {
  std::uint32_t width, height;
};
constexpr Tile kTiles[] = {{1, 1},   {2, 2},   {4, 4},     {8, 8},   {16, 16},
                           {32, 32}, {64, 64}, {128, 128}, {256, 1}, {1, 256}};
constexpr std::size_t kSquares = 8, kSmallest = 0, kLargest = kSquares - 1;

/// The published slow-downs of 1x1 lie within; and what cycles may exceed the closed form by.
constexpr double kLeastLoss = 8, kMostLoss = 25, kMostOver = 1.05;

/// A machine by its rates. Of a card with several raster engines it is one of them, with its share of
/// everything else: work and rates are divided alike, so a card's ratio of two times is the engine's.
struct Machine {
  const char* name;
  Rates rates;
  std::uint32_t partitions, partition_quads;  ///< and quads a cycle that each writes
  std::uint32_t cores, simd_lanes;            ///< of four SIMDs each
  std::uint32_t channels;                     ///< of 32 bytes a memory cycle
  double memory_mhz;                          ///< while the GPU has 1000 MHz
  double published = 0;                       ///< 1x1 over 128x128; 0: none
  bool held_to_band = false;
  bool held_to_form = false;
  [[nodiscard]] std::vector<std::string> settings() const;
  [[nodiscard]] double memory_bytes_per_clk() const { return 32 * channels * memory_mhz / 1000; }
};

std::vector<std::string> Machine::settings() const {
  return {fmt::format("fine_raster.quads_per_clk={}", rates.fine_quads),
          fmt::format("coarse_raster.tests_per_clk={}", rates.tile_tests),
          fmt::format("warp_packer.quads_per_clk={}", rates.pack_quads),
          fmt::format("warp_packer.launch_clk={}", rates.launch_clk),
          fmt::format("gpu.partitions={}", partitions),
          fmt::format("rop.quads_per_clk={}", partition_quads),
          fmt::format("gpu.cores={}", cores),
          "core.simds=4",
          fmt::format("core.simd_lanes={}", simd_lanes),
          fmt::format("gpu.channels={}", channels),
          fmt::format("gpu.memory_mhz={}", memory_mhz)};
}

/// Rates and what of them is published: docs/sources.md. A warp's launch takes no time of the packers of the
/// cards, so that they keep up with the rasteriser.
const std::vector<Machine>& machines() {
  static const std::vector<Machine> all{
      {"default, 8 channels", {}, 2, 4, 4, 8, 8, 1000, 0, false, true},
      {"HD Graphics 4600", {.fine_quads = 1, .pack_quads = 1, .launch_clk = 0}, 1, 1, 5, 8, 1, 640, 10, true},
      {"GeForce GTX 680 / 4",
       {.fine_quads = 2, .pack_quads = 2, .launch_clk = 0},
       1,
       2,
       3,
       32,
       2,
       747,
       15,
       true},
      {"Radeon HD 7970 / 2, published", {.fine_quads = 4, .launch_clk = 0}, 2, 4, 8, 32, 4, 1115, 20},
      {"Radeon HD 7970 / 2, fitted", {.fine_quads = 3, .launch_clk = 0}, 2, 4, 8, 32, 4, 1115, 20, true},
  };
  return all;
}

struct Bound {
  const char* unit;
  double cycles;
};

/// The unit whose counted work needs the longest at its rate. `shown`: bytes that scan-out read, after the
/// cycles that are counted.
Bound limit_of(const Machine& m, const TriangleWork& w, const Readings& r, double shown) {
  const auto d = [](std::uint64_t n) { return static_cast<double>(n); };
  const Bound bounds[] = {{"vertex fetch", std::max(3 * d(w.triangles) / 4, d(w.vertices) / 8)},
                          {"set-up", d(w.triangles + w.batches)},
                          {"coarse raster", d(w.coarse_clk)},
                          {"fine raster", d(w.fine_clk)},
                          {"warp packer", d(w.pack_clk) / m.partitions},
                          {"ROP", d(w.quads) / (m.partitions * m.partition_quads)},
                          {"cores", r["core.simd_busy"] / (4 * m.cores)},
                          {"memory", (r["frame.memory_bytes"] - shown) / m.memory_bytes_per_clk()}};
  return *std::ranges::max_element(bounds, {}, &Bound::cycles);
}

struct Drawing {
  Tile tile;
  TriangleMesh mesh;
  traces::CommandStream stream;
};

std::vector<Drawing> drawings_of(std::uint32_t width, std::uint32_t height) {
  std::vector<Drawing> drawings;
  for (const Tile& t : kTiles) {
    TriangleMesh mesh = tiled_frame(width, height, t.width, t.height);
    traces::CommandStream stream = stream_of(mesh);
    drawings.push_back({t, std::move(mesh), std::move(stream)});
  }
  return drawings;
}

/// Rows and verdicts of a machine; returns its slow-downs by size of the square tiles, for the plot.
std::string report(const Machine& m, const std::vector<Drawing>& drawings, std::span<const Readings> read,
                   Result& result) {
  const double best = read[kLargest]["frame.render_cycles"];
  std::string slow_downs;
  for (std::size_t i = 0; i < drawings.size(); ++i) {
    const Drawing& d = drawings[i];
    const std::string tile = fmt::format("{}x{}", d.tile.width, d.tile.height);
    const double cycles = read[i]["frame.render_cycles"], loss = cycles / best;
    const TriangleWork work = work_of(d.mesh, m.rates);
    const Bound limit = limit_of(m, work, read[i], 4.0 * d.mesh.width * d.mesh.height);
    const bool published = i == kSmallest && m.published > 0;
    result.table.rows.push_back(
        {i == 0 ? m.name : "", tile, fmt::format("{}", work.triangles), fmt::format("{:.0f}", cycles),
         fmt::format("{:.0f}", limit.cycles), limit.unit, fmt::format("{:.3f}", cycles / limit.cycles),
         fmt::format("{:.2f}", loss), published ? fmt::format("{}", m.published) : ""});
    if (m.held_to_form)
      result.verdicts.push_back({fmt::format("{}, {}: cycles over closed form", m.name, tile),
                                 cycles / limit.cycles, 1, kMostOver});
    if (published && m.held_to_band)
      result.verdicts.push_back({fmt::format("{}: 1x1 over 128x128, published {}", m.name, m.published), loss,
                                 kLeastLoss, kMostLoss});
    if (i < kSquares) slow_downs += fmt::format("{} {}\n", d.tile.width, loss);
  }
  return slow_downs;
}

std::string plot_of(const std::vector<std::string>& slow_downs) {
  std::string text =
      "set logscale xy\nset xlabel 'edge of a tile of two triangles, pixels'\nset ylabel 'time over that of "
      "128x128'\nset xtics "
      "(1,2,4,8,16,32,64,128)\nset xrange [0.9:150]\nset yrange [0.9:40]\nset grid\n$published << EOD\n1 "
      "10\n1 15\n1 20\nEOD\n";
  std::string curves;
  for (std::size_t i = 0; i < slow_downs.size(); ++i) {
    text += fmt::format("$m{} << EOD\n{}EOD\n", i, slow_downs[i]);
    curves += fmt::format("$m{} with linespoints lw 2 title {}, ", i, quoted(machines()[i].name));
  }
  return text + "plot " + curves + "$published with points pt 6 ps 2 lc black title 'published, three cards'";
}

}  // namespace

Result small_triangles(const Setting& setting) {
  const std::vector<Drawing> drawings = drawings_of(setting.width, setting.height);
  std::vector<Frame> frames;
  for (const Machine& m : machines()) {
    for (const Drawing& d : drawings) frames.push_back({&d.stream, m.settings()});
  }
  const std::vector<Readings> read = draw(frames, setting);
  Result result;
  result.table.head = {"machine", "tile",    "triangles", "cycles",   "closed form",
                       "limit",   "over it", "slow-down", "published"};
  std::vector<std::string> slow_downs;
  for (std::size_t i = 0; i < machines().size(); ++i)
    slow_downs.push_back(report(machines()[i], drawings,
                                std::span(read).subspan(i * drawings.size(), drawings.size()), result));
  result.remarks = {
      "The closed form is the longest of: triangles and ends of batches at one a cycle of set-up; tiles at "
      "one a cycle of the coarse "
      "rasteriser; of the fine one, the covered quads of each tile at its rate, rounded up, at least a "
      "cycle; quads and warps of the "
      "packer; quads of the ROPs; instructions of the cores; bytes of the memory. The work is counted by a "
      "rasteriser of its own, but for "
      "instructions and bytes, which are the machine's counters.",
      "Published is also that 16x16 costs nothing any more. Here a tile of 8x8 pixels takes the fine "
      "rasteriser its quads, rounded up: of "
      "a tile of 16x16 pixels the two tiles of 8x8 that the diagonal cuts take 2 x 3 cycles, not 2 x 2.5, "
      "and their four quads on the "
      "diagonal count twice. So 16x16 costs 1.1 to 1.2 times 128x128, and 8x8 1.2 to 1.5 times.",
      "256x1 and 1x256, which differ on the cards, do not differ here: tiles are square. Both pay for tiles "
      "of 8x8 that all but miss the "
      "triangle: one of which only pixels beyond the triangle's bounds are inside all edges is handed on, "
      "and found empty by the fine "
      "rasteriser.",
      "A card with several raster engines is simulated as one of them, with its share of cores, ROPs and "
      "memory, since the machine has "
      "one. Of the GeForce GTX 680: four engines, 32 ROPs, 1536 lanes, 192 GB/s at 1006 MHz. Of the Radeon "
      "HD 7970: two engines, 32 ROPs, "
      "2048 lanes, 264 GB/s at 925 MHz. Of the HD Graphics 4600: 20 units of 8 lanes, 25.6 GB/s at 1250 MHz. "
      "An engine's triangle a cycle "
      "is the rate published of their generation.",
      "Three numbers are fitted, since no source was found or the published one does not give the "
      "measurement: one triangle and four "
      "pixels a cycle of the HD Graphics 4600, and three quads a cycle an engine of the HD 7970 instead of "
      "four. With the published 32 "
      "pixels and two triangles a cycle it is 32 times slower at 1x1, by arithmetic (two triangles a pixel, "
      "32 pixels in the time of two "
      "triangles), not 20: either it fills 20 pixels a cycle or it sets up 3.2 triangles. Lanes of a warp "
      "are 32 on all."};
  result.plot = plot_of(slow_downs);
  return result;
}

}  // namespace quadrille::studies::experiments
