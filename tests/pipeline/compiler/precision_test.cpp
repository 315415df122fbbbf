/// Every float function of GLSL.std.450 over its domain, against double precision, within the bounds of
/// Vulkan. [VK1.3 #spirvenv-op-prec]
///
/// Vulkan bounds some functions by units in the last place and lets the others inherit what a formula of
/// bounded operations gives. `Bound` does the same: an interval of values that an implementation may return,
/// carried through the formula, each operation widening it by what that operation is allowed.
#include "tests/pipeline/compiler/shader_runner.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace quadrille::pipeline {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// A unit in the last place of a float of this size; denormals may be flushed, so it is no less than the
/// smallest normal's.
double ulp(double value) {
  const double size = std::max(std::abs(value), 0x1p-126);
  return std::exp2(std::floor(std::log2(size)) - 23);
}

/// The values that an implementation may return.
struct Bound {
  double low = 0, high = 0;
  Bound(double exact) : low(exact), high(exact) {}  // NOLINT(google-explicit-constructor): inputs are exact
  Bound(double a, double b) : low(std::min(a, b)), high(std::max(a, b)) {}
  [[nodiscard]] Bound widened(double ulps) const { return {low - ulps * ulp(low), high + ulps * ulp(high)}; }
  [[nodiscard]] Bound widened_by(double error) const { return {low - error, high + error}; }
  /// A result that underflows may be flushed to zero.
  [[nodiscard]] Bound flushed() const {
    Bound result = *this;
    if (low > 0 && low < 0x1p-126) result.low = 0;
    if (high < 0 && high > -0x1p-126) result.high = 0;
    return result;
  }
};

template <class F>
Bound corners(Bound a, Bound b, F f) {
  const double v[] = {f(a.low, b.low), f(a.low, b.high), f(a.high, b.low), f(a.high, b.high)};
  return {*std::ranges::min_element(v), *std::ranges::max_element(v)};
}

// Correctly rounded: within half a unit of the exact result, or one where a host rounds the other way.
Bound operator+(Bound a, Bound b) { return Bound(a.low + b.low, a.high + b.high).widened(0.5); }
Bound operator-(Bound a, Bound b) { return Bound(a.low - b.high, a.high - b.low).widened(0.5); }
Bound operator*(Bound a, Bound b) { return corners(a, b, std::multiplies<>()).widened(0.5).flushed(); }
Bound operator/(Bound a, Bound b) { return corners(a, b, std::divides<>()).widened(2.5).flushed(); }

Bound exp2(Bound x) {
  const double most = std::max(std::abs(x.low), std::abs(x.high));
  return Bound(std::exp2(x.low), std::exp2(x.high)).widened(3 + 2 * most).flushed();
}
Bound exp(Bound x) {
  const double most = std::max(std::abs(x.low), std::abs(x.high));
  return Bound(std::exp(x.low), std::exp(x.high)).widened(3 + 2 * most).flushed();
}
Bound bounded_log(Bound x, double (*log)(double)) {
  const Bound exact(log(std::max(x.low, 0.0)), log(x.high));
  return x.low >= 0.5 && x.high <= 2.0 ? exact.widened_by(0x1p-21)
         : x.high < 0.5 || x.low > 2.0 ? exact.widened(3)
                                       : exact.widened(3).widened_by(0x1p-21);
}
Bound log2(Bound x) { return bounded_log(x, std::log2); }
Bound log(Bound x) { return bounded_log(x, std::log); }
Bound inverse_sqrt(Bound x) {
  return Bound(1 / std::sqrt(std::max(x.high, 0.0)), 1 / std::sqrt(std::max(x.low, 0.0))).widened(2);
}
Bound sqrt(Bound x) {
  if (x.high <= 0) return {0.0};
  const Bound result =
      Bound(1.0) / Bound(inverse_sqrt({x.high, x.high}).low, inverse_sqrt({x.high, x.high}).high);
  if (x.low <= 0) return {0.0, result.high};
  return {(Bound(1.0) / inverse_sqrt({x.low, x.low})).low, result.high};
}
/// Both are bounded in [-pi, pi] only.
Bound sin(Bound x) { return Bound(std::sin(x.low), std::sin(x.high)).widened_by(0x1p-11); }
Bound cos(Bound x) { return Bound(std::cos(x.low), std::cos(x.high)).widened_by(0x1p-11); }
Bound atan(Bound x) { return Bound(std::atan(x.low), std::atan(x.high)).widened(4096); }
Bound atan2(Bound y, Bound x) {
  return corners(y, x, [](double a, double b) { return std::atan2(a, b); }).widened(4096);
}
Bound fma(Bound a, Bound b, Bound c) { return a * b + c; }
Bound pow(Bound x, Bound y) { return exp2(y * log2(x)); }
Bound dot(std::initializer_list<std::pair<Bound, Bound>> products) {
  Bound sum(0.0);
  for (const auto& [a, b] : products) sum = sum + a * b;
  return sum;
}

