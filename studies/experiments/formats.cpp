/// Colour formats: what a pixel costs the ROP in cycles and in bytes, by the bytes that it is stored as.
#include <fmt/format.h>

#include <algorithm>

#include "studies/experiments/experiment.h"
#include "studies/experiments/measured_meshes.h"

namespace quadrille::studies::experiments {
namespace {

constexpr std::uint32_t kLayers = 8;
/// The ROPs limit: one quad a cycle each, and memory that keeps up with 16 bytes a pixel, read and written.
const std::vector<std::string> kSlowRops{"rop.quads_per_clk=1", "rop.cache_lines=4096",
                                         "rop.cache_ways=64",   "gpu.cores=32",
                                         "gpu.channels=8",      "fine_raster.quads_per_clk=16"};

std::vector<traces::Format> color_formats() {
  std::vector<traces::Format> formats;
  for (int f = 0; f <= static_cast<int>(models::kLastFormat); ++f) {
    const auto format = static_cast<traces::Format>(f);
    if (models::format_info(format).may(models::kColorUse)) formats.push_back(format);
  }
  std::ranges::stable_sort(formats, {}, traces::format_bytes);
  return formats;
}

/// Layers over the frame: of a format of integers, such are written, and a logic operation is what reads the
/// attachment in the place of blending.
traces::CommandStream fill_of(traces::Format format, const Setting& setting, std::uint32_t count,
                              bool blends) {
  DrawOptions options{.format = format};
  const traces::NumberKind kind = traces::number_kind(format);
  const bool integers = kind != traces::NumberKind::kFloat;
  options.blends = blends && !integers;
  if (integers)
    options.fragment_shader = fmt::format(
        "#version 450\nlayout(location = 0) out {0} color;\nvoid main() {{ color = {0}(1, 2, 3, 4); }}",
        kind == traces::NumberKind::kSint ? "ivec4" : "uvec4");
  traces::CommandStream stream = stream_of(layers(setting.width, setting.height, count, false), options);
  stream.pipelines[0].blend_shared.logic = blends && integers;
  stream.pipelines[0].blend_shared.logic_op = traces::LogicOp::kXor;
  return stream;
}

/// One format.
struct Fill {
  double opaque = 0, blended = 0;  ///< cycles that a layer more takes
  double bytes = 0;                ///< written by the colour caches, of an opaque layer
};

/// The time of a layer is the difference of frames with many and with one: what begins and ends a frame is in
/// both.
std::vector<Fill> measure(const std::vector<traces::Format>& formats, const Setting& setting) {
  std::vector<traces::CommandStream> streams;
  for (const traces::Format format : formats) {
    for (const bool blends : {false, true})
      for (const std::uint32_t count : {1U, kLayers + 1})
        streams.push_back(fill_of(format, setting, count, blends));
  }
  std::vector<Frame> frames;
  frames.reserve(streams.size());
  for (const traces::CommandStream& stream : streams) frames.push_back({&stream, kSlowRops});
  const std::vector<Readings> readings = draw(frames, setting);
  std::vector<Fill> fills;
  fills.reserve(formats.size());
  for (std::size_t i = 0; i < readings.size(); i += 4) {
    const auto layer = [&](std::size_t first) {
      return (readings[first + 1]["frame.cycles"] - readings[first]["frame.cycles"]) / kLayers;
    };
    fills.push_back({layer(i), layer(i + 2), readings[i]["rop.write_bytes"]});
  }
  return fills;
}

}  // namespace

Result formats(const Setting& setting) {
  const std::vector<traces::Format> all = color_formats();
  const std::vector<Fill> fills = measure(all, setting);
  const double pixels = static_cast<double>(setting.width) * setting.height;
  const auto usual = std::ranges::find(all, traces::Format::kR8G8B8A8Unorm);
  const Fill& base = fills[static_cast<std::size_t>(usual - all.begin())];
  Result result;
  result.table.head = {"format",        "bytes",          "written a pixel",
                       "opaque px/clk", "blended px/clk", "expected, opaque"};
  std::string data;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const models::FormatInfo& info = models::format_info(all[i]);
    const double words = std::max(1.0, info.bytes / 4.0);
    result.table.rows.push_back(
        {std::string(info.name), fmt::format("{}", info.bytes),
         fmt::format("{:.2f}", fills[i].bytes / pixels), fmt::format("{:.2f}", pixels / fills[i].opaque),
         fmt::format("{:.2f}", pixels / fills[i].blended), fmt::format("1/{:.0f} of R8G8B8A8", words)});
    const std::string name(info.name);
    result.verdicts.push_back(
        {name + ": bytes written over those of its pixels", fills[i].bytes / (info.bytes * pixels), 1, 1});
    result.verdicts.push_back({name + ": cycles over those of R8G8B8A8, over its words",
                               fills[i].opaque / base.opaque / words, 0.98, 1.02});
    const char* const reads = traces::is_integer_format(all[i]) ? ": exclusive or" : ": blended";
    result.verdicts.push_back(
        {name + reads + " over opaque, over 2", fills[i].blended / fills[i].opaque / 2, 0.98, 1.02});
    const std::string label = name.substr(0, name.find("_PACK32"));
    data += fmt::format("\"{}\" {} {}\n", label, pixels / fills[i].opaque, pixels / fills[i].blended);
  }
  result.remarks = {
      "A ROP's path to its cache takes a quad of up to 4 bytes a pixel at once: 8 bytes take two turns and "
      "16 "
      "take four, and blending takes twice that, once to read and once to write.",
      "Integers are not blended: what stands for it is the logic operation exclusive or, which reads the "
      "attachment too.",
      "Tiles of one-byte pixels fill half a line of 128 bytes each, and move that half."};
  result.plot =
      "set style data histogram\nset style fill solid 0.7\nset ylabel 'pixels a cycle'\nset yrange [0:*]\n"
      "set xtics rotate by -60 noenhanced font ',9'\nset bmargin 9\nset rmargin 8\nset grid y\n$d << EOD\n" +
      data + "EOD\nplot $d using 2:xtic(1) title 'opaque', '' using 3 title 'blended'";
  return result;
}

}  // namespace quadrille::studies::experiments
