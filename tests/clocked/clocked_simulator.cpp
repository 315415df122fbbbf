#include "tests/clocked/clocked_simulator.h"

#include "tests/clocked/clocked_unit.h"

#include <algorithm>
#include <limits>

namespace quadrille::clocked {

namespace {

/// A clock as a counter of edges.
struct TickingClock {
  std::int64_t hz = 1;
  std::int64_t edge = 0;
  std::int64_t next = 0;  ///< femtosecond of edge number `edge`
  bool ticks = false;     ///< has an edge at this moment
};

class Simulation {
 public:
  explicit Simulation(const WorldSpec& spec) : spec_(spec) {
    for (const std::int64_t hz : spec.clocks_hz) clocks_.push_back({hz});
    for (const auto& u : spec.units) units_.emplace_back(u);
    for (const auto& w : spec.wires) {
      const bool crosses = spec.clocks_hz[clock_of(w.from.unit)] != spec.clocks_hz[clock_of(w.to.unit)];
      links_.push_back(std::make_unique<ClockedLink>(w, crosses));
      units_[static_cast<std::size_t>(w.from.unit)].out[static_cast<std::size_t>(w.from.port)].link =
          links_.back().get();
      units_[static_cast<std::size_t>(w.to.unit)].in[static_cast<std::size_t>(w.to.port)].link =
          links_.back().get();
    }
  }

  Result run(std::int64_t end) {
    for (std::int64_t now = next_moment(); now < end; now = next_moment()) moment(now);
    Result result;
    for (auto& u : units_) result.trace.push_back(std::move(u.events));
    for (const auto& l : links_) result.tokens_in_links.push_back(l->tokens());
    return result;
  }

 private:
  [[nodiscard]] std::size_t clock_of(int unit) const {
    return static_cast<std::size_t>(spec_.units[static_cast<std::size_t>(unit)].clock);
  }

  [[nodiscard]] std::int64_t next_moment() const {
    std::int64_t soonest = std::numeric_limits<std::int64_t>::max();
    for (const TickingClock& c : clocks_) soonest = std::min(soonest, c.next);
    return soonest;
  }

  /// Everything that happens at one femtosecond: links see the edges first, then units tick; no unit can see
  /// what another does in the same moment.
  void moment(std::int64_t now) {
    for (TickingClock& c : clocks_) c.ticks = c.next == now;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const auto& w = spec_.wires[i];
      const bool from = clocks_[clock_of(w.from.unit)].ticks;
      const bool to = clocks_[clock_of(w.to.unit)].ticks;
      if (to) links_[i]->consumer_edge();
      if (from) links_[i]->producer_edge();
      units_[static_cast<std::size_t>(w.from.unit)].out[static_cast<std::size_t>(w.from.port)].together = to;
      units_[static_cast<std::size_t>(w.to.unit)].in[static_cast<std::size_t>(w.to.port)].together = from;
    }
    for (std::size_t i = 0; i < units_.size(); ++i) {
      if (clocks_[clock_of(static_cast<int>(i))].ticks) units_[i].tick(now);
    }
    for (TickingClock& c : clocks_) {
      if (c.ticks) c.next = edge_time(c.hz, ++c.edge);
    }
  }

  const WorldSpec& spec_;
  std::vector<TickingClock> clocks_;
  std::vector<ClockedUnit> units_;
  std::vector<std::unique_ptr<ClockedLink>> links_;
};

}  // namespace

std::int64_t edge_time(std::int64_t hz, std::int64_t k) {
  // A guess in floating point, then the exact floor in integers.
  const std::int64_t seconds = k / hz;
  long double rest = static_cast<long double>(k % hz);
  auto fs = static_cast<std::int64_t>(rest * 1e15L / static_cast<long double>(hz));
  // The floor, exactly: fs * hz <= rest * 10^15 < (fs + 1) * hz.
  __extension__ using Wide = __int128;
  const Wide target = static_cast<Wide>(k % hz) * 1'000'000'000'000'000;
  while (static_cast<Wide>(fs) * hz > target) --fs;
  while (static_cast<Wide>(fs + 1) * hz <= target) ++fs;
  return seconds * 1'000'000'000'000'000 + fs;
}

Result simulate(const WorldSpec& spec, std::int64_t end) { return Simulation(spec).run(end); }

}  // namespace quadrille::clocked
