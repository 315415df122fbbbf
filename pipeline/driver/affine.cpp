/// Operations on affine forms, and what they lose by rounding.
#include "pipeline/driver/affine.h"

#include <algorithm>
#include <cmath>

namespace quadrille::pipeline {
namespace {

/// More than a float32 operation rounds off: half of its last place is a 2^-24th, or 2^-150 among denormals.
constexpr double kFloatRounding = 0x1p-23, kLeastRounding = 0x1p-140;
/// More than the sums of a form lose in double, of the magnitudes that go in.
constexpr double kDoubleRounding = 0x1p-45;
/// A float32 result is finite below this.
constexpr double kFinite = 0x1p127;

double magnitude(const Affine& a) { return std::abs(a.centre) + a.radius(); }

/// A form with what was lost on the way to it, given the magnitudes that went in.
Affine widened(Affine a, double went_in, double rounding) {
  a.rest += went_in * kDoubleRounding + magnitude(a) * rounding + kLeastRounding;
  // Not a comparison that a NaN would pass.
  a.bounded = magnitude(a) < kFinite;
  return a;
}

template <class Combine>
Affine combined(const Affine& a, const Affine& b, const Combine& combine) {
  Affine sum;
  sum.centre = combine(a.centre, b.centre);
  for (std::size_t i = 0; i < Affine::kInputs; ++i) sum.term[i] = combine(a.term[i], b.term[i]);
  sum.rest = a.rest + b.rest;
  return sum;
}

}  // namespace

double Affine::radius() const {
  double sum = rest;
  for (const double t : term) sum += std::abs(t);
  return sum;
}

Affine affine_number(float value) {
  Affine a;
  a.bounded = std::isfinite(value);
  a.centre = a.bounded ? static_cast<double>(value) : 0;
  return a;
}

Affine affine_between(double low, double high) {
  Affine a;
  a.centre = (low + high) / 2;
  a.rest = (high - low) / 2;
  return widened(a, std::abs(low) + std::abs(high), 0);
}

Affine affine_input(std::size_t input, double low, double high) {
  Affine a = affine_between(low, high);
  if (input < Affine::kInputs) std::swap(a.rest, a.term[input]);
  return a;
}

Affine operator-(const Affine& a) {
  Affine negated = a;
  negated.centre = -a.centre;
  for (double& t : negated.term) t = -t;
  return negated;
}

Affine operator+(const Affine& a, const Affine& b) {
  if (!a.bounded || !b.bounded) return {};
  return widened(combined(a, b, [](double x, double y) { return x + y; }), magnitude(a) + magnitude(b),
                 kFloatRounding);
}

Affine operator*(const Affine& a, const Affine& b) {
  if (!a.bounded || !b.bounded) return {};
  const double radius_a = a.radius(), radius_b = b.radius();
  Affine product;
  product.centre = a.centre * b.centre;
  for (std::size_t i = 0; i < Affine::kInputs; ++i)
    product.term[i] = a.centre * b.term[i] + b.centre * a.term[i];
  product.rest = std::abs(a.centre) * b.rest + std::abs(b.centre) * a.rest + radius_a * radius_b;
  return widened(product, magnitude(a) * magnitude(b), kFloatRounding);
}

Affine absolute(const Affine& a) {
  if (!a.bounded || a.low() >= 0) return a;
  return a.high() <= 0 ? -a : affine_between(0, magnitude(a));
}

Affine least(const Affine& a, const Affine& b) {
  if (!a.bounded || !b.bounded) return {};
  if (a.high() <= b.low()) return a;
  if (b.high() <= a.low()) return b;
  return affine_between(std::min(a.low(), b.low()), std::min(a.high(), b.high()));
}

Affine greatest(const Affine& a, const Affine& b) { return -least(-a, -b); }

Affine saturated(const Affine& a) {
  if (!a.bounded) return affine_between(0, 1);
  if (a.low() >= 0 && a.high() <= 1) return a;
  return affine_between(std::clamp(a.low(), 0.0, 1.0), std::clamp(a.high(), 0.0, 1.0));
}

Affine either(const Affine& a, const Affine& b) {
  if (!a.bounded || !b.bounded) return {};
  Affine mean = combined(a, b, [](double x, double y) { return (x + y) / 2; });
  mean.rest = std::max(a.rest, b.rest) + std::abs(a.centre - b.centre) / 2;
  for (std::size_t i = 0; i < Affine::kInputs; ++i) mean.rest += std::abs(a.term[i] - b.term[i]) / 2;
  return widened(mean, magnitude(a) + magnitude(b), 0);
}

double greatest_sum(const Affine& a, const Affine& b, double sign) {
  const Affine sum = combined(a, b, [sign](double x, double y) { return x + sign * y; });
  return widened(sum, magnitude(a) + magnitude(b), 0).high();
}

}  // namespace quadrille::pipeline
