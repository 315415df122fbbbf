/// Float operations of the interpreter, component by component, in doubles.
#include <spirv/unified1/GLSL.std.450.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <spirv/unified1/spirv.hpp>

#include "models/reference/handlers.h"

namespace quadrille::models::reference {
namespace {

using F1 = double (*)(double);
using F2 = double (*)(double, double);
using F3 = double (*)(double, double, double);
using Test1 = bool (*)(double);
using Test2 = bool (*)(double, double);

const Cell& operand(const Operation& o, Lanes& lanes, std::size_t which, std::uint32_t i) {
  return lanes.cells[o.src[which] + i * o.step[which]];
}

template <F1 kFunction>
void each1(const Operation& o, Lanes& lanes) {
  for (std::uint32_t i = 0; i < o.n; ++i) {
    Cell r;
    for (int l = 0; l < kLanes; ++l) r.set_f(l, kFunction(operand(o, lanes, 0, i).f(l)));
    write(lanes, lanes.cells[o.dst + i], r);
  }
}

template <F2 kFunction>
void each2(const Operation& o, Lanes& lanes) {
  for (std::uint32_t i = 0; i < o.n; ++i) {
    const Cell& a = operand(o, lanes, 0, i);
    const Cell& b = operand(o, lanes, 1, i);
    Cell r;
    for (int l = 0; l < kLanes; ++l) r.set_f(l, kFunction(a.f(l), b.f(l)));
    write(lanes, lanes.cells[o.dst + i], r);
  }
}

template <F3 kFunction>
void each3(const Operation& o, Lanes& lanes) {
  for (std::uint32_t i = 0; i < o.n; ++i) {
    Cell r;
    for (int l = 0; l < kLanes; ++l)
      r.set_f(l, kFunction(operand(o, lanes, 0, i).f(l), operand(o, lanes, 1, i).f(l),
                           operand(o, lanes, 2, i).f(l)));
    write(lanes, lanes.cells[o.dst + i], r);
  }
}

template <Test1 kTest>
void test1(const Operation& o, Lanes& lanes) {
  for (std::uint32_t i = 0; i < o.n; ++i) {
    Cell r;
    for (int l = 0; l < kLanes; ++l) r.set_u(l, kTest(operand(o, lanes, 0, i).f(l)) ? 1u : 0u);
    write(lanes, lanes.cells[o.dst + i], r);
  }
}

template <Test2 kTest>
void test2(const Operation& o, Lanes& lanes) {
  for (std::uint32_t i = 0; i < o.n; ++i) {
    Cell r;
    for (int l = 0; l < kLanes; ++l)
      r.set_u(l, kTest(operand(o, lanes, 0, i).f(l), operand(o, lanes, 1, i).f(l)) ? 1u : 0u);
    write(lanes, lanes.cells[o.dst + i], r);
  }
}

double add(double a, double b) { return a + b; }
double sub(double a, double b) { return a - b; }
double mul(double a, double b) { return a * b; }
double div(double a, double b) { return a / b; }
double rem(double a, double b) { return std::fmod(a, b); }
double mod(double a, double b) { return a - b * std::floor(a / b); }
double neg(double a) { return -a; }
bool is_nan(double a) { return std::isnan(a); }
bool is_inf(double a) { return std::isinf(a); }
bool eq(double a, double b) { return a == b; }
bool ne(double a, double b) { return a < b || a > b; }
bool lt(double a, double b) { return a < b; }
bool le(double a, double b) { return a <= b; }
bool gt(double a, double b) { return a > b; }
bool ge(double a, double b) { return a >= b; }
bool unordered_eq(double a, double b) { return !ne(a, b); }
bool unordered_ne(double a, double b) { return !(a == b); }
bool unordered_lt(double a, double b) { return !(a >= b); }
bool unordered_le(double a, double b) { return !(a > b); }
bool unordered_gt(double a, double b) { return !(a <= b); }
bool unordered_ge(double a, double b) { return !(a < b); }

double round_even(double a) { return std::nearbyint(a); }
double truncate(double a) { return std::trunc(a); }
double absolute(double a) { return std::abs(a); }
double sign(double a) { return a > 0 ? 1.0 : a < 0 ? -1.0 : a; }
double floor_of(double a) { return std::floor(a); }
double ceil_of(double a) { return std::ceil(a); }
double fract(double a) { return a - std::floor(a); }
double radians(double a) { return a * (std::numbers::pi / 180.0); }
double degrees(double a) { return a * (180.0 / std::numbers::pi); }
double sin_of(double a) { return std::sin(a); }
double cos_of(double a) { return std::cos(a); }
double tan_of(double a) { return std::tan(a); }
double asin_of(double a) { return std::asin(a); }
double acos_of(double a) { return std::acos(a); }
double atan_of(double a) { return std::atan(a); }
double sinh_of(double a) { return std::sinh(a); }
double cosh_of(double a) { return std::cosh(a); }
double tanh_of(double a) { return std::tanh(a); }
double asinh_of(double a) { return std::asinh(a); }
double acosh_of(double a) { return std::acosh(a); }
double atanh_of(double a) { return std::atanh(a); }
double exp_of(double a) { return std::exp(a); }
double log_of(double a) { return std::log(a); }
double exp2_of(double a) { return std::exp2(a); }
double log2_of(double a) { return std::log2(a); }
double sqrt_of(double a) { return std::sqrt(a); }
double inverse_sqrt(double a) { return 1.0 / std::sqrt(a); }
double atan2_of(double y, double x) { return std::atan2(y, x); }
double pow_of(double a, double b) { return std::pow(a, b); }
double min_of(double a, double b) { return b < a ? b : a; }
double max_of(double a, double b) { return a < b ? b : a; }
double nmin_of(double a, double b) { return std::fmin(a, b); }
double nmax_of(double a, double b) { return std::fmax(a, b); }
double step_at(double edge, double a) { return a < edge ? 0.0 : 1.0; }
double clamp_to(double a, double low, double high) { return min_of(max_of(a, low), high); }
double nclamp_to(double a, double low, double high) { return nmin_of(nmax_of(a, low), high); }
double mix(double a, double b, double t) { return a * (1.0 - t) + b * t; }
double fma_of(double a, double b, double c) { return std::fma(a, b, c); }
double smooth_step(double low, double high, double a) {
  const double t = clamp_to((a - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

void modf_both(const Operation& o, Lanes& lanes) {
  vector_result(o, lanes, 2 * o.n, [&](std::uint32_t i, int l) {
    const double a = lanes.cells[o.src[0] + i % o.n].f(l), whole = std::trunc(a);
    return i < o.n ? a - whole : whole;
  });
}

void frexp_both(const Operation& o, Lanes& lanes) {
  for (std::uint32_t i = 0; i < o.n; ++i) {
    Cell significand, exponent;
    for (int l = 0; l < kLanes; ++l) {
      int e = 0;
      significand.set_f(l, std::frexp(lanes.cells[o.src[0] + i].f(l), &e));
      exponent.set_u(l, static_cast<std::uint32_t>(e));
    }
    write(lanes, lanes.cells[o.dst + i], significand);
    write(lanes, lanes.cells[o.dst + o.n + i], exponent);
  }
}

void ldexp_each(const Operation& o, Lanes& lanes) {
  vector_result(o, lanes, o.n, [&](std::uint32_t i, int l) {
    return std::ldexp(operand(o, lanes, 0, i).f(l), static_cast<int>(operand(o, lanes, 1, i).u(l)));
  });
}

}  // namespace

Handler float_handler(std::uint32_t op) {
  switch (op) {
    case spv::OpFNegate: return each1<neg>;
    case spv::OpFAdd: return each2<add>;
    case spv::OpFSub: return each2<sub>;
    case spv::OpFMul:
    case spv::OpVectorTimesScalar:
    case spv::OpMatrixTimesScalar: return each2<mul>;
    case spv::OpFDiv: return each2<div>;
    case spv::OpFRem: return each2<rem>;
    case spv::OpFMod: return each2<mod>;
    case spv::OpIsNan: return test1<is_nan>;
    case spv::OpIsInf: return test1<is_inf>;
    case spv::OpFOrdEqual: return test2<eq>;
    case spv::OpFOrdNotEqual: return test2<ne>;
    case spv::OpFOrdLessThan: return test2<lt>;
    case spv::OpFOrdLessThanEqual: return test2<le>;
    case spv::OpFOrdGreaterThan: return test2<gt>;
    case spv::OpFOrdGreaterThanEqual: return test2<ge>;
    case spv::OpFUnordEqual: return test2<unordered_eq>;
    case spv::OpFUnordNotEqual: return test2<unordered_ne>;
    case spv::OpFUnordLessThan: return test2<unordered_lt>;
    case spv::OpFUnordLessThanEqual: return test2<unordered_le>;
    case spv::OpFUnordGreaterThan: return test2<unordered_gt>;
    case spv::OpFUnordGreaterThanEqual: return test2<unordered_ge>;
    default: return nullptr;
  }
}

Handler glsl_float_handler(std::uint32_t instruction) {
  switch (instruction) {
    case GLSLstd450Round:
    case GLSLstd450RoundEven: return each1<round_even>;
    case GLSLstd450Trunc: return each1<truncate>;
    case GLSLstd450FAbs: return each1<absolute>;
    case GLSLstd450FSign: return each1<sign>;
    case GLSLstd450Floor: return each1<floor_of>;
    case GLSLstd450Ceil: return each1<ceil_of>;
    case GLSLstd450Fract: return each1<fract>;
    case GLSLstd450Radians: return each1<radians>;
    case GLSLstd450Degrees: return each1<degrees>;
    case GLSLstd450Sin: return each1<sin_of>;
    case GLSLstd450Cos: return each1<cos_of>;
    case GLSLstd450Tan: return each1<tan_of>;
    case GLSLstd450Asin: return each1<asin_of>;
    case GLSLstd450Acos: return each1<acos_of>;
    case GLSLstd450Atan: return each1<atan_of>;
    case GLSLstd450Sinh: return each1<sinh_of>;
    case GLSLstd450Cosh: return each1<cosh_of>;
    case GLSLstd450Tanh: return each1<tanh_of>;
    case GLSLstd450Asinh: return each1<asinh_of>;
    case GLSLstd450Acosh: return each1<acosh_of>;
    case GLSLstd450Atanh: return each1<atanh_of>;
    case GLSLstd450Atan2: return each2<atan2_of>;
    case GLSLstd450Pow: return each2<pow_of>;
    case GLSLstd450Exp: return each1<exp_of>;
    case GLSLstd450Log: return each1<log_of>;
    case GLSLstd450Exp2: return each1<exp2_of>;
    case GLSLstd450Log2: return each1<log2_of>;
    case GLSLstd450Sqrt: return each1<sqrt_of>;
    case GLSLstd450InverseSqrt: return each1<inverse_sqrt>;
    case GLSLstd450FMin: return each2<min_of>;
    case GLSLstd450FMax: return each2<max_of>;
    case GLSLstd450NMin: return each2<nmin_of>;
    case GLSLstd450NMax: return each2<nmax_of>;
    case GLSLstd450FClamp: return each3<clamp_to>;
    case GLSLstd450NClamp: return each3<nclamp_to>;
    case GLSLstd450FMix: return each3<mix>;
    case GLSLstd450Step: return each2<step_at>;
    case GLSLstd450SmoothStep: return each3<smooth_step>;
    case GLSLstd450Fma: return each3<fma_of>;
    case GLSLstd450Ldexp: return ldexp_each;
    default: return nullptr;
  }
}

Handler glsl_two_result_handler(std::uint32_t instruction) {
  switch (instruction) {
    case GLSLstd450Modf:
    case GLSLstd450ModfStruct: return modf_both;
    case GLSLstd450Frexp:
    case GLSLstd450FrexpStruct: return frexp_both;
    default: return nullptr;
  }
}

}  // namespace quadrille::models::reference