using Function = std::function<Bound(double x, double y, double z)>;

/// Inputs between two values: evenly, or evenly in the exponent.
struct Range {
  float low, high;
  bool exponential = false;
  [[nodiscard]] float at(double t) const {
    const double a = static_cast<double>(low), b = static_cast<double>(high);
    return static_cast<float>(
        exponential ? std::copysign(std::exp2(std::log2(std::abs(a)) +
                                              t * (std::log2(std::abs(b)) - std::log2(std::abs(a)))),
                                    a)
                    : a + t * (b - a));
  }
};

constexpr int kSamples = 8192;

/// Both results of the functions that have two.
const char* const kHelpers = R"(vec4 frexpSignificand(vec4 v) { ivec4 e; return frexp(v, e); }
ivec4 frexpExponent(vec4 v) { ivec4 e; vec4 s = frexp(v, e); return e; }
vec4 modfSum(vec4 v) { vec4 whole; vec4 part = modf(v, whole); return whole + part; })";

/// Runs `expression`, of vec4 a, b and c, over the ranges of their components and holds every result within
/// its bound.
void hold(const std::string& expression, const Function& bound, Range xs, Range ys = {0, 1},
          Range zs = {0, 1}) {
  INFO(expression);
  const std::string body = "vec4 c = intBitsToFloat(i); color = " + expression + ";";
  // so that a, b and i come in that order
  const std::string keep = "if (a.x == 1e30) { color = a + b + vec4(i); return; }\n";
  const models::Program program = compile_fragment(fragment_source(keep + body, kHelpers));
  int outside = 0;
  double worst = 0;
  float worst_x = 0, worst_got = 0;
  for (int first = 0; first < kSamples; first += 4 * models::kWarpQuads) {
    RunInput input;
    for (int k = 0; k < 4 * models::kWarpQuads; ++k) {
      Point& p = input.points[static_cast<std::size_t>(k / 4)];
      const auto c = static_cast<std::size_t>(k % 4);
      const int n = first + k;  // the others at strides that do not repeat
      p.a[c] = xs.at(n / (kSamples - 1.0));
      p.b[c] = ys.at(std::fmod(n * 0.61803398875, 1.0));
      p.i[c] = std::bit_cast<std::int32_t>(zs.at(std::fmod(n * 0.41421356237, 1.0)));
    }
    const RunOutput out = run_fragment(program, input);
    for (int k = 0; k < 4 * models::kWarpQuads; ++k) {
      const Point& p = input.points[static_cast<std::size_t>(k / 4)];
      const auto c = static_cast<std::size_t>(k % 4);
      const float got = out.point(k / 4)[c];
      const Bound allowed = bound(static_cast<double>(p.a[c]), static_cast<double>(p.b[c]),
                                  static_cast<double>(std::bit_cast<float>(p.i[c])));
      const double value = static_cast<double>(got),
                   over = std::max(allowed.low - value, value - allowed.high);
      if (over <= 0) continue;
      ++outside;
      if (!(over <= worst)) worst = over, worst_x = p.a[c], worst_got = got;
    }
  }
  INFO(outside << " of " << kSamples << " outside; the worst at x = " << worst_x << ", which gives "
               << worst_got << ", by " << worst);
  CHECK(outside == 0);
}

