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
/// [P: Fatahalian 2010]: live lanes of 4, and lanes a pixel of area, of triangles of one pixel.
constexpr double kPublishedLive = 1.4, kPublishedLanes = 8, kPublishedBand = 0.15;

double ratio(std::uint64_t a, std::uint64_t b) { return static_cast<double>(a) / static_cast<double>(b); }

/// Triangles of one area: what a rasteriser of its own counts, and what the machine shades.
struct Measured {
  double area = 0, triangles = 0;
  Coverage one, four;
  double fragments = 0, lanes = 0;            ///< at one sample a pixel
  double four_fragments = 0, four_lanes = 0;  ///< at four
  [[nodiscard]] double live() const { return 4 * fragments / lanes; }
  [[nodiscard]] double four_live() const { return 4 * four_fragments / four_lanes; }
  [[nodiscard]] double four_lanes_a_pixel() const { return four_lanes / (area * triangles); }
};

std::vector<Measured> measure(const Setting& setting) {
  std::vector<TriangleMesh> meshes;
  std::vector<traces::CommandStream> streams;
  for (int i = 0; i < kAreas; ++i) {
    meshes.push_back(scattered(setting.width, setting.height, 1 << i));
    streams.push_back(stream_of(meshes.back()));
    streams.push_back(streams.back());
    traces::use_samples(streams.back(), 4);
  }
  std::vector<Frame> frames;
  frames.reserve(streams.size());
  for (const traces::CommandStream& stream : streams) frames.push_back({&stream, {}});
  const std::vector<Readings> read = draw(frames, setting);
  std::vector<Measured> all;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const Readings &one = read[2 * i], &four = read[2 * i + 1];
    all.push_back({static_cast<double>(1 << i), static_cast<double>(meshes[i].triangles.size()),
                   coverage_of(meshes[i], kOneSample), coverage_of(meshes[i], kFourSamples),
                   one["core.fragments"], one["frame.executed_lanes"], four["core.fragments"],
                   four["frame.executed_lanes"]});
  }
  return all;
}

void add_verdicts(const Measured& m, Result& result) {
  result.verdicts.push_back({fmt::format("{} px: lanes a fragment over those counted", m.area),
                             m.lanes / m.fragments / (4 * ratio(m.one.quads, m.one.pixels)), 0.98, 1.02});
  result.verdicts.push_back({fmt::format("{} px, four samples: lanes over those counted", m.area),
                             m.four_lanes / (4 * static_cast<double>(m.four.quads)), 0.98, 1.02});
  if (m.area > 1) return;
  const auto beside = [&](const char* what, double value, double published) {
    result.verdicts.push_back(
        {what, value, published * (1 - kPublishedBand), published * (1 + kPublishedBand)});
  };
  beside("1 px: live lanes of 4, one sample, against those published", m.live(), kPublishedLive);
  beside("1 px: live lanes of 4, four samples, against those published", m.four_live(), kPublishedLive);
  beside("1 px: lanes a pixel of area, four samples, against those published", m.four_lanes_a_pixel(),
         kPublishedLanes);
}

}  // namespace

Result quad_overhead(const Setting& setting) {
  Result result;
  result.table.head = {"area",
                       "triangles",
                       "fragments",
                       "lanes",
                       "lanes a fragment",
                       "counted",
                       "live lanes of 4",
                       "4 samples: live lanes of 4",
                       "counted",
                       "lanes a pixel of area",
                       "counted"};
  std::string data;
  for (const Measured& m : measure(setting)) {
    const double counted = 4 * ratio(m.one.quads, m.one.pixels);
    const double four_counted = 4 * static_cast<double>(m.four.quads) / (m.area * m.triangles);
    result.table.rows.push_back(
        {fmt::format("{}", m.area), fmt::format("{:.0f}", m.triangles), fmt::format("{:.0f}", m.fragments),
         fmt::format("{:.0f}", m.lanes), fmt::format("{:.3f}", m.lanes / m.fragments),
         fmt::format("{:.3f}", counted), fmt::format("{:.3f}", m.live()),
         fmt::format("{:.3f}", m.four_live()), fmt::format("{:.3f}", ratio(m.four.pixels, m.four.quads)),
         fmt::format("{:.2f}", m.four_lanes_a_pixel()), fmt::format("{:.2f}", four_counted)});
    add_verdicts(m, result);
    data += fmt::format("{} {} {} {} {}\n", m.area, m.lanes / m.fragments, counted, m.four_lanes_a_pixel(),
                        four_counted);
  }
  result.remarks = {
      "The triangles are equilateral, turned and placed by chance, so no tile or quad is favoured. What is "
      "counted is counted pixel by pixel by a rasteriser that shares no code with the machine.",
      "At one sample the published 1.4 live lanes of 4 cannot be reached by any rasteriser that tests pixel "
      "centres: a triangle of one pixel covers one centre on average and touches 0.92 quads, so 1.08 lanes "
      "of "
      "a quad that is shaded are live. The published figures are of several samples, and with four the "
      "machine reaches them."};
  result.plot =
      "set logscale x 2\nset xlabel 'area of a triangle, pixels'\nset ylabel 'lanes'\nset yrange [0:*]\nset "
      "key top right\nset grid\n$d << EOD\n" +
      data +
      "EOD\nplot $d using 1:3 with lines lw 2 title 'counted, a fragment', '' using 1:2 with points pt 7 "
      "title 'simulated, a fragment', '' using 1:5 with lines dt 2 title 'counted with 4 samples, a pixel of "
      "area', '' using 1:4 with points pt 6 title 'simulated with 4 samples, a pixel of area'";
  return result;
}

}  // namespace quadrille::studies::experiments
