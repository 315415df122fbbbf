#include "hw/base/dispatcher.h"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <queue>
#include <unordered_map>
#include <utility>

namespace quadrille::hw {

namespace {

/// Rounds in one activation of the SC_METHOD; between activations SystemC's time catches up and progress is
/// reported.
constexpr int kRoundsPerActivation = 1 << 14;

/// With a window: so many calls without a surprise lengthen a chooser's slack by a cycle. More calls: smaller
/// errors, less gained. [M: docs/accuracy.md]
constexpr Tick kCallsACycle = 4;

Tick saturating_add(Tick a, Tick b) { return a > kNever - b ? kNever : a + b; }

constexpr std::size_t kLanes = 4;  // of 64 bits in a vector register

struct Earliest {
  Tick first = kNever, second = kNever;  ///< equal when two choosers share the earliest time
};

/// The two smallest times, in lanes that the compiler makes one vector of. The number of times is a multiple
/// of `kLanes`.
Earliest earliest_of(const std::vector<Tick>& times) {
  std::array<Tick, kLanes> first, second;
  first.fill(kNever);
  second.fill(kNever);
  for (std::size_t i = 0; i < times.size(); i += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const Tick t = times[i + lane];
      const Tick later = first[lane] > t ? first[lane] : t;
      first[lane] = first[lane] < t ? first[lane] : t;
      second[lane] = second[lane] < later ? second[lane] : later;
    }
  }
  Earliest e;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    e.second = std::min({e.second, second[lane], std::max(e.first, first[lane])});
    e.first = std::min(e.first, first[lane]);
  }
  return e;
}

/// Which of up to 64 choosers may act: bit i where times[i] is less than reach[i] after `first`, and not
/// after `limit`. `n` is a multiple of `kLanes`. In vectors and without branches: who is among them is as
/// good as random.
std::uint64_t able_among(const Tick* times, const Tick* reach, std::size_t n, Tick first, Tick limit) {
  std::uint64_t able = 0;
  for (std::size_t i = 0; i < n; i += kLanes) {
    const __m256i time = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(times + i));
    const __m256i bound = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(reach + i));
    const __m256i near = _mm256_cmpgt_epi64(bound, _mm256_sub_epi64(time, _mm256_set1_epi64x(first)));
    const __m256i late = _mm256_cmpgt_epi64(time, _mm256_set1_epi64x(limit));
    able |=
        static_cast<std::uint64_t>(_mm256_movemask_pd(_mm256_castsi256_pd(_mm256_andnot_si256(late, near))))
        << i;
  }
  return able;
}

}  // namespace

void Dispatcher::prepare() {
  const std::vector<std::vector<Neighbour>> neighbours = surprisers();
  chooser_of_.assign(units_.size(), 0);
  chooser_marks_.assign(touched_.size(), 0);
  for (std::size_t i = 0; i < units_.size(); ++i) {
    Unit& unit = *units_[i];
    if (unit.unit_kind() != Unit::Kind::kChooser) continue;
    chooser_of_[i] = choosers_.size();
    chooser_marks_[i / 64] |= std::uint64_t{1} << (i % 64);
    const Reach reach = reach_of(i, neighbours);
    choosers_.push_back({&unit, unit.touched_word(), unit.touched_bit(), reach.self, Wake(kNever), reach, 0});
    reach_.push_back(reach.others);
  }
  times_.assign((choosers_.size() + kLanes - 1) / kLanes * kLanes, kNever);
  reach_.resize(times_.size());
  sc_core::sc_spawn_options options;
  options.spawn_method();
  sc_core::sc_spawn([this] { guard([this] { step(); }); }, "step", &options);
}

/// Producers surprise by tokens, consumers by credits.
std::vector<std::vector<Dispatcher::Neighbour>> Dispatcher::surprisers() const {
  std::unordered_map<const Unit*, std::uint32_t> number;
  for (const Unit* unit : units_) number.emplace(unit, static_cast<std::uint32_t>(number.size()));
  std::vector<std::vector<Neighbour>> all(units_.size());
  // of a neighbour in the list being made; valid where `owner` says so
  std::vector<std::size_t> place(units_.size());
  std::vector<const Unit*> owner(units_.size());
  for (std::size_t i = 0; i < units_.size(); ++i) {
    for (const PortBase* port : units_[i]->ports()) {
      const FifoBase& link = port->fifo();
      const bool input = port->direction() == PortBase::Direction::kIn;
      const std::uint32_t peer = number.at(input ? link.producer() : link.consumer());
      const Tick latency = input ? link.forward_lookahead() : link.credit_lookahead();
      if (owner[peer] != units_[i]) {
        owner[peer] = units_[i];
        place[peer] = all[i].size();
        all[i].push_back({peer, latency});
      } else {
        all[i][place[peer]].latency = std::min(all[i][place[peer]].latency, latency);
      }
    }
  }
  return all;
}