/// The same for a function of one vector of three components, whose result is a scalar or a vector.
using VectorFunction = std::function<std::array<Bound, 3>(std::array<double, 3> a, std::array<double, 3> b)>;
void hold_vectors(const std::string& expression, const VectorFunction& bound) {
  INFO(expression);
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    RunInput input;
    input.points = assorted_points(seed);
    const RunOutput out = run_snippet("color = vec4(" + expression + ", 0);", input);
    for (int k = 0; k < models::kWarpQuads; ++k) {
      const Point& p = input.points[static_cast<std::size_t>(k)];
      std::array<double, 3> a{}, b{};
      for (std::size_t c = 0; c < 3; ++c)
        a[c] = static_cast<double>(p.a[c]), b[c] = static_cast<double>(p.b[c]);
      const std::array<Bound, 3> allowed = bound(a, b);
      for (std::size_t c = 0; c < 3; ++c) {
        const double got = static_cast<double>(out.point(k)[c]);
        CHECK((got >= allowed[c].low && got <= allowed[c].high));
      }
    }
  }
}

constexpr Range kUnit{-1, 1}, kSmall{1e-30f, 1, true}, kSmallNegative{-1e-30f, -1, true},
    kTurn{-3.14159274f, 3.14159274f};
constexpr Range kWide{-1e6f, 1e6f}, kPositive{1e-30f, 1e30f, true}, kNegative{-1e-30f, -1e30f, true};

Bound asin_bound(double x) { return atan2(x, sqrt(Bound(1.0) - Bound(x) * x)); }
Bound acos_bound(double x) { return atan2(sqrt(Bound(1.0) - Bound(x) * x), x); }
Bound sinh_bound(double x) { return (exp(x) - exp(-x)) * 0.5; }
Bound cosh_bound(double x) { return (exp(x) + exp(-x)) * 0.5; }

}  // namespace

TEST_CASE("precision: arc sine and arc cosine inherit from atan2") {
  for (const Range range : {kUnit, kSmall, kSmallNegative}) {
    hold(
        "asin(a)", [](double x, double, double) { return asin_bound(x); }, range);
    hold(
        "acos(a)", [](double x, double, double) { return acos_bound(x); }, range);
  }
}

TEST_CASE("precision: an arc sine fed back ten times keeps its place") {
  RunInput input;
  for (Point& p : input.points) p.a = {0.25f, -0.25f, 0.01f, 0.45f};
  const RunOutput out =
      run_snippet("vec4 x = a; for (int k = 0; k < 10; ++k) x = asin(x); color = x;", input);
  for (std::size_t c = 0; c < 4; ++c) {
    double want = static_cast<double>(input.points[0].a[c]);
    for (int k = 0; k < 10; ++k) want = std::asin(want);
    CHECK(static_cast<double>(out.point(0)[c]) == Approx(want).epsilon(1e-5));
  }
}

TEST_CASE("precision: arc tangents") {
  for (const Range range : {kWide, kPositive, kNegative, Range{-4, 4}}) {
    hold(
        "atan(a)", [](double x, double, double) { return atan(x); }, range);
    hold("atan(a, b)", [](double y, double x, double) { return atan2(y, x); }, range, {0.001f, 100, true});
    hold("atan(a, b)", [](double y, double x, double) { return atan2(y, x); }, range, {-100, -0.001f, true});
  }
}

TEST_CASE("precision: sine, cosine and tangent") {
  hold(
      "sin(a)", [](double x, double, double) { return sin(x); }, kTurn);
  hold(
      "cos(a)", [](double x, double, double) { return cos(x); }, kTurn);
  hold("tan(a)", [](double x, double, double) { return sin(x) / cos(x); }, {-1.5f, 1.5f});
}

TEST_CASE("precision: exponentials and logarithms") {
  const Range exponents{-80, 80};
  hold(
      "exp(a)", [](double x, double, double) { return exp(x); }, exponents);
  hold("exp2(a)", [](double x, double, double) { return exp2(x); }, {-120, 120});
  for (const Range range : {kPositive, Range{0.5f, 2}, Range{0.9f, 1.1f}}) {
    hold(
        "log(a)", [](double x, double, double) { return log(x); }, range);
    hold(
        "log2(a)", [](double x, double, double) { return log2(x); }, range);
  }
  hold("pow(a, b)", [](double x, double y, double) { return pow(x, y); }, {1e-4f, 1e4f, true}, {-6, 6});
  hold("pow(a, vec4(5.0))", [](double x, double, double) { return pow(x, 5.0); }, {1e-4f, 1e4f, true});
  hold("pow(a, vec4(2.0))", [](double x, double, double) { return pow(x, 2.0); }, {1e-4f, 1e4f, true});
}

