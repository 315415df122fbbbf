/// A texture unit that fetches ahead: how many requests have to wait between addresses and filter so that the
/// memory's latency does not show.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "studies/experiments/experiment.h"
#include "studies/experiments/unit_streams.h"

namespace quadrille::studies::experiments {
namespace {

constexpr std::uint32_t kLayers = 4;
constexpr std::array kPlaces{1, 2, 4, 8, 16, 32, 64, 128, 256};
constexpr std::array kLatencies{0, 50, 100, 250, 500, 1000};
constexpr int kFilterQuads = 2, kWarpQuads = 8;

/// One core, whose warps and miss queue never run out; a first-level cache of half a
/// layer's lines, and an L2 cache that keeps all and answers `latency` cycles late.
std::vector<std::string> machine(int places, int latency) {
  return {"gpu.cores=1",
          "core.simd_lanes=32",
          "core.warp_slots=1024",
          "core.register_rows=65536",
          "warp_packer.warp_slots=4096",
          "texture.cache_lines=512",
          "texture.cache_ways=64",
          "texture.cache_misses=4096",
          fmt::format("texture.filter_quads_per_clk={}", kFilterQuads),
          fmt::format("texture.groups_in_flight={}", places),
          fmt::format("l2.hit_clk={}", 1 + latency),
          "l2.cache_lines=65536"};
}

}  // namespace

// A warp asks for one sample of each of its eight quads. What a layer takes is the difference of frames with
// many and with one, so that the first layer's fetches from memory are in both.
Result texture_latency(const Setting& setting) {
  const DrawTexture texture{setting.width, setting.height};
  const auto stream_with = [&](std::uint32_t layers) {
    return stream_of(covered_frame(setting.width, setting.height, layers),
                     {.fragment_shader = sampling_shader(texture, {}), .texture = texture});
  };
  const traces::CommandStream one = stream_with(1), many = stream_with(1 + kLayers);
  std::vector<Frame> frames;
  for (const int places : kPlaces)
    for (const int latency : kLatencies)
      for (const traces::CommandStream* stream : {&one, &many})
        frames.push_back({stream, machine(places, latency)});
  const std::vector<Readings> read = draw(frames, setting);

  const double groups = setting.width * setting.height / (4.0 * kWarpQuads);
  const auto cycles = [&](std::size_t place, std::size_t latency) {  // of a group
    const std::size_t at = 2 * (place * kLatencies.size() + latency);
    return (read[at + 1]["frame.cycles"] - read[at]["frame.cycles"]) / (kLayers * groups);
  };
  const double alone = cycles(0, 0);                  // a group from its addresses to its answer
  const double best = cycles(kPlaces.size() - 1, 0);  // with no latency and all places
  Result result;
  result.table.head = {"places"};
  for (const int latency : kLatencies) result.table.head.push_back(fmt::format("{} clk late", latency));
  std::string data;
  for (std::size_t p = 0; p < kPlaces.size(); ++p) {
    std::vector<std::string> row{fmt::format("{}", kPlaces[p])};
    data += fmt::format("{}", kPlaces[p]);
    for (std::size_t l = 0; l < kLatencies.size(); ++l) {
      const double taken = cycles(p, l), waits = (alone + kLatencies[l]) / kPlaces[p];
      row.push_back(fmt::format("{:.1f} %", 100 * best / taken));
      data += fmt::format(" {}", 100 * best / taken);
      const std::string what = fmt::format("{} places, {} clk late", kPlaces[p], kLatencies[l]);
      if (waits <= best)
        result.verdicts.push_back({what + ": part of the speed without latency", best / taken, 0.97, 1.02});
      else result.verdicts.push_back({what + ": cycles over closed form", taken / waits, 0.95, 1.05});
    }
    result.table.rows.push_back(std::move(row));
    data += "\n";
  }
  result.verdicts.push_back({"cycles of a group without latency, over those of its filter",
                             best * kFilterQuads / kWarpQuads, 0.98, 1.02});
  result.remarks = {
      fmt::format(
          "Shown is the speed, in per cent of that without latency and with 256 places. A request alone "
          "takes "
          "{:.0f} cycles from its addresses to its answer. Places hide the latency when they are as many as "
          "the cycles of a request, latency included, over the {:.0f} that the filter takes for one. With "
          "fewer, each place serves a request after the other.",
          alone, best),
      "A line on its way has a place in the cache already, and one of the miss queue: a cache of 64 lines "
      "hides "
      "no more latency than 64 lines do, whatever waits behind it."};
  result.plot =
      "set logscale x 2\nset xlabel 'requests between addresses and filter'\nset ylabel '% of the speed "
      "without "
      "latency'\nset yrange [0:105]\nset key bottom right\nset grid\n$d << EOD\n" +
      data + "EOD\nplot ";
  for (std::size_t l = 0; l < kLatencies.size(); ++l)
    result.plot += fmt::format("{}$d using 1:{} with linespoints title '{} cycles'", l > 0 ? ", " : "", l + 2,
                               kLatencies[l]);
  return result;
}

}  // namespace quadrille::studies::experiments
