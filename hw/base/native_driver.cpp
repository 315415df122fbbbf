#include "hw/base/native_driver.h"

#include <bit>

namespace quadrille::hw {

Tick NativeDriver::now() { return static_cast<Tick>(sc_core::sc_time_stamp().value()); }

void NativeDriver::prepare() {
  for (std::size_t i = 0; i < units_.size(); ++i) {
    events_.push_back(std::make_unique<sc_core::sc_event>(fmt::format("wake_{}", i).c_str()));
    sc_core::sc_spawn_options options;
    options.spawn_method();
    options.set_sensitivity(events_.back().get());
    options.dont_initialize();
    sc_core::sc_spawn([this, i] { guard([this, i] { step(i); }); }, fmt::format("unit_{}", i).c_str(),
                      &options);
  }
  wake_touched();
}

void NativeDriver::step(std::size_t index) {
  Unit& unit = *units_[index];
  const Wake wake = unit.wake();
  if (wake.at() == now()) {
    unit.perform(wake);
    if (observer_) observer_(unit);
  }
  unit.touch();
  wake_touched();
}

void NativeDriver::wake_touched() {
  for (std::size_t w = 0; w < touched_.size(); ++w) {
    for (std::uint64_t word = touched_[w]; word != 0; word &= word - 1) {
      const std::size_t i = w * 64 + static_cast<std::size_t>(std::countr_zero(word));
      const Tick at = units_[i]->wake().at();
      events_[i]->cancel();
      if (at > limits_.max_time) continue;
      events_[i]->notify(
          sc_core::sc_time::from_value(static_cast<sc_dt::uint64>(at > now() ? at - now() : 0)));
    }
    touched_[w] = 0;
  }
}

}  // namespace quadrille::hw