TEST_CASE("precision: roots") {
  hold(
      "sqrt(a)", [](double x, double, double) { return sqrt(x); }, kPositive);
  hold(
      "inversesqrt(a)", [](double x, double, double) { return inverse_sqrt(x); }, kPositive);
}

TEST_CASE("precision: hyperbolic functions inherit from exp and log") {
  for (const Range range : {Range{-20, 20}, Range{-1, 1}, kSmall}) {
    hold(
        "sinh(a)", [](double x, double, double) { return sinh_bound(x); }, range);
    hold(
        "cosh(a)", [](double x, double, double) { return cosh_bound(x); }, range);
    hold(
        "tanh(a)", [](double x, double, double) { return sinh_bound(x) / cosh_bound(x); }, range);
    hold("asinh(a)", [](double x, double, double) { return log(x + sqrt(Bound(x) * x + 1.0)); },
         {range.low, range.high, range.exponential});
  }
  hold("acosh(a)", [](double x, double, double) { return log(x + sqrt(Bound(x) * x - 1.0)); },
       {1.01f, 1e6f, true});
  hold("atanh(a)", [](double x, double, double) { return log((Bound(1.0) + x) / (Bound(1.0) - x)) * 0.5; },
       {-0.999f, 0.999f});
}

TEST_CASE("precision: what is rounded correctly or exact") {
  const auto exactly = [](double (*f)(double)) {
    return [f](double x, double, double) { return Bound(f(x)); };
  };
  for (const Range range : {Range{-10, 10}, kWide, kSmall, kSmallNegative}) {
    hold("abs(a)", exactly(std::fabs), range);
    hold("floor(a)", exactly(std::floor), range);
    hold("ceil(a)", exactly(std::ceil), range);
    hold("trunc(a)", exactly(std::trunc), range);
    hold("roundEven(a)", exactly(std::nearbyint), range);
    hold("round(a)", exactly(std::nearbyint), range);
    hold("sign(a)", exactly([](double x) { return x > 0 ? 1.0 : x < 0 ? -1.0 : 0.0; }), range);
    hold(
        "fract(a)", [](double x, double, double) { return Bound(x) - std::floor(x); }, range);
    hold("min(a, b)", [](double x, double y, double) { return Bound(std::min(x, y)); }, range, {-10, 10});
    hold("max(a, b)", [](double x, double y, double) { return Bound(std::max(x, y)); }, range, {-10, 10});
    hold("step(a, b)", [](double x, double y, double) { return Bound(y < x ? 0.0 : 1.0); }, range, {-10, 10});
    hold("clamp(a, b, c)", [](double x, double y, double z) { return Bound(std::min(std::max(x, y), z)); },
         range, {-10, 0}, {0, 10});
    hold("fma(a, b, c)", [](double x, double y, double z) { return fma(x, y, z); }, range, {-10, 10},
         {-10, 10});
    hold("a / b", [](double x, double y, double) { return Bound(x) / y; }, range, {0.001f, 1000, true});
    hold("mod(a, b)",
         [](double x, double y, double) {  // x - y floor(x / y), whichever way the quotient is rounded
           const Bound quotient = Bound(x) / y;
           const Bound low = Bound(x) - Bound(y) * std::floor(quotient.low),
                       high = Bound(x) - Bound(y) * std::floor(quotient.high);
           return Bound(std::min(low.low, high.low), std::max(low.high, high.high));
         },
         {-1000, 1000}, {0.5f, 8});
    hold(
        "radians(a)", [](double x, double, double) { return Bound(x) * Bound(kPi / 180).widened(0.5); },
        range);
    hold(
        "degrees(a)", [](double x, double, double) { return Bound(x) * Bound(180 / kPi).widened(0.5); },
        range);
    hold("mix(a, b, c)",
         [](double x, double y, double z) { return Bound(x) * (Bound(1.0) - z) + Bound(y) * z; }, range,
         {-10, 10}, {0, 1});
    hold("smoothstep(b, c, a)",
         [](double x, double y, double z) {
           const Bound t = (Bound(x) - y) / (Bound(z) - y);
           const Bound held(std::clamp(t.low, 0.0, 1.0), std::clamp(t.high, 0.0, 1.0));
           return held * held * (Bound(3.0) - Bound(2.0) * held);
         },
         range, {-10, -1}, {1, 10});
  }
  hold("ldexp(a, ivec4(i.x & 15) - 8)",
       [](double x, double, double z) {
         return Bound(
             std::ldexp(x, static_cast<int>(std::bit_cast<std::uint32_t>(static_cast<float>(z)) & 15u) - 8));
       },
       {-8, 8}, {0, 1}, {0.75f, 0.75f});
  hold("ldexp(frexpSignificand(a), frexpExponent(a))", exactly([](double x) { return x; }),
       {1e-30f, 1e30f, true});
  hold("modfSum(a)", exactly([](double x) { return x; }), {-100, 100});
}

