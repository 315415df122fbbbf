/// Every kind of unit by itself: a frame that it limits against arithmetic, and one in which its rate is of
/// no account.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/experiments/experiment.h"
#include "studies/experiments/unit_benchmarks.h"
#include "studies/plot.h"

namespace quadrille::studies::experiments {
namespace {

constexpr double kLeast = 0.98, kMost = 1.02;
constexpr double kMostMove = 0.005;  ///< of a frame, by a parameter that must not matter
constexpr double kFactors[] = {0.5, 2};

const char* word(const Verdict& verdict) { return verdict.holds() ? "holds" : "FAILS"; }

double measured(const LimitedFrame& frame, const Readings& read) {
  return frame.share == Share::kRender ? read["frame.render_cycles"]
                                       : read["frame.cycles"] - read["frame.render_cycles"];
}

void judge_limited(const std::vector<LimitedFrame>& limited, std::span<const Readings> read, Result& result) {
  result.table.head = {
      "unit",      "frame that it limits", "cycles by arithmetic", "predicted", "measured", "difference",
      "within 2 %"};
  std::string data;
  for (std::size_t i = 0; i < limited.size(); ++i) {
    const LimitedFrame& f = limited[i];
    const double cycles = measured(f, read[i]);
    const Verdict verdict{fmt::format("{}, {}: cycles over arithmetic", f.unit, f.what), cycles / f.predicted,
                          kLeast, kMost};
    result.table.rows.push_back({std::string(f.unit), f.what, f.formula, fmt::format("{:.0f}", f.predicted),
                                 fmt::format("{:.0f}", cycles),
                                 fmt::format("{:+.2f} %", 100 * (verdict.value - 1)), word(verdict)});
    result.verdicts.push_back(verdict);
    data += quoted(std::string(f.unit)) + fmt::format(" {}\n", 100 * (verdict.value - 1));
  }
  result.plot =
      "set style data histograms\nset style fill solid 0.8\nset ylabel 'measured over arithmetic, %'\n"
      "set yrange [-2:2]\nset xtics rotate by -35\nset grid y\nunset key\n$d << EOD\n" +
      data + "EOD\nplot $d using 2:xtic(1)";
}

/// `read`: of each frame as it is, with half of its parameter, and with twice of it.
void judge_slack(const std::vector<SlackFrame>& slack, std::span<const Readings> read, Result& result) {
  Table table;
  table.head = {"unit",   "frame that it does not limit", "parameter",    "values",
                "cycles", "greatest difference",          "at most 0.5 %"};
  for (const SlackFrame& f : slack) {
    const double base = read[0]["frame.cycles"], half = read[1]["frame.cycles"],
                 twice = read[2]["frame.cycles"];
    read = read.subspan(3);
    const double move = std::max(std::abs(half / base - 1), std::abs(twice / base - 1));
    const Verdict verdict{fmt::format("{}, {}: part that {} moves the frame by", f.unit, f.what, f.parameter),
                          move, 0, kMostMove};
    table.rows.push_back({std::string(f.unit), f.what, f.parameter,
                          fmt::format("{}, {}, {}", kFactors[0] * f.value, f.value, kFactors[1] * f.value),
                          fmt::format("{:.0f}, {:.0f}, {:.0f}", half, base, twice),
                          fmt::format("{:.2f} %", 100 * move), word(verdict)});
    result.verdicts.push_back(verdict);
  }
  result.further_tables.push_back(std::move(table));
}

}  // namespace

Result judged(const std::vector<LimitedFrame>& limited, const std::vector<SlackFrame>& slack,
              const Setting& setting) {
  std::vector<Frame> frames;
  frames.reserve(limited.size());
  for (const LimitedFrame& f : limited) frames.push_back({&f.stream, f.settings});
  for (const SlackFrame& f : slack) {
    frames.push_back({&f.stream, f.settings});
    for (const double factor : kFactors) {
      frames.push_back({&f.stream, f.settings});
      frames.back().settings.push_back(fmt::format("{}={}", f.parameter, factor * f.value));
    }
  }
  const std::vector<Readings> read = draw(frames, setting);
  Result result;
  judge_limited(limited, std::span(read).first(limited.size()), result);
  judge_slack(slack, std::span(read).subspan(limited.size()), result);
  return result;
}

Result units(const Setting& setting) {
  Result result = judged(limited_frames(setting.width, setting.height),
                         slack_frames(setting.width, setting.height), setting);
  result.remarks = {
      "Cycles are those until the pass is flushed, of scan-out those after it. The arithmetic is work over "
      "rate; what is left over is the frame's beginning, until the first work reaches the unit, and its end, "
      "the flush: about 500 cycles whatever the frame.",
      "Two have more of it: frames that sample textures begin with texels from memory, and a chain by itself "
      "also pays for the change from one warp to the next.",
      "The work distributor, a slice of the L2 cache and scan-out do one thing a cycle and have no parameter "
      "for that. The second table turns what they have instead: places on the way to a core, the latency of "
      "a hit, lines under way."};
  return result;
}

}  // namespace quadrille::studies::experiments
