/// The report on a machine in which nothing can act any more: the graph of who waits for whom, and the
/// shortest cycle in it.
#include "hw/base/driver.h"

#include <algorithm>
#include <map>
#include <queue>

namespace quadrille::hw {

namespace {

bool is_output(const PortBase& port) { return port.direction() == PortBase::Direction::kOut; }
bool is_full(const PortBase& port) { return is_output(port) && port.fifo().room() == kNever; }
const Unit* peer(const PortBase& port) {
  return is_output(port) ? port.fifo().consumer() : port.fifo().producer();
}

/// The ports a stuck unit waits for: full outputs, and the empty input that its `next()` names.
std::vector<const PortBase*> waits_of(const Unit& unit) {
  std::vector<const PortBase*> waits;
  for (const PortBase* port : unit.ports()) {
    if (is_full(*port)) waits.push_back(port);
  }
  const PortBase* cause = unit.next().cause();
  if (cause != nullptr && !is_output(*cause) && cause->fifo().occupancy() == 0) waits.push_back(cause);
  return waits;
}

std::string waiting_line(const Unit& unit, Tick now) {
  std::string line = fmt::format("  {} (cycle {}) waits for", unit.name(), unit.clock().edges_before(now));
  const auto waits = waits_of(unit);
  if (waits.empty()) return {};
  for (std::size_t i = 0; i < waits.size(); ++i) {
    const FifoBase& link = waits[i]->fifo();
    line += fmt::format("{} {} {} (port {}, {} of {} slots taken, {} {})", i == 0 ? "" : " and",
                        is_output(*waits[i]) ? "room in" : "a token in", link.path(), waits[i]->name(),
                        link.occupancy(), link.spec().depth, is_output(*waits[i]) ? "to" : "from",
                        peer(*waits[i])->name());
  }
  if (const std::string state = unit.state_text(); !state.empty()) line += "; it holds " + state;
  return line + '\n';
}

/// The shortest way of waits from `start` back to itself; empty if there is none.
std::vector<const PortBase*> shortest_cycle(const Unit* start) {
  std::map<const Unit*, const PortBase*> came_by;  // unit -> the port whose owner waits for it
  std::queue<const Unit*> open;
  open.push(start);
  while (!open.empty()) {
    const Unit* unit = open.front();
    open.pop();
    for (const PortBase* wait : waits_of(*unit)) {
      if (!came_by.emplace(peer(*wait), wait).second) continue;
      if (peer(*wait) != start) {
        open.push(peer(*wait));
        continue;
      }
      std::vector<const PortBase*> cycle;
      for (const Unit* u = start; cycle.empty() || u != start; u = &came_by.at(u)->owner())
        cycle.insert(cycle.begin(), came_by.at(u));
      return cycle;
    }
  }
  return {};
}

/// The shortest cycle of all, one with a full link before any other.
std::vector<const PortBase*> blamed_cycle(const std::vector<Unit*>& units) {
  std::vector<const PortBase*> best;
  const auto full_links = [](const std::vector<const PortBase*>& cycle) {
    return std::count_if(cycle.begin(), cycle.end(), [](auto* p) { return is_full(*p); });
  };
  for (const Unit* unit : units) {
    const auto cycle = shortest_cycle(unit);
    if (cycle.empty()) continue;
    const bool better = full_links(cycle) > 0 && (full_links(best) == 0 || cycle.size() < best.size());
    if (best.empty() || better || (full_links(best) == 0 && cycle.size() < best.size())) best = cycle;
  }
  return best;
}

std::string cycle_text(const std::vector<const PortBase*>& cycle) {
  std::string text = "cycle of waiting:";
  for (const PortBase* p : cycle) text += fmt::format(" {} -{}->", p->owner().name(), p->name());
  text += fmt::format(" {}\n", cycle.front()->owner().name());
  const PortBase* blamed = nullptr;
  for (const PortBase* p : cycle) {
    if (is_full(*p) && (blamed == nullptr || p->fifo().spec().depth < blamed->fifo().spec().depth))
      blamed = p;
  }
  if (blamed != nullptr) {
    text += fmt::format(
        "to blame: link {} is full; raise its depth ({} now), or let {} reserve a place before it sends\n",
        blamed->fifo().path(), blamed->fifo().spec().depth, blamed->owner().name());
  } else {
    text += fmt::format(
        "to blame: no link of the cycle is full, so a token was dropped or never sent; {} waits for one in "
        "link {}\n",
        cycle.front()->owner().name(), cycle.front()->fifo().path());
  }
  return text;
}

/// Tokens at hand that their consumer does not take, and why.
std::string leftover_text(const std::vector<Unit*>& units) {
  std::string text;
  for (const Unit* unit : units) {
    const PortBase* cause = unit->next().cause();
    for (const PortBase* port : unit->ports()) {
      if (is_output(*port) || port->fifo().occupancy() == 0) continue;
      text += fmt::format("to blame: link {} holds {} tokens that {} does not take", port->fifo().path(),
                          port->fifo().occupancy(), unit->name());
      if (cause != nullptr && cause != port)
        text += fmt::format("; it waits for {} of link {} by {}", cause->name(), cause->fifo().path(),
                            peer(*cause)->name());
      text += '\n';
    }
  }
  return text;
}

}  // namespace

std::string waiting_report(const std::vector<Unit*>& units, Tick now) {
  std::string text = "who waits for whom:\n";
  for (const Unit* unit : units) text += waiting_line(*unit, now);
  return text;
}

std::string deadlock_report(const std::vector<Unit*>& units, Tick now) {
  std::string text =
      fmt::format("nothing can act after {} fs; {} tokens lie in links; ", now, tokens_in_links(units)) +
      waiting_report(units, now);
  const auto cycle = blamed_cycle(units);
  return text + (cycle.empty() ? leftover_text(units) : cycle_text(cycle));
}

}  // namespace quadrille::hw
