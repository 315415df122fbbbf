/// A stack of layers over the whole frame, from front to back and from back to front, with and without Hi-Z.
#include <fmt/format.h>

#include <algorithm>

#include "studies/experiments/experiment.h"
#include "studies/experiments/measured_meshes.h"
#include "studies/experiments/triangle_work.h"
#include "studies/plot.h"

namespace quadrille::studies::experiments {
namespace {

constexpr int kLayers = 10;
constexpr double kLeast = 0.98, kMost = 1.02;
constexpr double kPublishedPixels = 256;  ///< discarded a clock by the Radeon X800

struct Case {
  bool front_first, hiz;
  std::uint32_t tests;  ///< of tiles, a cycle
  [[nodiscard]] bool hides() const { return front_first && hiz; }
  [[nodiscard]] std::string name() const {
    return fmt::format("{}, Hi-Z {}, {} tests/clk", front_first ? "front to back" : "back to front",
                       hiz ? "on" : "off", tests);
  }
};
constexpr Case kCases[] = {{true, true, 1},  {true, true, 4},  {true, true, 16},
                           {true, false, 4}, {false, true, 4}, {false, false, 4}};

struct Form {
  double drawn = 0;   ///< cycles of a layer that is rasterised
  double hidden = 0;  ///< of one that is tested and dropped
  [[nodiscard]] double cycles(bool hides) const {
    return hides ? drawn + (kLayers - 1) * hidden : kLayers * drawn;
  }
};
Form form_of(std::uint32_t width, std::uint32_t height, const Case& c) {
  const TriangleWork layer = work_of(layers(width, height, 1, true), {.tile_tests = c.tests});
  return {static_cast<double>(std::max(layer.coarse_clk, layer.fine_clk)),
          static_cast<double>(layer.tile_tests) / c.tests};
}

}  // namespace

Result hidden_surfaces(const Setting& setting) {
  const std::uint32_t width = setting.width, height = setting.height;
  const traces::CommandStream front = stream_of(layers(width, height, kLayers, true), {.depth = true});
  const traces::CommandStream back = stream_of(layers(width, height, kLayers, false), {.depth = true});
  std::vector<Frame> frames;
  for (const Case& c : kCases) {
    frames.push_back({c.front_first ? &front : &back,
                      {fmt::format("coarse_raster.hiz={}", c.hiz),
                       fmt::format("coarse_raster.tests_per_clk={}", c.tests), "gpu.channels=8"}});
  }
  const std::vector<Readings> read = draw(frames, setting);
  Result result;
  result.table.head = {"order",          "Hi-Z",
                       "tests/clk",      "cycles",
                       "closed form",    "over it",
                       "tiles hidden",   "fragments killed early",
                       "shaded a pixel", "pixels dropped a clock"};
  const double pixels = double{1} * width * height;
  std::string data;
  for (std::size_t i = 0; i < std::size(kCases); ++i) {
    const Case& c = kCases[i];
    const Readings& r = read[i];
    const Form form = form_of(width, height, c);
    const double cycles = r["frame.render_cycles"], expected = form.cycles(c.hides()),
                 shaded = r["frame.fragments_shaded"] / pixels;
    const double dropped = c.hides() ? (kLayers - 1) * pixels / (cycles - form.drawn) : 0;
    result.table.rows.push_back(
        {c.front_first ? "front to back" : "back to front", c.hiz ? "on" : "off", fmt::format("{}", c.tests),
         fmt::format("{:.0f}", cycles), fmt::format("{:.0f}", expected),
         fmt::format("{:.4f}", cycles / expected), fmt::format("{:.0f}", r["coarse_raster.tiles_hidden"]),
         fmt::format("{:.0f}", r["depth.early_killed"]), fmt::format("{:.2f}", shaded),
         c.hides() ? fmt::format("{:.0f}", dropped) : ""});
    result.verdicts.push_back({c.name() + ": cycles over closed form", cycles / expected, kLeast, kMost});
    result.verdicts.push_back({c.name() + ": fragments shaded a pixel", shaded, c.front_first ? 1.0 : kLayers,
                               c.front_first ? 1.0 : kLayers});
    data += quoted(c.name()) + fmt::format(" {} {}\n", cycles, expected);
  }
  result.remarks = {fmt::format("The closed form: each layer that is drawn takes the fine rasteriser's "
                                "cycles, four quads a cycle, tile by "
                                "tile; each that is hidden takes its tile tests at their rate. Four tests of "
                                "8x8 pixels a cycle are the "
                                "published {} pixels; a few less arrive, since tiles on the diagonal are "
                                "tested for both triangles of a "
                                "layer, a row ends with a test that fails, and the frame begins and ends.",
                                kPublishedPixels),
                    "Early depth without Hi-Z saves shading, not rasterising: front to back all ten layers "
                    "pass the rasteriser, and one is "
                    "shaded. From back to front nothing is hidden, and Hi-Z costs nothing."};
  result.plot =
      "set style data histograms\nset style fill solid 0.8\nset ylabel 'cycles'\nset yrange [0:*]\nset xtics "
      "rotate by -25 font ',9'\nset "
      "grid y\nset key outside top center horizontal\n$d << EOD\n" +
      data + "EOD\nplot $d using 2:xtic(1) title 'simulated', '' using 3 title 'closed form'";
  return result;
}

}  // namespace quadrille::studies::experiments
