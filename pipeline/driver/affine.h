/// Affine arithmetic: bounds of a number that keep how it depends on the inputs.
///
/// A form is centre + term[0] s0 + term[1] s1 + ... + rest s, where each symbol is some number from -1 to 1.
/// The numbered symbols are inputs, the same in every form; the last one is the form's own. So x + w of two
/// forms is bounded tightly where both are linear in the same inputs, as the coordinates of a position are.
/// What float32 arithmetic rounds off goes to the rest: each operation here holds every value that the
/// machine's can have.
#pragma once

#include <array>
#include <cstddef>

namespace quadrille::pipeline {

struct Affine {
  static constexpr std::size_t kInputs = 16;
  bool bounded = false;  ///< else it may be any float, NaN among them
  double centre = 0;
  std::array<double, kInputs> term{};
  double rest = 0;  ///< not negative

  [[nodiscard]] double radius() const;
  [[nodiscard]] double low() const { return centre - radius(); }
  [[nodiscard]] double high() const { return centre + radius(); }
};

[[nodiscard]] Affine affine_number(float value);  ///< not bounded if it is not finite
[[nodiscard]] Affine affine_between(double low, double high);
/// Input number `input` between two numbers; behind the last one it is a number of its own.
[[nodiscard]] Affine affine_input(std::size_t input, double low, double high);

[[nodiscard]] Affine operator-(const Affine& a);
/// As float32 operations round. The result is not bounded if it may overflow.
[[nodiscard]] Affine operator+(const Affine& a, const Affine& b);
[[nodiscard]] Affine operator*(const Affine& a, const Affine& b);
[[nodiscard]] Affine absolute(const Affine& a);
[[nodiscard]] Affine least(const Affine& a, const Affine& b);
[[nodiscard]] Affine greatest(const Affine& a, const Affine& b);
/// Limited to 0 to 1; what is not bounded is then, since NaN becomes 0.
[[nodiscard]] Affine saturated(const Affine& a);
/// Holds what either holds.
[[nodiscard]] Affine either(const Affine& a, const Affine& b);

/// Greatest value of a + sign * b, exactly and not as float32.
[[nodiscard]] double greatest_sum(const Affine& a, const Affine& b, double sign);

}  // namespace quadrille::pipeline