TEST_CASE("precision: geometric functions inherit from their formulas") {
  using V = std::array<double, 3>;
  const auto length_of = [](V v) { return sqrt(dot({{v[0], v[0]}, {v[1], v[1]}, {v[2], v[2]}})); };
  hold_vectors("vec3(length(a.xyz), distance(a.xyz, b.xyz), dot(a.xyz, b.xyz))",
               [&](V a, V b) -> std::array<Bound, 3> {
                 const std::array<Bound, 3> d{Bound(a[0]) - b[0], Bound(a[1]) - b[1], Bound(a[2]) - b[2]};
                 return {length_of(a), sqrt(dot({{d[0], d[0]}, {d[1], d[1]}, {d[2], d[2]}})),
                         dot({{a[0], b[0]}, {a[1], b[1]}, {a[2], b[2]}})};
               });
  hold_vectors("normalize(a.xyz)", [](V a, V) -> std::array<Bound, 3> {
    const Bound scale = inverse_sqrt(dot({{a[0], a[0]}, {a[1], a[1]}, {a[2], a[2]}}));
    return {Bound(a[0]) * scale, Bound(a[1]) * scale, Bound(a[2]) * scale};
  });
  hold_vectors("cross(a.xyz, b.xyz)", [](V a, V b) -> std::array<Bound, 3> {
    const auto part = [&](std::size_t n, std::size_t m) { return Bound(a[n]) * b[m] - Bound(a[m]) * b[n]; };
    return {part(1, 2), part(2, 0), part(0, 1)};
  });
  hold_vectors("reflect(a.xyz, b.xyz)", [](V a, V b) -> std::array<Bound, 3> {
    const Bound twice = dot({{a[0], b[0]}, {a[1], b[1]}, {a[2], b[2]}}) * 2.0;
    return {Bound(a[0]) - twice * b[0], Bound(a[1]) - twice * b[1], Bound(a[2]) - twice * b[2]};
  });
  hold_vectors("faceforward(a.xyz, b.xyz, a.zxy)", [](V a, V b) -> std::array<Bound, 3> {
    const double facing = a[2] * b[0] + a[0] * b[1] + a[1] * b[2];
    const double sign = facing < 0 ? 1 : -1;
    if (std::abs(facing) < 1e-5) return {Bound(-4.0, 4.0), Bound(-4.0, 4.0), Bound(-4.0, 4.0)};
    return {Bound(sign * a[0]), Bound(sign * a[1]), Bound(sign * a[2])};
  });
  hold_vectors("refract(normalize(a.xyz), vec3(0, 1, 0), 0.5)", [](V a, V) -> std::array<Bound, 3> {
    const Bound scale = inverse_sqrt(dot({{a[0], a[0]}, {a[1], a[1]}, {a[2], a[2]}}));
    const std::array<Bound, 3> in{Bound(a[0]) * scale, Bound(a[1]) * scale, Bound(a[2]) * scale};
    const Bound k = Bound(1.0) - Bound(0.5) * 0.5 * (Bound(1.0) - in[1] * in[1]);
    const Bound along = in[1] * 0.5 + sqrt(k);
    return {in[0] * 0.5, in[1] * 0.5 - along, in[2] * 0.5};
  });
}

}  // namespace quadrille::pipeline
