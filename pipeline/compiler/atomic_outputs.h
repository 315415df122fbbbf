/// Which programs' outputs depend on the order of warps: those that something an atomic operation returned
/// reaches. Timing may change what such a program draws.
#pragma once

#include "pipeline/compiler/ir.h"

namespace quadrille::pipeline {

/// Does a value that an atomic operation returned reach an output or a discard, by values, by control flow or
/// through memory that the program reads again?
[[nodiscard]] bool outputs_follow_atomics(const ScalarShader& shader);

}  // namespace quadrille::pipeline
