/// One measured run: a frame drawn in a process of its own, with what it cost the host, what it cost the
/// machine, and the picture.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/machine/machine_config.h"
#include "pipeline/render.h"
#include "traces/command_stream.h"

namespace quadrille::studies {

/// How a frame is drawn. Without a window: values only, no machine.
struct RunSetting {
  std::optional<std::int64_t> window;  ///< cycles beyond the exact bound; 0 is exact
  models::Precision precision;         ///< of a functional run; a machine has its own
  /// "functional", "exact", "window 64".
  [[nodiscard]] std::string name() const;
};

struct UnitBusy {
  std::string path;
  double percent = 0;  ///< of the unit's cycles
};
struct ClientBytes {
  std::string name;
  std::uint64_t bytes = 0;  ///< read and written
};

/// What a frame cost the machine: equal on every run of a setting, on every host.
struct MachineCost {
  std::int64_t cycles = 0;  ///< of the GPU clock
  std::vector<UnitBusy> units;
  std::vector<ClientBytes> clients;
  std::uint64_t memory_bytes = 0;  ///< moved by the memory channels
};

struct TimedRun {
  /// of the simulation alone: loading, compiling and elaborating are not in it
  double cpu_s = 0, wall_s = 0;
  std::optional<MachineCost> cost;  ///< none of a functional run
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint32_t> color;  ///< RGBA8 as stored, red in the low byte
};

/// Runs once. Throws `UserError` with what the run was refused for, and `std::runtime_error` when it failed
/// or broke a law.
[[nodiscard]] TimedRun run_timed(const traces::CommandStream& stream, const pipeline::MachineConfig& machine,
                                 const RunSetting& setting);

/// The parts of the figures that errors are taken of.
[[nodiscard]] MachineCost machine_cost(const pipeline::Figures& figures);

}  // namespace quadrille::studies
