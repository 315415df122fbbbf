/// Colour writes by format on a machine after a GeForce GTX 460: the published rates of twelve formats and
/// blends, each over that of the first.
#include <fmt/format.h>

#include "studies/experiments/experiment.h"
#include "studies/experiments/measured_meshes.h"

namespace quadrille::studies::experiments {
namespace {

using traces::Format;

constexpr double kClockGhz = 0.675;
/// The card with a bus of 192 bits: 7 multiprocessors of 48 lanes at twice the clock, each of which hands
/// over two pixels of 4 bytes a cycle; 3 partitions of 8 ROPs; 3 x 64 bits of memory at 900 MHz, four bits a
/// cycle and pin. Fitted: what a packer takes a cycle, the
/// warps that a ROP has under way, and the turns of both kinds of float blending.
const std::vector<std::string> kGtx460{
    "gpu.clock_mhz=675",      "gpu.memory_mhz=900",       "gpu.cores=7",
    "core.simds=3",           "core.simd_lanes=32",       "core.export_bytes_per_clk=8",
    "gpu.partitions=3",       "rop.quads_per_clk=2",      "gpu.channels=3",
    "l2.cache_lines=1024",    "warp_packer.launch_clk=0", "warp_packer.quads_per_clk=1",
    "rop.warps_in_flight=64", "rop.half_blend_turns=4",   "rop.float_blend_turns=4"};

struct Row {
  Format format;
  bool blends;
  double published;  ///< Gpixel/s
};
constexpr Row kRows[] = {{Format::kR8G8B8A8Unorm, false, 8.28},     {Format::kR16G16B16A16Float, false, 4.61},
                         {Format::kR32G32B32A32Float, false, 2.42}, {Format::kR8G8B8A8Unorm, true, 8.28},
                         {Format::kR16G16B16A16Float, true, 4.56},  {Format::kR32G32B32A32Float, true, 1.10},
                         {Format::kR8G8Unorm, false, 8.18},         {Format::kR16G16Float, false, 8.07},
                         {Format::kR32G32Float, false, 4.56},       {Format::kR8G8Unorm, true, 8.18},
                         {Format::kR16G16Float, true, 4.52},        {Format::kR32G32Float, true, 1.99}};
constexpr double kBand = 0.1;
constexpr std::uint32_t kFewLayers = 1, kMoreLayers = 8;

/// Gpixel/s of each row: what layers more take, without what begins and ends a frame.
std::vector<double> measure(const Setting& setting) {
  std::vector<traces::CommandStream> streams;
  for (const Row& row : kRows) {
    for (const std::uint32_t n : {kFewLayers, kFewLayers + kMoreLayers}) {
      streams.push_back(stream_of(layers(setting.width, setting.height, n, false),
                                  {.blends = row.blends, .format = row.format}));
    }
  }
  std::vector<Frame> frames;
  frames.reserve(streams.size());
  for (const traces::CommandStream& stream : streams) frames.push_back({&stream, kGtx460});
  const std::vector<Readings> readings = draw(frames, setting);
  const double pixels = static_cast<double>(setting.width) * setting.height * kMoreLayers;
  std::vector<double> rates;
  rates.reserve(std::size(kRows));
  for (std::size_t i = 0; i < readings.size(); i += 2)
    rates.push_back(kClockGhz * pixels / (readings[i + 1]["frame.cycles"] - readings[i]["frame.cycles"]));
  return rates;
}

}  // namespace

Result color_writes(const Setting& setting) {
  const std::vector<double> rates = measure(setting);
  Result result;
  result.table.head = {"format",         "blended",         "published, Gpixel/s",
                       "here, Gpixel/s", "published ratio", "ratio here"};
  std::string data;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const Row& row = kRows[i];
    const double published = row.published / kRows[0].published, ours = rates[i] / rates[0];
    const std::string name =
        fmt::format("{}{}", models::format_info(row.format).name, row.blends ? ", blended" : "");
    result.table.rows.push_back({std::string(models::format_info(row.format).name), row.blends ? "yes" : "no",
                                 fmt::format("{:.2f}", row.published), fmt::format("{:.2f}", rates[i]),
                                 fmt::format("{:.3f}", published), fmt::format("{:.3f}", ours)});
    if (i > 0)
      result.verdicts.push_back(
          {name + ": its ratio over the published one", ours / published, 1 - kBand, 1 + kBand});
    data += fmt::format("\"{}\" {} {}\n", name, row.published, rates[i]);
  }
  result.remarks = {fmt::format("The machine: {}.", fmt::join(kGtx460, ", ")),
                    "Fitted are warp_packer.quads_per_clk, rop.warps_in_flight, rop.half_blend_turns and "
                    "rop.float_blend_turns; the "
                    "rest is what is published of the card. Pixels of up to 4 bytes are limited by the "
                    "packers, wider ones by what the cores hand over, blended floats by the ROPs."};
  result.plot =
      "set style data histogram\nset style fill solid 0.7\nset ylabel 'Gpixel/s'\nset yrange [0:*]\nset "
      "xtics rotate by -30\nset grid y\n$d << EOD\n" +
      data + "EOD\nplot $d using 2:xtic(1) title 'published', '' using 3 title 'here'";
  return result;
}

}  // namespace quadrille::studies::experiments
