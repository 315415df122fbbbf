/// Lanes shaded a covered fragment, by the area of the triangles: quads at their edges are shaded whole.
#include <fmt/format.h>

#include "studies/experiments/experiment.h"
#include "studies/experiments/measured_meshes.h"
#include "studies/experiments/triangle_work.h"

namespace quadrille::studies::experiments {
namespace {

constexpr int kAreas = 11;  ///< 1, 2, 4 ... 1024 pixels
constexpr Sample kOneSample[] = {{}};
/// Vulkan's standard places of four samples. [VK1.3 #primsrast-multisampling]
constexpr Sample kFourSamples[] = {{96, 32}, {224, 96}, {32, 160}, {160, 224}};
constexpr double kPublishedLive = 1.4, kPublishedBand = 0.15;

double ratio(std::uint64_t a, std::uint64_t b) { return static_cast<double>(a) / static_cast<double>(b); }

}  // namespace

Result quad_overhead(const Setting& setting) {
  const std::uint32_t width = setting.width, height = setting.height;
  std::vector<TriangleMesh> meshes;
  std::vector<traces::CommandStream> streams;
  for (int i = 0; i < kAreas; ++i) {
    meshes.push_back(scattered(width, height, 1 << i));
    streams.push_back(stream_of(meshes.back()));
  }
  std::vector<Frame> frames;
  frames.reserve(streams.size());
  for (const traces::CommandStream& stream : streams) frames.push_back({&stream, {}});
  const std::vector<Readings> read = draw(frames, setting);
  Result result;
  result.table.head = {"area",
                       "triangles",
                       "fragments",
                       "lanes",
                       "lanes a fragment",
                       "counted",
                       "live lanes of 4",
                       "counted, 4 samples: live lanes of 4",
                       "lanes a pixel of area"};
  std::string data;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const Readings& r = read[i];
    const double area = 1 << i;
    const Coverage one = coverage_of(meshes[i], kOneSample), four = coverage_of(meshes[i], kFourSamples);
    const double fragments = r["frame.fragments_covered"], lanes = r["frame.executed_lanes"];
    const double counted = 4 * ratio(one.quads, one.pixels), live = 4 * fragments / lanes;
    const double four_lanes =
        4 * static_cast<double>(four.quads) / (area * static_cast<double>(meshes[i].triangles.size()));
    result.table.rows.push_back({fmt::format("{}", area), fmt::format("{}", meshes[i].triangles.size()),
                                 fmt::format("{:.0f}", fragments), fmt::format("{:.0f}", lanes),
                                 fmt::format("{:.3f}", lanes / fragments), fmt::format("{:.3f}", counted),
                                 fmt::format("{:.3f}", live),
                                 fmt::format("{:.3f}", ratio(four.pixels, four.quads)),
                                 fmt::format("{:.2f}", four_lanes)});
    result.verdicts.push_back({fmt::format("{} px: lanes a fragment over those counted", area),
                               lanes / fragments / counted, 0.98, 1.02});
    if (i == 0) {
      result.verdicts.push_back({"1 px: live lanes of 4, one sample, against those published", live,
                                 kPublishedLive * (1 - kPublishedBand),
                                 kPublishedLive * (1 + kPublishedBand)});
    }
    data += fmt::format("{} {} {} {}\n", area, lanes / fragments, counted, four_lanes);
  }
  result.remarks = {
      "The triangles are equilateral, turned and placed by chance, so no tile or quad is favoured. What is "
      "counted is counted pixel by "
      "pixel by a rasteriser that shares no code with the machine.",
      "At one sample the published 1.4 live lanes of 4 cannot be reached by any rasteriser that tests pixel "
      "centres: a triangle of one "
      "pixel covers one centre on average and touches 0.92 quads, so 1.08 lanes of a quad that is shaded are "
      "live. With four samples a "
      "pixel the count gives 1.47 live lanes and 7.1 lanes shaded a pixel of area, which suggests that the "
      "published 1.4, and more than 8, "
      "are of several samples. The machine has one."};
  result.plot =
      "set logscale x 2\nset xlabel 'area of a triangle, pixels'\nset ylabel 'lanes'\nset yrange [0:*]\nset "
      "key top right\nset grid\n$d << "
      "EOD\n" +
      data +
      "EOD\nplot $d using 1:3 with lines lw 2 title 'counted, a fragment', '' using 1:2 with points pt 7 "
      "title 'simulated, a fragment', '' "
      "using 1:4 with lines dt 2 title 'counted with 4 samples, a pixel of area'";
  return result;
}

}  // namespace quadrille::studies::experiments
