/// Order-independent transparency: panes of glass that cut through each other, drawn sorted by boxes, by
/// k-buffers and by an A-buffer. How far each is from the exact picture, and what it takes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "models/rop/blend.h"
#include "pipeline/render.h"
#include "scenes/scene.h"
#include "studies/experiments/experiment.h"
#include "studies/given_reference.h"
#include "studies/plot.h"

namespace quadrille::studies::experiments {
namespace {

using models::Transparency;
using models::TransparencyState;

struct Way {
  const char* name;
  TransparencyState kept;
};
constexpr Way kWays[] = {{"sorted", {}},
                         {"1 layer", {Transparency::kKbuffer, 1}},
                         {"2 layers", {Transparency::kKbuffer, 2}},
                         {"4 layers", {Transparency::kKbuffer, 4}},
                         {"8 layers", {Transparency::kKbuffer, 8}},
                         {"A-buffer", {Transparency::kAbuffer, 16}}};
constexpr std::size_t kSorted = 0, kFirstLayers = 1, kLists = 5;
constexpr std::uint32_t kSamples[] = {1, 4};

traces::CommandStream scene(const Setting& setting, const TransparencyState& kept, std::uint32_t samples) {
  scenes::SceneOptions options;
  options.width = setting.width;
  options.height = setting.height;
  options.transparency = kept;
  traces::CommandStream stream = scenes::load_scene("builtin:glass", options);
  traces::use_samples(stream, samples);
  return stream;
}

std::array<float, 4> linear_of(std::uint32_t pixel) {
  return models::decode_color(models::Format::kR8G8B8A8Srgb, {{pixel}});
}

/// Root of the mean square of what linear colours differ by, in per cent of the full range.
double error_percent(const std::vector<std::uint32_t>& picture, const std::vector<std::uint32_t>& exact) {
  double squares = 0;
  for (std::size_t i = 0; i < picture.size(); ++i) {
    const auto a = linear_of(picture[i]), b = linear_of(exact[i]);
    for (std::size_t c = 0; c < 3; ++c) squares += (a[c] - b[c]) * (a[c] - b[c]);
  }
  return 100 * std::sqrt(squares / static_cast<double>(3 * std::max<std::size_t>(1, picture.size())));
}

struct Curve {
  std::vector<double> error, cycles, megabytes, rop_megabytes, nodes, overflowed;
};

Curve measure(std::uint32_t samples, const Setting& setting) {
  std::vector<traces::CommandStream> streams;
  std::vector<Frame> frames;
  streams.reserve(std::size(kWays));
  for (const Way& way : kWays) {
    streams.push_back(scene(setting, way.kept, samples));
    frames.push_back({&streams.back(), {}});
  }
  const std::vector<Readings> readings = draw(frames, setting);
  setting.progress(fmt::format("exact, {} samples a pixel", samples));
  const std::vector<std::uint32_t> exact = render_with_reference(streams[kLists], {}).reference.color;
  Curve curve;
  for (std::size_t i = 0; i < std::size(kWays); ++i) {
    const Readings& r = readings[i];
    curve.error.push_back(
        error_percent(pipeline::render_functional_frame(streams[i], {}).image.color, exact));
    curve.cycles.push_back(r["frame.cycles"]);
    curve.megabytes.push_back((r["memory.read_bytes"] + r["memory.write_bytes"]) / 1e6);
    curve.rop_megabytes.push_back((r["rop.read_bytes"] + r["rop.write_bytes"]) / 1e6);
    curve.nodes.push_back(r["rop.nodes"]);
    curve.overflowed.push_back(r["rop.nodes_merged"] + r["rop.nodes_lost"]);
  }
  return curve;
}

void judge(std::uint32_t samples, const Curve& curve, Result& result) {
  const auto verdict = [&](const std::string& what, double value, double least, double most) {
    result.verdicts.push_back(
        {fmt::format("{} sample{}: {}", samples, samples == 1 ? "" : "s", what), value, least, most});
  };
  // A code of 8 bits is at most 0.9 % of the linear range wide, so rounding is within half of that; a pixel
  // with samples has its nodes sorted by their depths at its centre.
  verdict("error of the A-buffer, %", curve.error[kLists], 0, 0.45);
  verdict("nodes that the A-buffer lost", curve.overflowed[kLists], 0, 0);
  for (std::size_t i = kFirstLayers; i + 1 < kLists; ++i)
    verdict(fmt::format("error of {} over {}", kWays[i + 1].name, kWays[i].name),
            curve.error[i + 1] / curve.error[i], 0, 1);
  verdict("error of the A-buffer over sorted", curve.error[kLists] / curve.error[kSorted], 0, 0.2);
  verdict("error of 4 layers over sorted", curve.error[kFirstLayers + 2] / curve.error[kSorted], 0, 1);
  for (std::size_t i = kFirstLayers; i + 1 < kLists; ++i)
    verdict(fmt::format("ROP bytes of {} over {}", kWays[i + 1].name, kWays[i].name),
            curve.rop_megabytes[i + 1] / curve.rop_megabytes[i], 1, 3);
}

}  // namespace

Result transparency(const Setting& setting) {
  Result result;
  result.table.head = {"samples", "order",     "error %", "cycles",        "over sorted",
                       "ROP MB",  "memory MB", "nodes",   "merged or lost"};
  std::string data, plot;
  for (const std::uint32_t samples : kSamples) {
    const Curve curve = measure(samples, setting);
    data += fmt::format("$s{} << EOD\n", samples);
    for (std::size_t i = 0; i < std::size(kWays); ++i) {
      result.table.rows.push_back(
          {fmt::format("{}", samples), kWays[i].name, fmt::format("{:.3f}", curve.error[i]),
           fmt::format("{:.0f}", curve.cycles[i]),
           fmt::format("{:.2f}", curve.cycles[i] / curve.cycles[kSorted]),
           fmt::format("{:.2f}", curve.rop_megabytes[i]), fmt::format("{:.2f}", curve.megabytes[i]),
           fmt::format("{:.0f}", curve.nodes[i]), fmt::format("{:.0f}", curve.overflowed[i])});
      data += fmt::format("{} {} \"{}\"\n", curve.cycles[i] / curve.cycles[kSorted], curve.error[i],
                          kWays[i].name);
    }
    data += "EOD\n";
    const std::string title = fmt::format("{} sample{} a pixel", samples, samples == 1 ? "" : "s");
    plot += fmt::format(
        "{}$s{} using 1:2 with points pointtype 7 title {}, $s{} using 1:2:3 with labels "
        "offset 0,0.8 notitle",
        plot.empty() ? "" : ", ", samples, quoted(title), samples);
    judge(samples, curve, result);
  }
  result.remarks = {
      "The exact picture is the double-precision reference's, given the machine's triangles: all fragments "
      "of a sample, by their depths there. The error is the root of the mean square difference of linear "
      "colours, in per cent of the full range.",
      "A k-buffer has entries for each sample, so its bytes and cycles grow with the layers and with the "
      "samples. A list has a node for each fragment, whatever samples it covers. It holds one depth, at the "
      "pixel's centre, so where panes cut each other inside a pixel its samples share an order."};
  result.plot =
      "set xlabel 'cycles, over those of sorted draws'\nset ylabel 'error, % of the full "
      "range'\nset xrange [0:*]\nset yrange [0:*]\nset offsets 0, graph 0.1, graph 0.05, 0\nset grid\n" +
      data + "plot " + plot;
  return result;
}

}  // namespace quadrille::studies::experiments
