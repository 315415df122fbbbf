#include "hw/base/unit.h"

#include <algorithm>
#include <set>

namespace quadrille::hw {

Unit::Unit(sc_core::sc_module_name name, Kind kind, const Clock& clock) : sc_core::sc_module(name), clock_(clock), kind_(kind) {}

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

void Unit::charge_wait(Tick until, const PortBase* cause) {
  const std::int64_t all = span(accounted_, until);
  const std::int64_t quiet = quiet_ == nullptr ? 0 : quiet_span(accounted_, until);
  idle_ += quiet;
  const std::int64_t waited = all - quiet;
  accounted_ = until;
  if (cause == nullptr) {
    busy_ += waited;
    return;
  }
  cause->add_wait(waited);
  (cause->direction() == PortBase::Direction::kIn ? starved_ : blocked_) += waited;
}

namespace {

/// Latest tick at which a token of a draw moved on any flow that leads into `port`'s FIFO. Walks the flow graph upstream, each FIFO once.
Tick upstream_activity(const FifoBase& fifo, std::set<const FifoBase*>& seen) {
  if (!seen.insert(&fifo).second) return 0;
  Tick last = std::max(fifo.last_push(), fifo.last_pop());
  const Unit& producer = *fifo.producer();
  int stream = 0;
  for (const PortBase* p : producer.ports())
    if (&p->fifo() == &fifo) stream = p->stream();
  for (const PortBase* p : producer.ports()) {
    if (p->direction() != PortBase::Direction::kIn || p->role() != LinkRole::kFlow) continue;
    if (stream != 0 && p->stream() != 0 && p->stream() != stream) continue;
    last = std::max(last, upstream_activity(p->fifo(), seen));
  }
  return last;
}

}  // namespace

Tick Unit::reachable_until() const {
  std::set<const FifoBase*> seen;
  Tick last = 0;
  for (const PortBase* p : ports_) {
    if (p->direction() == PortBase::Direction::kIn && p->role() == LinkRole::kFlow)
      last = std::max(last, upstream_activity(p->fifo(), seen));
  }
  return last;
}

void Unit::close(Tick end) {
  const Tick last_edge = clock_.align(end);
  if (accounted_ > last_edge) {  // the last occupation outlives the frame: the frame's cycles are what is reported
    busy_ -= span(last_edge, accounted_);
    accounted_ = last_edge;
  }
  const Tick reach = std::clamp(clock_.align(reachable_until()), accounted_, last_edge);
  if (reach > accounted_) {
    const Wake wake = next();
    charge_wait(reach, wake.cause());
  }
  idle_ += span(accounted_, last_edge);
  accounted_ = last_edge;
  total_ = clock_.edges_before(end);
  const std::int64_t busy = busy_cycles(), starved = starved_cycles(), blocked = blocked_cycles(), idle = idle_cycles();
  QUADRILLE_CHECK(busy + starved + blocked + idle == total_, "{}: busy {} + starved {} + blocked {} + idle {} != cycles {}", name(), busy,
                  starved, blocked, idle, total_);
}

}  // namespace quadrille::hw
