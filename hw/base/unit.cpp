#include "hw/base/unit.h"

#include "hw/base/charge_log.h"

#include <algorithm>
#include <set>
#include <unordered_map>
#include <utility>

namespace quadrille::hw {

Unit::Unit(sc_core::sc_module_name name, Kind kind, const Clock& clock)
    : sc_core::sc_module(name), clock_(clock), kind_(kind) {}

void Unit::attach() {
  for (PortBase* port : ports_) port->attach();
}

std::int64_t Unit::quiet_span(Tick from, Tick to) const {
  std::int64_t sum = 0;
  const auto& all = quiet_->intervals();
  for (auto it = all.rbegin(); it != all.rend() && it->to > from; ++it) {
    const Tick a = clock_.align(std::max(from, it->from));
    const Tick b = clock_.align(std::min(to, it->to));
    if (b > a) sum += span(a, b);
  }
  return sum;
}

void Unit::log_charge(const std::int64_t& of, const PortBase* port) {
  const std::uint32_t own = &of == &busy_ ? ChargeLog::kBusy : ChargeLog::kWaiting;
  charge_log_->note(accounted_, port == nullptr ? own : ChargeLog::kFirstPort + port->number());
}

void Unit::charge_wait(Tick until, const PortBase* cause) {
  const std::int64_t all = span(accounted_, until);
  const std::int64_t quiet =
      quiet_ != nullptr && quiet_->any_after(accounted_) ? quiet_span(accounted_, until) : 0;
  idle_ += quiet;
  const std::int64_t waited = all - quiet;
  accounted_ = until;
  std::int64_t& of = cause == nullptr                                 ? waiting_
                     : cause->direction() == PortBase::Direction::kIn ? starved_
                                                                      : blocked_;
  of += waited;
  if (cause != nullptr) cause->add_wait(waited);
  note_charge(of, cause);
}

namespace {
/// Takes up to `excess` from a charge; returns what is left to take.
std::int64_t taken_from(std::int64_t& charge, std::int64_t excess) {
  const std::int64_t part = std::min(charge, excess);
  charge -= part;
  return excess - part;
}
}  // namespace

// Only a memory channel has so much to do behind the frame's end: it writes back, so what it is charged is
// first its own, and then what it waited for between two writes (docs/deviations.md#D87).
void Unit::take_back_rest(Tick end) {
  std::int64_t left = taken_from(busy_, taken_from(waiting_, span(end, accounted_)));
  for (const PortBase* port : ports_) {
    std::int64_t& of = port->direction() == PortBase::Direction::kIn ? starved_ : blocked_;
    const std::int64_t part = std::min(left, port->waited_span());
    of -= part;
    port->add_wait(-part);
    left -= part;
  }
  QUADRILLE_CHECK(left == 0, "{}: {} cycles were charged behind the frame's end, and none before", name(),
                  left);
  accounted_ = end;
}

void Unit::take_back_from(Tick end) {
  for (std::uint32_t back = 0; accounted_ > end; ++back) {
    if (charges_ == 0 || back + 1 >= kLateCharges) return take_back_rest(end);
    const Charge& last = late_[--charges_ % kLateCharges];
    const Tick from = charges_ > 0 ? std::max(end, late_[(charges_ - 1) % kLateCharges].to) : end;
    const std::int64_t excess = span(from, accounted_);
    *last.of -= excess;
    if (last.port != nullptr) last.port->add_wait(-excess);
    accounted_ = from;
  }
}

void Unit::close(Tick end, Tick reachable_until) {
  const Tick last_edge = clock_.align(end);
  charge_log_ = nullptr;
  // occupations may outlive the frame, and tokens that nobody waits for arrive behind it
  take_back_from(last_edge);
  const Tick reach = std::clamp(clock_.align(reachable_until), accounted_, last_edge);
  if (reach > accounted_) {
    const Wake wake = next();
    charge_wait(reach, wake.cause());
  }
  idle_ += span(accounted_, last_edge);
  accounted_ = last_edge;
  total_ = clock_.edges_before(end);
  finish_stats(end);
  const std::int64_t busy = busy_cycles(), waiting = waiting_cycles(), starved = starved_cycles(),
                     blocked = blocked_cycles(), idle = idle_cycles();
  QUADRILLE_CHECK(busy + waiting + starved + blocked + idle == total_,
                  "{}: busy {} + waiting {} + starved {} + blocked {} + idle {} != cycles {}", name(), busy,
                  waiting, starved, blocked, idle, total_);
}

namespace {

/// For each unit the latest tick at which a token moved on any flow that leads to it. Links are followed
/// downstream in order of their latest move, the latest first, each only to where no earlier one came: every
/// flow through a unit is walked once.
class FlowActivity {
 public:
  explicit FlowActivity(const std::vector<Unit*>& units) {
    std::vector<std::pair<Tick, const PortBase*>> moves;
    for (const Unit* unit : units) {
      for (const PortBase* port : unit->ports()) {
        if (port->direction() != PortBase::Direction::kIn || port->role() != LinkRole::kFlow) continue;
        input_of_.emplace(&port->fifo(), port);
        moves.emplace_back(std::max(port->fifo().last_push(), port->fifo().last_pop()), port);
      }
    }
    std::sort(moves.begin(), moves.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    for (const auto& [moved, input] : moves) follow(*input, moved);
  }
  /// 0 if none leads there.
  [[nodiscard]] Tick reaching(const Unit& unit) const {
    const auto found = latest_.find(&unit);
    return found == latest_.end() ? 0 : found->second;
  }

 private:
  void follow(const PortBase& from, Tick moved) {
    std::vector<const PortBase*> open{&from};
    while (!open.empty()) {
      const PortBase& input = *open.back();
      open.pop_back();
      const Unit& unit = input.owner();
      if (!entered_.emplace(&unit, input.stream()).second) continue;
      latest_.emplace(&unit, moved);
      for (const PortBase* output : unit.ports()) {
        if (output->direction() != PortBase::Direction::kOut) continue;
        if (output->stream() != 0 && input.stream() != 0 && output->stream() != input.stream()) continue;
        if (const auto next = input_of_.find(&output->fifo()); next != input_of_.end())
          open.push_back(next->second);
      }
    }
  }

  /// inputs that carry a flow, by their link
  std::unordered_map<const FifoBase*, const PortBase*> input_of_;
  /// units, and the stream by which they were entered
  std::set<std::pair<const Unit*, int>> entered_;
  std::unordered_map<const Unit*, Tick> latest_;
};

}  // namespace

void close_accounts(const std::vector<Unit*>& units, Tick end) {
  const FlowActivity activity(units);
  for (Unit* unit : units) unit->close(end, activity.reaching(*unit));
  Tick slice = 0;
  for (const Unit* unit : units) slice = std::max(slice, unit->resources().slice());
  for (Unit* unit : units) unit->finish_resources(end, slice);
}

}  // namespace quadrille::hw
