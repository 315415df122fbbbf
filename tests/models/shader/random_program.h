/// Random programs that keep all rules of the ISA: nested control flow that ends, textures, derivatives,
/// indexed constants.
#pragma once

#include "models/shader/isa.h"

#include <random>

namespace quadrille::models::test {

struct RandomProgramOptions {
  int statements = 60;
  bool quad_operations = true;  ///< derivatives and implicit level of detail
  bool control_flow = true;
};

/// A fragment program; it writes all colour components and depth at its end.
[[nodiscard]] Program random_program(std::mt19937& random, const RandomProgramOptions& options);

}  // namespace quadrille::models::test
