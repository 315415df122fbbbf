/// The plain SystemC driver: one SC_METHOD and one event a unit, SystemC's own scheduler. Slower than the
/// dispatcher, same cycles.
#pragma once

#include "hw/base/driver.h"

#include <functional>
#include <memory>

namespace quadrille::hw {

class NativeDriver final : public Driver {
 public:
  explicit NativeDriver(sc_core::sc_module_name name) : Driver(name) {}
  /// Called after every action of a unit, at its time. Before the run.
  void observe(std::function<void(const Unit&)> observer) { observer_ = std::move(observer); }

 private:
  void prepare() override;
  void step(std::size_t index);
  void wake_touched();
  [[nodiscard]] static Tick now();

  std::vector<std::unique_ptr<sc_core::sc_event>> events_;
  std::function<void(const Unit&)> observer_;
};

}  // namespace quadrille::hw
