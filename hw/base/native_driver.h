/// The plain SystemC driver: one SC_METHOD and one event a unit, SystemC's own scheduler. Slower than the
/// dispatcher, same cycles.
#pragma once

#include "hw/base/driver.h"

#include <memory>

namespace quadrille::hw {

class NativeDriver final : public Driver {
 public:
  explicit NativeDriver(sc_core::sc_module_name name) : Driver(name) {}

 private:
  void prepare() override;
  void step(std::size_t index);
  void wake_touched();
  [[nodiscard]] static Tick now();

  std::vector<std::unique_ptr<sc_core::sc_event>> events_;
};

}  // namespace quadrille::hw
