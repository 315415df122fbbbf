#include "hw/base/driver.h"

#include <algorithm>
#include <random>

namespace quadrille::hw {

namespace {

/// SystemC's time unit must be set before the first `sc_time`, and asking for it makes one: so it is set
/// without asking.
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
  if (failure_) std::rethrow_exception(failure_);
  const bool more =
      std::any_of(units_.begin(), units_.end(), [](const Unit* unit) { return unit->next().at() != kNever; });
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
    for (const PortBase* port : unit->ports()) {
      FifoBase& link = port->fifo();
      if (port->direction() == PortBase::Direction::kIn || link.consumer() == nullptr) links.push_back(&link);
    }
  }
  return links;
}

std::int64_t tokens_in_links(const std::vector<Unit*>& units) {
  std::int64_t sum = 0;
  for (const FifoBase* link : links_of(units)) sum += link->occupancy();
  return sum;
}

}  // namespace quadrille::hw
