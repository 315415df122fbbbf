/// Bandwidth of the memory by the order in which its controller serves requests.
#include <fmt/format.h>

#include "scenes/scene.h"
#include "studies/experiments/experiment.h"
#include "studies/plot.h"

namespace quadrille::studies::experiments {
namespace {

struct Controller {
  const char* name;
  std::vector<std::string> settings;
};

const std::vector<Controller>& controllers() {
  static const std::vector<Controller> all{{"in order", {"memory.scheduler=in_order", "memory.write_drain=off"}},
                                           {"first-ready", {"memory.scheduler=first_ready", "memory.write_drain=off"}},
                                           {"first-ready, write drain", {"memory.scheduler=first_ready", "memory.write_drain=watermark"}}};
  return all;
}

/// The published gains: from applications under first-ready scheduling to aggressive reordering.
constexpr double kLeastGain = 1.17, kMostGain = 1.93;
/// From here on in-order memory limits a frame: its data bus is held or waits for rows, turns and refresh that long.
constexpr double kLimited = 0.65;

double share(const Readings& r, const char* counter) { return r[counter] / r["memory.cycles"]; }
double bandwidth(const Readings& r) { return r["frame.memory_bytes"] / r["frame.render_cycles"]; }

}  // namespace

Result memory_scheduling(const Setting& setting) {
  std::vector<std::pair<std::string, traces::CommandStream>> streams;
  for (const auto& [name, load] : setting.scenes) streams.emplace_back(name, load());
  std::vector<Frame> frames;
  for (const auto& [name, stream] : streams) {
    for (const Controller& c : controllers()) frames.push_back({&stream, c.settings});
  }
  const std::vector<Readings> read = draw(frames, setting);
  Result result;
  result.table.head = {"scene", "controller", "cycles", "bytes/clk", "data bus", "row hits", "turn-around", "activation", "gain"};
  std::string data;
  for (std::size_t s = 0; s < streams.size(); ++s) {
    const Readings& base = read[s * controllers().size()];
    const bool limited = 1 - share(base, "memory.bus_idle") >= kLimited;
    data += quoted(streams[s].first);
    for (std::size_t c = 0; c < controllers().size(); ++c) {
      const Readings& r = read[s * controllers().size() + c];
      const double gain = bandwidth(r) / bandwidth(base);
      const double accesses = std::max(1.0, r["memory.reads"] + r["memory.writes"]);
      result.table.rows.push_back({c == 0 ? streams[s].first : "", controllers()[c].name, fmt::format("{:.0f}", r["frame.render_cycles"]),
                                   fmt::format("{:.1f}", bandwidth(r)), fmt::format("{:.1f} %", 100 * share(r, "memory.bus_busy")),
                                   fmt::format("{:.1f} %", 100 * r["memory.row_hits"] / accesses),
                                   fmt::format("{:.1f} %", 100 * share(r, "memory.bus_turnaround")),
                                   fmt::format("{:.1f} %", 100 * share(r, "memory.bus_activation")),
                                   c == 0 ? (limited ? "1" : "memory is not the limit") : fmt::format("{:.2f}", gain)});
      data += fmt::format(" {}", bandwidth(r));
      if (c + 1 == controllers().size() && limited)
        result.verdicts.push_back(
            {fmt::format("{}: bandwidth, {} over in order", streams[s].first, controllers()[c].name), gain, kLeastGain, kMostGain});
    }
    data += "\n";
  }
  result.plot =
      "set style data histograms\nset style fill solid 0.8\nset ylabel 'bytes a GPU cycle'\nset yrange [0:*]\nset key top left\nset grid "
      "y\n$d << EOD\n" +
      data + "EOD\nplot $d using 2:xtic(1) title 'in order', '' using 3 title 'first-ready', '' using 4 title 'first-ready, write drain'";
  return result;
}

}  // namespace quadrille::studies::experiments
