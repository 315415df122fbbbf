/// Accuracy of the transcendental functions against double precision, in units in the last place, over dense
/// samples.
#include "models/shader/vector_math.h"
#include "tests/models/shader/scalar_model.h"
#include "tests/models/shader/warp_fixture.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace quadrille::models::test {
namespace {

using Function = Floats (*)(Floats);
using Exact = double (*)(double);

std::array<float, kGroupLanes> evaluate(Function function, const std::array<float, kGroupLanes>& x) {
  std::array<float, kGroupLanes> y;
  store(y.data(), function(load_floats(x.data())));
  return y;
}

/// Error in units of the last place of the exact result, which is not rounded first; denormal results count
/// in units of the smallest denormal.
double error_ulps(float got, double exact) {
  if (static_cast<float>(exact) == got) return std::fabs(got - exact) == 0 || std::isinf(got) ? 0 : 0.5;
  const int exponent = std::max(std::ilogb(exact), -126);
  return std::fabs(static_cast<double>(got) - exact) / std::ldexp(1.0, exponent - 23);
}

/// The largest error over every `stride`-th float whose bits lie in [first, last].
double worst_error(Function function, Exact exact, float first, float last, std::uint32_t stride) {
  double worst = 0;
  const std::uint32_t end = bits_of(last);
  for (std::uint32_t bits = bits_of(first); bits + kGroupLanes * stride <= end;
       bits += kGroupLanes * stride) {
    std::array<float, kGroupLanes> x;
    for (std::uint32_t i = 0; i < kGroupLanes; ++i) x[i] = as_float(bits + i * stride);
    const auto y = evaluate(function, x);
    for (std::size_t i = 0; i < x.size(); ++i)
      worst = std::max(worst, error_ulps(y[i], exact(static_cast<double>(x[i]))));
  }
  return worst;
}

float one(Function function, float x) { return evaluate(function, {x, x, x, x, x, x, x, x})[5]; }

double log2_of(double x) { return std::log2(x); }
double exp2_of(double x) { return std::exp2(x); }
double sin_of(double x) { return std::sin(x); }
double cos_of(double x) { return std::cos(x); }
constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

TEST_CASE("vector math: exp2 is within 1 ULP from denormal results to overflow") {
  CHECK(worst_error(exp2, exp2_of, 1e-10f, 127.99999f, 67) <= 1.0);
  CHECK(worst_error(exp2, exp2_of, -1e-10f, -126.0f, 67) <= 1.0);
  CHECK(worst_error(exp2, exp2_of, -126.0f, -149.0f, 3) <= 1.0);
  CHECK(one(exp2, 0.0f) == 1.0f);
  CHECK(one(exp2, 128.0f) == kInfinity);
  CHECK(one(exp2, kInfinity) == kInfinity);
  CHECK(one(exp2, -kInfinity) == 0.0f);
  CHECK(one(exp2, -151.0f) == 0.0f);
  CHECK(std::isnan(one(exp2, NAN)));
  for (int n = -149; n < 128; ++n) CHECK(one(exp2, static_cast<float>(n)) == std::ldexp(1.0f, n));
}

TEST_CASE("vector math: log2 is within 1 ULP over all positive floats, also close to 1") {
  CHECK(worst_error(log2, log2_of, as_float(1), as_float(0x7f7fffff), 157) <= 1.0);
  CHECK(worst_error(log2, log2_of, 0.99f, 1.01f, 1) <= 1.0);
  CHECK(worst_error(log2, log2_of, 0.7f, 1.5f, 5) <= 1.0);
  CHECK(one(log2, 1.0f) == 0.0f);
  CHECK(one(log2, 0.0f) == -kInfinity);
  CHECK(one(log2, -0.0f) == -kInfinity);
  CHECK(one(log2, kInfinity) == kInfinity);
  CHECK(std::isnan(one(log2, -1.0f)));
  CHECK(std::isnan(one(log2, -kInfinity)));
  CHECK(std::isnan(one(log2, NAN)));
  for (int n = -149; n < 128; ++n) CHECK(one(log2, std::ldexp(1.0f, n)) == static_cast<float>(n));
}

TEST_CASE("vector math: sin and cos are within 2 ULP far beyond one turn") {
  for (const float sign : {1.0f, -1.0f}) {
    CHECK(worst_error(sin, sin_of, sign * 1e-30f, sign * 1e-3f, 4001) <= 2.0);
    CHECK(worst_error(sin, sin_of, sign * 1e-3f, sign * 10.0f, 61) <= 2.0);
    CHECK(worst_error(sin, sin_of, sign * 10.0f, sign * 1e9f, 211) <= 2.0);
    CHECK(worst_error(cos, cos_of, sign * 1e-30f, sign * 1e-3f, 4001) <= 2.0);
    CHECK(worst_error(cos, cos_of, sign * 1e-3f, sign * 10.0f, 61) <= 2.0);
    CHECK(worst_error(cos, cos_of, sign * 10.0f, sign * 1e9f, 211) <= 2.0);
  }
  for (int k = 1; k < 2000; ++k) {  // close to their zeros
    const auto x = static_cast<float>(k * std::numbers::pi / 2);
    CHECK(error_ulps(one(sin, x), std::sin(static_cast<double>(x))) <= 2.0);
    CHECK(error_ulps(one(cos, x), std::cos(static_cast<double>(x))) <= 2.0);
  }
}

TEST_CASE("vector math: sin and cos of huge, infinite and denormal arguments are defined") {
  CHECK(one(sin, 0x1p40f) == 0.0f);
  CHECK(one(cos, 3e38f) == 1.0f);
  CHECK(bits_of(one(sin, -0.0f)) == 0x80000000u);
  CHECK(one(sin, as_float(1)) == as_float(1));
  CHECK(one(cos, as_float(0x80000001u)) == 1.0f);
  for (const float x : {kInfinity, -kInfinity, NAN}) {
    CHECK(std::isnan(one(sin, x)));
    CHECK(std::isnan(one(cos, x)));
  }
}

}  // namespace quadrille::models::test
