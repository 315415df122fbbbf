/// Register allocation: virtual registers to the few that a lane has, by colouring their interference.
#pragma once

#include "pipeline/compiler/ir.h"

namespace quadrille::pipeline {

struct Allocation {
  std::vector<std::uint16_t> physical;  ///< by virtual register; unused ones are 0
  int num_regs = 0;                     ///< may exceed kMaxRegisters: the caller decides
};

/// Every lane has its own registers and writes are masked, so two values conflict exactly if both are live at
/// one place on the way of a single lane. Copies get one register for both sides where they do not conflict;
/// a texture's four results get consecutive ones, and those that nobody reads stay reserved until the first
/// one that is read, because they are written late.
[[nodiscard]] Allocation allocate_registers(const std::vector<ScalarInstruction>& code,
                                            std::size_t registers);

}  // namespace quadrille::pipeline
