/// Bounds of the positions that a vertex program writes, from bounds of what it reads.
///
/// Only the instructions that the position depends on are looked at, with affine forms in place of numbers.
/// What a form cannot say (textures, buffers, special functions, results of loops) may be anything from then
/// on. The sides of a branch are both looked at, unless all lanes take the same one.
#pragma once

#include "models/shader/isa.h"
#include "pipeline/driver/affine.h"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

namespace quadrille::pipeline {

struct InputBounds {
  float low = 0, high = 0;
};

/// What a draw gives to its vertex program.
struct ProgramInputs {
  std::span<const std::uint32_t> constants;
  /// Bounds of a row of the program's vertex inputs; none if they are integers, or some of them are not
  /// finite. It is asked only for rows that the position depends on.
  std::function<std::optional<InputBounds>(std::size_t row)> bounds;
  std::optional<std::uint32_t> instance;  ///< if there is one alone
};

/// x, y, z and w. A coordinate that is not bounded may be anything.
[[nodiscard]] std::array<Affine, 4> position_bounds(const models::Program& program,
                                                    const ProgramInputs& inputs);

}  // namespace quadrille::pipeline
