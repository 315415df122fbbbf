/// Cycles of a frame by edge functions and by edge walking, by the shape of its triangles, against what the
/// counted work needs; and in which order either visits the pixels of a triangle.
#include <fmt/format.h>

#include <algorithm>

#include "models/raster/coarse.h"
#include "models/raster/edge_walk.h"
#include "models/raster/tile_order.h"
#include "studies/experiments/experiment.h"
#include "studies/experiments/measured_meshes.h"
#include "studies/experiments/triangle_work.h"
#include "studies/plot.h"

namespace quadrille::studies::experiments {
namespace {

constexpr double kLeastOver = 0.98, kMostOver = 1.05;  ///< cycles over the closed form
constexpr std::uint32_t kTests = 16;                   ///< tiles a cycle, so that they do not limit
constexpr const char* kWalking = "coarse_raster.traversal=edge_walking";

struct Shape {
  std::string name;
  TriangleMesh mesh;
};

/// Triangles a sixteenth of a pixel thick, along (dx, dy) in pixels.
TriangleMesh needles(std::uint32_t width, std::uint32_t height, std::int32_t dx, std::int32_t dy) {
  constexpr std::int32_t kCount = 2048, kThick = kGrid / 16, kStrideX = 40503, kStrideY = 13501;
  TriangleMesh mesh{width, height, {}, {}};
  const auto w = static_cast<std::int32_t>(width) * kGrid, h = static_cast<std::int32_t>(height) * kGrid;
  for (std::int32_t i = 0; i < kCount; ++i) {
    const std::int32_t x = dx * kGrid < w ? i * kStrideX % (w - dx * kGrid) : 0,
                       y = dy * kGrid < h ? i * kStrideY % (h - dy * kGrid) : 0;
    const auto first = static_cast<std::uint32_t>(mesh.corners.size());
    mesh.corners.push_back({x, y});
    mesh.corners.push_back({x + dx * kGrid, y + dy * kGrid});
    mesh.corners.push_back({x + (dy > dx ? kThick : 0), y + (dy > dx ? 0 : kThick)});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

std::vector<Shape> shapes_of(std::uint32_t width, std::uint32_t height) {
  const auto w = static_cast<std::int32_t>(width), h = static_cast<std::int32_t>(height);
  return {{"1 px, scattered", scattered(width, height, 1)},
          {"4 px, scattered", scattered(width, height, 4)},
          {"16 px, scattered", scattered(width, height, 16)},
          {"64 px, scattered", scattered(width, height, 64)},
          {"256 px, scattered", scattered(width, height, 256)},
          {"halves of 64x64", repeated(tiled_frame(width, height, 64, 64), 4)},
          {"halves of the frame", repeated(tiled_frame(width, height, width, height), 8)},
          {"lying, 1 px high", repeated(tiled_frame(width, height, width, 1), 2)},
          {"standing, 1 px wide", repeated(tiled_frame(width, height, 1, height), 2)},
          {"lying needles, 1/16 px", needles(width, height, w, h / 64)},
          {"standing needles, 1/16 px", needles(width, height, w / 64, h)},
          {"diagonal needles, 1/16 px", needles(width, height, w / 2, h / 2)}};
}

struct Bound {
  const char* unit;
  double cycles;
};
/// The unit whose counted work takes longest.
Bound limit_of(const TriangleWork& w, bool walks) {
  const auto d = [](std::uint64_t n) { return static_cast<double>(n); };
  const Bound bounds[] = {{"vertex fetch", 3 * d(w.triangles) / 4},
                          {"set-up", d(w.triangles + w.batches)},
                          {"coarse raster", walks ? w.walk_clk : d(w.coarse_clk)},
                          {"fine raster", walks ? d(w.walk_tiles) : d(w.fine_clk)}};
  return *std::ranges::max_element(bounds, {}, &Bound::cycles);
}

void report(const Shape& shape, const Readings& tested, const Readings& walked, Result& result) {
  const TriangleWork work = work_of(shape.mesh, {.tile_tests = kTests});
  const Bound by_tests = limit_of(work, false), by_walk = limit_of(work, true);
  const double a = tested["frame.render_cycles"], b = walked["frame.render_cycles"];
  result.table.rows.push_back(
      {shape.name, fmt::format("{}", work.triangles),
       fmt::format("{:.1f}", static_cast<double>(work.fragments) / static_cast<double>(work.triangles)),
       fmt::format("{:.0f}", by_tests.cycles), by_tests.unit, fmt::format("{:.0f}", a),
       fmt::format("{:.0f}", by_walk.cycles), by_walk.unit, fmt::format("{:.0f}", b),
       fmt::format("{:.2f}", by_walk.cycles / by_tests.cycles), fmt::format("{:.2f}", b / a)});
  result.verdicts.push_back(
      {shape.name + ": edge functions, cycles over predicted", a / by_tests.cycles, kLeastOver, kMostOver});
  result.verdicts.push_back(
      {shape.name + ": edge walking, cycles over predicted", b / by_walk.cycles, kLeastOver, kMostOver});
}

/// Scenes as they are and with four samples a pixel, on the default machine.
Table scenes_table(const Setting& setting) {
  std::vector<traces::CommandStream> streams;
  for (const auto& [name, load] : setting.scenes) {
    for (const std::uint32_t samples : {1u, 4u}) {
      streams.push_back(load());
      if (samples > 1) traces::use_samples(streams.back(), samples);
    }
  }
  std::vector<Frame> frames;
  for (const traces::CommandStream& stream : streams) {
    frames.push_back({&stream, {}});
    frames.push_back({&stream, {kWalking}});
  }
  const std::vector<Readings> read = draw(frames, setting);
  Table table{{"scene", "samples", "edge functions, cycles", "edge walking, cycles", "walking over functions",
               "coarse raster busy, functions", "walking", "rows a triangle", "tiles a span"},
              {}};
  for (std::size_t i = 0; i < streams.size(); ++i) {
    const Readings &tested = read[2 * i], &walked = read[2 * i + 1];
    const double a = tested["frame.render_cycles"], b = walked["frame.render_cycles"];
    table.rows.push_back(
        {setting.scenes[i / 2].first, i % 2 == 0 ? "1" : "4", fmt::format("{:.0f}", a),
         fmt::format("{:.0f}", b), fmt::format("{:.3f}", b / a),
         fmt::format("{:.0f}", tested["coarse_raster.busy"]),
         fmt::format("{:.0f}", walked["coarse_raster.busy"]),
         fmt::format("{:.2f}", walked["coarse_raster.rows"] / walked["coarse_raster.triangles"]),
         fmt::format("{:.2f}",
                     walked["coarse_raster.segments"] / std::max(1.0, walked["coarse_raster.spans"]))});
  }
  return table;
}

/// In which order the pixels of a triangle are visited.
class Visits {
 public:
  static constexpr int kWidth = 64, kHeight = 48;

  [[nodiscard]] static models::TriangleSetup triangle() {
    models::SetupState state;
    state.scissor = {0, 0, kWidth, kHeight};
    models::TriangleSetup setup;
    const auto at = [](std::pair<int, int> corner) {
      return models::WindowVertex{corner.first * kGrid, corner.second * kGrid, 0.5F, 1};
    };
    (void)models::setup_triangle({at(kCorners[0]), at(kCorners[1]), at(kCorners[2])},
                                 models::whole_triangle_weights(), state, setup);
    return setup;
  }
  /// Tiles that are not outside an edge, all of their pixels at a time.
  void by_edges(const models::TileOrderPolicy& policy) {
    std::vector<std::pair<std::uint64_t, models::TileHit>> tiles;
    const auto order = policy.make();
    models::TileWalk walk(triangle());
    for (models::TileHit hit; walk.next(hit);)
      tiles.emplace_back(
          order->place(static_cast<std::uint32_t>(hit.tile_x), static_cast<std::uint32_t>(hit.tile_y)), hit);
    std::ranges::sort(tiles, {}, [](const auto& entry) { return entry.first; });
    for (const auto& [place, hit] : tiles) {
      for (int i = 0; i < models::kTilePixels; ++i)
        set(8 * hit.tile_x + models::entry_x(i), 8 * hit.tile_y + models::entry_y(i));
      ++turn_;
    }
  }
  void by_walk() {
    models::EdgeWalk walk(triangle());
    for (models::SampleRow row; walk.next(row);)
      for (std::int32_t x = row.x0; x < row.x1; ++x, ++turn_) set(x, row.y);
  }
  /// As data and the commands that draw it.
  [[nodiscard]] std::string panel(int number, const std::string& title) const {
    std::string text = fmt::format("$order{} << EOD\n", number);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const int turn = turns_[static_cast<std::size_t>(y * kWidth + x)];
        text += fmt::format("{}.5 {}.5 {}\n", x, y, turn < 0 ? "NaN" : fmt::format("{}", turn));
      }
    text += "EOD\n";
    return text + fmt::format(
                      "set origin {},0.52\nset title {}\nplot $order{} using 1:2:3 with image notitle, "
                      "$triangle with lines lc black lw 1.5 notitle\n",
                      number / 3.0, quoted(title), number);
  }
  [[nodiscard]] static std::string outline() {
    std::string text = "$triangle << EOD\n";
    for (std::size_t i = 0; i <= 3; ++i)
      text += fmt::format("{} {}\n", kCorners[i % 3].first, kCorners[i % 3].second);
    return text + "EOD\n";
  }

 private:
  static constexpr std::pair<int, int> kCorners[] = {{3, 2}, {61, 17}, {20, 46}};
  void set(int x, int y) { turns_[static_cast<std::size_t>(y * kWidth + x)] = turn_; }
  std::vector<int> turns_ = std::vector<int>(std::size_t{kWidth * kHeight}, -1);
  int turn_ = 0;
};

std::string orders_plot() {
  Visits scan, hilbert, walk;
  scan.by_edges(models::kScanTileOrder);
  hilbert.by_edges(models::kHilbertTileOrder);
  walk.by_walk();
  return Visits::outline() +
         fmt::format(
             "set size 0.333,0.48\nset xrange [0:{}]\nset yrange [{}:0]\nset xtics 8\nset ytics 8\nset grid "
             "front "
             "lt 1 lc rgb '#bbbbbb'\nset palette defined (0 '#30123b', 1 '#4686fb', 2 '#1ae4b6', 3 "
             "'#a4fc3c', 4 "
             "'#fbb938', 5 '#e3440a', 6 '#7a0403')\nunset colorbox\n",
             Visits::kWidth, Visits::kHeight) +
         scan.panel(0, "edge functions: tiles, by rows") +
         hilbert.panel(1, "edge functions: tiles, along Hilbert's curve") +
         walk.panel(2, "edge walking: spans of pixels");
}

std::string plot_of(const Table& table) {
  std::string data = "$cycles << EOD\n";
  for (const auto& row : table.rows) data += fmt::format("{} {}\n", quoted(row[0]), row.back());
  return "set multiplot\n" + orders_plot() + data +
         fmt::format(
             "EOD\nset origin 0,0\nset size 1,0.53\n"
             "set title 'cycles of edge walking over those of edge functions: below 1 it wins'\n"
             "set autoscale\nset xrange [-0.6:{}.6]\nset yrange [0.02:20]\nset logscale y\n"
             "set ytics (0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10)\n"
             "set xtics autofreq rotate by -20 font ',9'\nset grid\nset style fill solid 0.6\n",
             table.rows.size() - 1) +
         "plot $cycles using 0:2:($0-0.3):($0+0.3):($2<1?$2:1):($2>1?$2:1):xtic(1) with boxxyerror notitle, "
         "1 "
         "with lines lc black notitle\nunset multiplot";
}

}  // namespace

Result traversal(const Setting& setting) {
  const std::vector<Shape> shapes = shapes_of(setting.width, setting.height);
  std::vector<traces::CommandStream> streams;
  streams.reserve(shapes.size());
  for (const Shape& shape : shapes) streams.push_back(stream_of(shape.mesh));
  const std::vector<std::string> wide{"gpu.cores=16", "gpu.channels=8",
                                      fmt::format("coarse_raster.tests_per_clk={}", kTests)};
  std::vector<std::string> walking = wide;
  walking.emplace_back(kWalking);
  std::vector<Frame> frames;
  for (const traces::CommandStream& stream : streams) {
    frames.push_back({&stream, wide});
    frames.push_back({&stream, walking});
  }
  const std::vector<Readings> read = draw(frames, setting);
  Result result;
  result.table.head = {
      "triangles",          "number", "pixels each", "functions: predicted", "limit", "cycles",
      "walking: predicted", "limit",  "cycles",      "predicted ratio",      "ratio"};
  for (std::size_t i = 0; i < shapes.size(); ++i) report(shapes[i], read[2 * i], read[2 * i + 1], result);
  result.further_tables = {scenes_table(setting)};
  result.remarks = {
      "By arithmetic: edge functions take a cycle a tile of 8x8 pixels and a cycle for four of its quads. A "
      "triangle of w by h pixels touches about w h / 128 + (w + h) / 8 tiles. Edge walking takes two cycles "
      "a part "
      "of the triangle, and for each of its h rows a cycle or half a cycle a tile that the row crosses, "
      "whichever "
      "is longer; meanwhile the tiles before leave, one a cycle. So it loses where rows are many and short. "
      "Of a "
      "triangle of a pixel or a few, set-up and rows take four cycles and more where a tile takes one or "
      "two. A "
      "standing sliver of 256 rows takes 256 cycles, and edge functions its 32 tiles.",
      "On large triangles both fill 16 pixels a cycle, and neither wins.",
      "Edge walking wins on lying slivers. Edge functions hand on each tile that no edge excludes by itself, "
      "and "
      "the fine rasteriser finds most of a lying needle's tiles empty. A walk takes the few rows whose "
      "centres "
      "lie between the highest and the lowest corner, and of these the tiles that are covered.",
      "Predictions: the longest of fetch (4 indices a cycle), set-up (1 triangle or batch) and rasterisers.",
      "At one sample a pixel the scenes are limited by the cores, and the traversal does not show, though "
      "the "
      "coarse rasteriser is busy three to four times as long. With four samples every sample has rows and "
      "parts "
      "of its own, so a walk takes several times as long (the lectures name the positions of samples among "
      "its "
      "problems), and the frames take a fifth longer.",
      "The picture shows in which order the pixels of a triangle are visited, from dark blue to dark "
      "red: "
      "by edge functions all pixels of a tile at a time, also those beyond the edges; by edge walking the "
      "covered "
      "ones alone."};
  result.plot = plot_of(result.table);
  return result;
}

}  // namespace quadrille::studies::experiments
