/// What the compiler knows of the machine that it compiles for: how many warps a core holds with a program's
/// registers, and when results can be read. Pictures do not depend on it.
#pragma once

#include "models/shader/timing.h"

#include <algorithm>

namespace quadrille::pipeline {

/// The defaults are those of the default machine's core.
struct ShaderTarget {
  int warp_slots = 32;
  int register_rows = 1024;
  models::IssueTiming timing{{{{4, 8}, {16, 20}, {4, 12}, {4, 12}, {4, 8}, {1, 4}, {4, 8}, {4, 8}}}};

  /// Warps of a program with that many registers that a core holds.
  [[nodiscard]] int warps(int registers) const {
    return std::min(warp_slots, register_rows / std::max(registers, 1));
  }
  /// The most registers with which a core holds that many warps.
  [[nodiscard]] int most_registers(int warps) const {
    return std::min(register_rows / std::max(warps, 1), models::kMaxRegisters);
  }
};

}  // namespace quadrille::pipeline
