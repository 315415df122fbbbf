/// What each operation means for one lane, in plain scalar C++: the ruler that the vector kernels are held
/// against. Written from docs/isa.md.
#pragma once

#include "models/shader/isa.h"

#include <cstdint>

namespace quadrille::models::test {

/// Whether `scalar_result` knows the operation (it does not know interface, control and quad operations).
[[nodiscard]] bool has_scalar_model(Op op);

/// Whether the result is a float, so that any NaN equals any NaN.
[[nodiscard]] bool has_float_result(Op op);

/// The result on operands whose modifiers have been applied, before saturation. Transcendental functions are
/// computed in double and rounded.
[[nodiscard]] std::uint32_t scalar_result(Op op, std::uint32_t a, std::uint32_t b, std::uint32_t c);

/// Allowed difference in units in the last place (0: exact).
[[nodiscard]] int allowed_ulps(Op op);

[[nodiscard]] std::uint32_t scalar_modified(std::uint32_t bits, std::uint8_t modifiers);
[[nodiscard]] std::uint32_t scalar_saturated(std::uint32_t bits);

/// Distance in representable values; 0 for two NaNs and for the two zeros, huge for a NaN and a number.
[[nodiscard]] std::int64_t ulps_between(std::uint32_t a, std::uint32_t b);

}  // namespace quadrille::models::test
