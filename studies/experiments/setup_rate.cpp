/// Triangles a clock: culled, off screen, without a pixel, and of one pixel, against the rates of the
/// geometry units.
#include <fmt/format.h>

#include <algorithm>

#include "studies/experiments/experiment.h"
#include "studies/experiments/measured_meshes.h"
#include "studies/experiments/triangle_work.h"
#include "studies/plot.h"

namespace quadrille::studies::experiments {
namespace {

/// of a mesh in its frame, which is small so that clearing it takes no time
constexpr std::uint32_t kRepeats = 8;
constexpr double kLeast = 0.98, kMost = 1.02;

struct Kind {
  const char* name;
  const char* counter;  ///< that counts all of them
  TriangleMesh mesh;
  DrawOptions options;
  enum class End : std::uint8_t { kClipper, kCulled, kDrawn } end;
};

std::vector<Kind> kinds_of(std::uint32_t width, std::uint32_t height) {
  // A tile of 2x1 pixels is two triangles of one pixel each: the centres lie to either side of the diagonal.
  // Eight in a row reach over two tiles of the rasteriser, and so to two partitions.
  const TriangleMesh pixels = repeated(tiled_frame(width, height, 2, 1, 8), kRepeats);
  return {{"culled", "triangle_setup.culled", pixels, {.cull = traces::CullMode::kBack}, Kind::End::kCulled},
          {"off screen", "clipper.rejected", moved_right(pixels, 2 * width), {}, Kind::End::kClipper},
          {"one pixel", "triangle_setup.kept", pixels, {}, Kind::End::kDrawn}};
}

struct Rate {
  const char* name;
  double drawn, culled, clipped;  ///< triangles a cycle; the last of assembly and clipper
  std::vector<std::string> settings;
  /// Cycles of the slower of set-up and clipper. The end of a batch takes a culled triangle's place in
  /// set-up, but no more than a cycle, and any one's in the clipper.
  [[nodiscard]] double cycles(Kind::End end, double triangles, double ends) const {
    const double clipper = (triangles + ends) / clipped, ended = ends / std::max(1.0, culled);
    switch (end) {
      case Kind::End::kClipper: return clipper;
      case Kind::End::kCulled: return std::max(clipper, triangles / culled + ended);
      case Kind::End::kDrawn: return std::max(clipper, triangles / drawn + ended);
    }
    return clipper;
  }
};
const std::vector<Rate>& rates() {
  static const std::vector<Rate> all{
      {"1", 1, 1, 1, {}},
      {"1 culled, 1/2 drawn", 0.5, 1, 1, {"triangle_setup.drawn_per_clk=0.5"}},
      {"1/2", 0.5, 0.5, 1, {"triangle_setup.drawn_per_clk=0.5", "triangle_setup.culled_per_clk=0.5"}},
      {"2",
       2,
       2,
       2,
       {"triangle_setup.drawn_per_clk=2", "triangle_setup.culled_per_clk=2", "clipper.triangles_per_clk=2",
        "primitive_assembly.triangles_per_clk=2", "coarse_raster.tiles_per_clk=2",
        "fine_raster.tiles_per_clk=2", "link.assembly_to_clipper.width=2", "link.clipper_to_setup.width=2",
        "link.setup_to_coarse.width=2", "link.coarse_to_fine.width=2", "link.fine_to_depth.width=2",
        "link.clipper_to_setup.depth=16", "triangle_setup.triangle_slots=8192",
        "vertex_fetch.indices_per_clk=8", "warp_packer.launch_clk=0"}}};
  return all;
}

}  // namespace

Result setup_rate(const Setting& setting) {
  const std::vector<Kind> kinds = kinds_of(setting.width, setting.height);
  std::vector<traces::CommandStream> streams;
  streams.reserve(std::size(kinds));
  for (const Kind& k : kinds) streams.push_back(stream_of(k.mesh, k.options));
  std::vector<Frame> frames;
  for (const Rate& rate : rates()) {
    for (const traces::CommandStream& stream : streams) frames.push_back({&stream, rate.settings});
  }
  const std::vector<Readings> read = draw(frames, setting);
  Result result;
  result.table.head = {"triangles", "set-up a clock", "number",  "counted as such",
                       "cycles",    "closed form",    "over it", "triangles a clock"};
  std::string data;
  auto next = read.begin();
  for (const Rate& rate : rates()) {
    for (const Kind& k : kinds) {
      const Readings& r = *next++;
      const TriangleWork w = work_of(k.mesh, {});
      const auto n = static_cast<double>(w.triangles);
      const double cycles = r["frame.render_cycles"];
      const double form = rate.cycles(k.end, n, static_cast<double>(w.batches));
      result.table.rows.push_back({k.name, rate.name, fmt::format("{}", w.triangles),
                                   fmt::format("{:.0f}", r[k.counter]), fmt::format("{:.0f}", cycles),
                                   fmt::format("{:.0f}", form), fmt::format("{:.4f}", cycles / form),
                                   fmt::format("{:.3f}", n / cycles)});
      result.verdicts.push_back(
          {fmt::format("{}, set-up of {} a clock: cycles over closed form", k.name, rate.name), cycles / form,
           kLeast, kMost});
      result.verdicts.push_back(
          {fmt::format("{}, set-up of {} a clock: part that is counted as such", k.name, rate.name),
           r[k.counter] / n, 1, 1});
      data +=
          quoted(fmt::format("{}, {}", k.name, rate.name)) + fmt::format(" {} {}\n", n / cycles, n / form);
    }
  }
  result.remarks = {
      "The closed form is the longer of set-up, at its rates of culled and of drawn triangles, and the "
      "clipper, in which those off screen "
      "end. The end of a batch of vertices takes a triangle's place in assembly, clipper and set-up. That is "
      "why one triangle a clock is "
      "0.97: a batch has room for 32 triangles.",
      "Drawn triangles are as fast as culled ones on the default machine, as published of the Radeon HD "
      "5000; half as fast, as of the "
      "GT200, is the second rate. Two a clock need two tokens a cycle of every link from assembly to the "
      "depth units, one of them deeper "
      "for its latency, two tiles a cycle of both rasterisers, eight indices a cycle and more slots for "
      "triangles in flight. The machine "
      "has one raster engine: several, with which the GF100 reaches 3.5 triangles a clock, are not "
      "simulated."};
  result.plot =
      "set style data histograms\nset style fill solid 0.8\nset ylabel 'triangles a clock'\nset yrange "
      "[0:*]\nset xtics rotate by -20\nset "
      "grid y\nset key outside top center horizontal\n$d << EOD\n" +
      data + "EOD\nplot $d using 2:xtic(1) title 'simulated', '' using 3 title 'closed form'";
  return result;
}

}  // namespace quadrille::studies::experiments
