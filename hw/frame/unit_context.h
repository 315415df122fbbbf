/// What the machine tells every unit that it makes: its clock, the frame and the memory, and the unit's place
/// among its neighbours.
#pragma once

#include "hw/base/clock.h"
#include "hw/frame/frame.h"
#include "models/memory/device_memory.h"
#include "models/raster/engine.h"

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace quadrille::hw {

/// How often units stand that others have a port or a part for.
struct MachineCounts {
  int cores = 1;
  int partitions = 1;
  int channels = 1;    ///< of memory, each with a slice of the L2 cache
  int engines = 1;     ///< of set-up and rasterisation; partitions are a multiple of them
  int front_ends = 1;  ///< of geometry: vertex fetch, primitive assembly, clipper
  [[nodiscard]] int partitions_of_engine() const { return partitions / engines; }
  [[nodiscard]] models::ScreenShare screen() const {
    return {static_cast<std::uint32_t>(partitions), static_cast<std::uint32_t>(engines)};
  }
};

/// Name of a unit's port for number `i` of `count` units of another kind: where one stands alone, without the
/// number.
[[nodiscard]] inline std::string port_name(std::string_view name, std::size_t i, std::size_t count) {
  return count == 1 ? std::string(name) : fmt::format("{}_{}", name, i);
}

/// Given to a unit's constructor. What it refers to outlives the unit.
struct UnitContext {
  const Clock& clock;  ///< the unit's own
  const Frame& frame;
  models::DeviceMemory& memory;
  MachineCounts machine;
  /// of the unit among those of its kind: 0 where it stands once, else that of its core, partition, engine,
  /// front end or channel
  int number = 0;

  /// Name of its port for geometry front end `f`.
  [[nodiscard]] std::string front_end_port(std::string_view name, int f) const {
    return port_name(name, static_cast<std::size_t>(f), static_cast<std::size_t>(machine.front_ends));
  }

  /// Of a unit that stands once a partition.
  [[nodiscard]] PartitionId partition() const { return PartitionId(number); }

  /// Of a unit that has no link to memory in this machine.
  [[nodiscard]] UnitContext without_memory() const {
    UnitContext context = *this;
    context.machine.channels = 0;
    return context;
  }
};

}  // namespace quadrille::hw
