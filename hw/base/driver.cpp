#include "hw/base/driver.h"

#include <algorithm>
#include <map>
#include <random>

namespace quadrille::hw {

namespace {

/// SystemC's time unit must be set before the first `sc_time`, and asking for it makes one: so it is set without asking.
void use_femtoseconds() {
  static const bool once = (sc_core::sc_set_time_resolution(1, sc_core::SC_FS), true);
  (void)once;
}

}  // namespace

Driver::Driver(sc_core::sc_module_name name) : sc_core::sc_module(name) { use_femtoseconds(); }

RunEnd Driver::run(const RunLimits& limits) {
  limits_ = limits;
  limits_.max_time = std::min(limits.max_time, kNever - 1);  // so that kNever is beyond every limit
  touched_.assign((units_.size() + 63) / 64, 0);
  sc_core::sc_start(sc_core::SC_ZERO_TIME);  // ends SystemC's elaboration: ports are bound from here on
  for (std::size_t i = 0; i < units_.size(); ++i) {
    units_[i]->attach();
    units_[i]->set_touch_flag(&touched_[i / 64], static_cast<int>(i % 64));
    units_[i]->touch();
  }
  for (FifoBase* link : links_of(units_)) link->elaborate();
  prepare();
  sc_core::sc_start();
  const bool more = std::any_of(units_.begin(), units_.end(), [](const Unit* unit) { return unit->next().at() != kNever; });
  return more ? RunEnd::kTimeLimit : RunEnd::kQuiescent;
}

std::uint64_t Driver::actions() const {
  std::uint64_t n = 0;
  for (const Unit* unit : units_) n += unit->actions();
  return n;
}

Tick Driver::last_action() const {
  Tick last = -1;
  for (const Unit* unit : units_) last = std::max(last, unit->last_action());
  return last;
}

void Driver::shuffle(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  for (std::size_t i = units_.size(); i > 1; --i) std::swap(units_[i - 1], units_[random() % i]);
}

std::vector<FifoBase*> links_of(const std::vector<Unit*>& units) {
  std::vector<FifoBase*> links;
  for (const Unit* unit : units) {
    for (const PortBase* port : unit->ports()) links.push_back(&port->fifo());
  }
  std::sort(links.begin(), links.end(), std::less<>());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  return links;
}

std::int64_t tokens_in_links(const std::vector<Unit*>& units) {
  std::int64_t sum = 0;
  for (const FifoBase* link : links_of(units)) sum += link->occupancy();
  return sum;
}

namespace {

std::string waiting_line(const Unit& unit, const PortBase& port, Tick now) {
  const bool in = port.direction() == PortBase::Direction::kIn;
  const FifoBase& link = port.fifo();
  const Unit* peer = in ? link.producer() : link.consumer();
  std::string line = fmt::format("  {} waits at cycle {} on {} {} of link {} ({} of {} slots taken) for {}", unit.name(), unit.clock().edges_before(now),
                                 in ? "input" : "output", port.name(), link.path(), link.occupancy(),
                                 link.spec().depth, peer->name());
  if (const std::string state = unit.state_text(); !state.empty()) line += "; it holds " + state;
  return line + '\n';
}

/// Follows "waits for" from `start` until a unit repeats; returns the repeating part.
std::vector<const Unit*> waiting_cycle(const Unit* start, const std::map<const Unit*, const PortBase*>& waits) {
  std::vector<const Unit*> path;
  for (const Unit* u = start; u != nullptr;) {
    for (std::size_t i = 0; i < path.size(); ++i) {
      if (path[i] == u) return {path.begin() + static_cast<std::ptrdiff_t>(i), path.end()};
    }
    path.push_back(u);
    const auto it = waits.find(u);
    if (it == waits.end()) return {};
    const FifoBase& link = it->second->fifo();
    u = it->second->direction() == PortBase::Direction::kIn ? link.producer() : link.consumer();
  }
  return {};
}

}  // namespace

std::string deadlock_report(const std::vector<Unit*>& units, Tick now) {
  std::map<const Unit*, const PortBase*> waits;
  std::string text = fmt::format("no unit can act after {} fs; who waits for whom:\n", now);
  for (const Unit* unit : units) {
    const PortBase* cause = unit->next().cause();
    for (const PortBase* port : unit->ports()) {  // a full output names the culprit better than an empty input
      if (port->direction() == PortBase::Direction::kOut && port->fifo().room() == kNever) cause = port;
    }
    if (cause == nullptr) continue;
    waits[unit] = cause;
    text += waiting_line(*unit, *cause, now);
  }
  for (const auto& [unit, port] : waits) {
    const auto cycle = waiting_cycle(unit, waits);
    if (cycle.empty()) continue;
    text += "cycle of waiting:";
    for (const Unit* u : cycle) text += fmt::format(" {} ->", u->name());
    text += fmt::format(" {}\n", cycle.front()->name());
    for (const Unit* u : cycle) {
      const PortBase* p = waits.at(u);
      if (p->direction() == PortBase::Direction::kOut) {
        text += fmt::format("to blame: link {} is full; raise its depth ({} now)\n", p->fifo().path(),
                            p->fifo().spec().depth);
      }
    }
    break;
  }
  return text;
}

}  // namespace quadrille::hw