/// Dijkstra's algorithm against the flow of surprises, until the nearest other chooser and the shortest way
/// back are known. A fixed-order unit adds no time of its own: it may act in the very tick that enables it.
Dispatcher::Reach Dispatcher::reach_of(std::size_t chooser,
                                       const std::vector<std::vector<Neighbour>>& surprisers) const {
  Tick others = kNever;
  // the shortest way known to each unit; to the chooser itself a round trip
  std::vector<Tick> nearest(units_.size(), kNever);
  using Entry = std::pair<Tick, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  open.emplace(0, chooser);
  while (!open.empty()) {
    const auto [distance, unit] = open.top();
    open.pop();
    if (distance >= std::max(nearest[chooser], others)) break;
    if (distance > nearest[unit]) continue;
    for (const Neighbour& n : surprisers[unit]) {
      const Tick there = saturating_add(distance, n.latency);
      if (there >= nearest[n.unit]) continue;
      nearest[n.unit] = there;
      if (n.unit != chooser && units_[n.unit]->unit_kind() == Unit::Kind::kChooser)
        others = std::min(others, there);
      open.emplace(there, n.unit);
    }
  }
  return {others, nearest[chooser]};
}

void Dispatcher::step() {
  bool alive = true;
  for (int i = 0; i < kRoundsPerActivation && alive; ++i) {
    settle();
    alive = round();
  }
  if (!alive) return;  // SystemC runs out of events and sc_start returns
  const Tick floor = earliest_of(times_).first;
  // never: whoever acts next was marked in the last round
  if (limits_.progress && floor != kNever) limits_.progress(floor);
  const auto now = static_cast<Tick>(sc_core::sc_time_stamp().value());
  const Tick ahead = floor == kNever || floor <= now ? 1 : floor - now;
  sc_core::next_trigger(sc_core::sc_time::from_value(static_cast<sc_dt::uint64>(ahead)));
}

void Dispatcher::settle() {
  while (run_marked()) {}
  for (std::size_t w = 0; w < touched_.size(); ++w) {
    for (std::uint64_t marks = std::exchange(touched_[w], 0); marks != 0; marks &= marks - 1) {
      const std::size_t k = chooser_of_[w * 64 + static_cast<std::size_t>(std::countr_zero(marks))];
      const Wake asked = choosers_[k].unit->next();
      if (window_ > 0 && choosers_[k].unit->may_run_ahead()) adapt(k, asked.at());
      choosers_[k].wake = asked.not_before(choosers_[k].unit->last_action());
      times_[k] = choosers_[k].wake.at();
    }
  }
}

void Dispatcher::adapt(std::size_t k, Tick asked) {
  Chooser& c = choosers_[k];
  if (asked < c.unit->last_action()) c.slack /= 2;
  else c.slack = std::min(window_, c.slack + c.unit->clock().period() / kCallsACycle);
  reach_[k] = saturating_add(c.exact.others, c.slack);
  c.round_trip = saturating_add(c.exact.self, c.slack);
}

bool Dispatcher::run_marked() {
  bool any = false;
  for (std::size_t w = 0; w < touched_.size(); ++w) {
    while (const std::uint64_t marks = touched_[w] & ~chooser_marks_[w]) {
      any = true;
      touched_[w] ^= marks & (~marks + 1);
      run_ahead(*units_[w * 64 + static_cast<std::size_t>(std::countr_zero(marks))]);
    }
  }
  return any;
}

void Dispatcher::run_ahead(Unit& unit) const {
  for (Wake wake = unit.wake(); wake.at() <= limits_.max_time; wake = unit.wake()) unit.perform(wake);
}

bool Dispatcher::round() {
  // before anyone acts: what they do from here on is never earlier than these
  const Earliest earliest = earliest_of(times_);
  if (earliest.first > limits_.max_time) return false;
  for (std::size_t base = 0; base < times_.size(); base += 64) {
    const std::size_t n = std::min<std::size_t>(64, times_.size() - base);
    std::uint64_t able = able_among(&times_[base], &reach_[base], n, earliest.first, limits_.max_time);
    for (; able != 0; able &= able - 1) {
      const std::size_t k = base + static_cast<std::size_t>(std::countr_zero(able));
      const Tick time = times_[k];
      const Tick others = time == earliest.first ? earliest.second : earliest.first;
      run_chooser(k,
                  std::min(saturating_add(others, reach_[k]), saturating_add(time, choosers_[k].round_trip)));
    }
  }
  return true;
}

void Dispatcher::run_chooser(std::size_t k, Tick bound) {
  Chooser& c = choosers_[k];
  // What others did in this round shows at the bound or later: it changes no action before it, and the last
  // question below sees it.
  *c.mark_word &= ~c.mark_bit;
  do {
    c.unit->perform(c.wake);
    c.wake = c.unit->wake();
  } while (c.wake.at() < bound && c.wake.at() <= limits_.max_time);
  times_[k] = c.wake.at();
}

}  // namespace quadrille::hw
