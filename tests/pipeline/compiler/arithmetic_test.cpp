/// Operators and built-in functions against C++: float arithmetic bit by bit, transcendental functions to a
/// tolerance.
#include "tests/pipeline/compiler/shader_runner.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <bit>
#include <cmath>

namespace quadrille::pipeline {
namespace {

using Scalar = float (*)(const Point&);

struct Case {
  const char* glsl;
  Scalar expected;
};

void check(const Case& test, double tolerance) {
  INFO(test.glsl);
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    RunInput input;
    input.points = assorted_points(seed);
    const RunOutput out =
        run_snippet(fmt::format("float whole; int power; color = vec4({});", test.glsl), input);
    for (int k = 0; k < models::kWarpQuads; ++k) {
      const float got = out.point(k)[0], want = test.expected(input.points[static_cast<std::size_t>(k)]);
      INFO("a.x " << input.points[static_cast<std::size_t>(k)].a[0] << " b.x "
                  << input.points[static_cast<std::size_t>(k)].b[0]);
      if (std::isnan(want)) CHECK(std::isnan(got));
      else if (tolerance == 0) CHECK(std::bit_cast<std::uint32_t>(got) == std::bit_cast<std::uint32_t>(want));
      else CHECK(std::abs(double{got} - double{want}) <= tolerance * std::max(1.0, std::abs(double{want})));
    }
  }
}

float dot4(const Vec4& x, const Vec4& y) {
  float sum = x[0] * y[0];
  for (std::size_t k = 1; k < 4; ++k) sum = x[k] * y[k] + sum;
  return sum;
}

}  // namespace

TEST_CASE("compiler: float arithmetic has the bits of C++ in the source's order") {
  const Case cases[] = {
      {"a.x + a.y + a.z", [](const Point& p) { return (p.a[0] + p.a[1]) + p.a[2]; }},
      {"a.x * a.y - a.z * a.w", [](const Point& p) { return p.a[0] * p.a[1] - p.a[2] * p.a[3]; }},
      {"(a.x * a.y + b.x) * a.z + b.y",
       [](const Point& p) { return (p.a[0] * p.a[1] + p.b[0]) * p.a[2] + p.b[1]; }},
      {"a.x / b.x", [](const Point& p) { return p.a[0] / p.b[0]; }},
      {"-abs(a.x) * -a.y", [](const Point& p) { return -std::abs(p.a[0]) * -p.a[1]; }},
      {"a.x - (-a.y)", [](const Point& p) { return p.a[0] + p.a[1]; }},
      {"mod(a.x, b.x)", [](const Point& p) { return p.a[0] - p.b[0] * std::floor(p.a[0] / p.b[0]); }},
      {"floor(a.x) + ceil(a.y) + trunc(a.z) + fract(a.w)",
       [](const Point& p) {
         return ((std::floor(p.a[0]) + std::ceil(p.a[1])) + std::trunc(p.a[2])) +
                (p.a[3] - std::floor(p.a[3]));
       }},
      {"round(a.x * 4.0) + roundEven(a.y * 4.0)",
       [](const Point& p) { return std::nearbyint(p.a[0] * 4) + std::nearbyint(p.a[1] * 4); }},
      {"min(a.x, a.y) + max(a.z, a.w)",
       [](const Point& p) { return std::min(p.a[0], p.a[1]) + std::max(p.a[2], p.a[3]); }},
      {"clamp(a.x, -1.5, 2.5)", [](const Point& p) { return std::min(std::max(p.a[0], -1.5f), 2.5f); }},
      {"clamp(a.x * a.y, 0.0, 1.0)",
       [](const Point& p) { return std::min(std::max(p.a[0] * p.a[1], 0.0f), 1.0f); }},
      {"sign(a.x) * step(a.y, a.z)",
       [](const Point& p) {
         return (p.a[0] > 0 ? 1.0f : p.a[0] < 0 ? -1.0f : 0.0f) * (p.a[2] >= p.a[1] ? 1.0f : 0.0f);
       }},
      {"mix(a.x, a.y, b.x)", [](const Point& p) { return p.a[0] * (1.0f - p.b[0]) + p.a[1] * p.b[0]; }},
      {"mix(1.0, a.y, b.x)", [](const Point& p) { return (p.a[1] * p.b[0] - p.b[0]) + 1.0f; }},
      {"mix(a.x, a.y, a.z > 0.0)", [](const Point& p) { return p.a[2] > 0 ? p.a[1] : p.a[0]; }},
      {"fma(a.x, a.y, a.z)", [](const Point& p) { return p.a[0] * p.a[1] + p.a[2]; }},
      {"dot(a, b)", [](const Point& p) { return dot4(p.a, p.b); }},
      {"length(a)", [](const Point& p) { return std::sqrt(dot4(p.a, p.a)); }},
      {"sqrt(b.x)", [](const Point& p) { return std::sqrt(p.b[0]); }},
      {"a.x * a.x * a.x", [](const Point& p) { return p.a[0] * p.a[0] * p.a[0]; }},
      {"pow(b.x, 2.0) + pow(b.y, 4.0)",
       [](const Point& p) { return p.b[0] * p.b[0] + (p.b[1] * p.b[1]) * (p.b[1] * p.b[1]); }},
      {"a.x * 0.0 + 0.0", [](const Point& p) { return p.a[0] * 0.0f + 0.0f; }},
      {"smoothstep(-2.0, 3.0, a.x)",
       [](const Point& p) {
         const float t = std::min(std::max((p.a[0] - -2.0f) / 5.0f, 0.0f), 1.0f);
         return t * (t * (3.0f - 2.0f * t));
       }},
      {"reflect(a.xy, b.xy).x",
       [](const Point& p) {
         const float d = p.a[1] * p.b[1] + p.a[0] * p.b[0];
         return p.a[0] - 2.0f * (d * p.b[0]);
       }},
      {"cross(a.xyz, b.xyz).y", [](const Point& p) { return p.a[2] * p.b[0] - p.a[0] * p.b[2]; }},
      {"faceforward(a.xy, b.xy, a.zw).x",
       [](const Point& p) { return p.a[3] * p.b[1] + p.a[2] * p.b[0] < 0 ? p.a[0] : -p.a[0]; }},
      {"ldexp(a.x, i.x)", [](const Point& p) { return std::ldexp(p.a[0], p.i[0]); }},
      {"float(isnan(a.x)) + float(isinf(1.0 / (a.x - a.x)))", [](const Point&) { return 1.0f; }},
      {"a.x > 0.0 && !(a.y < 1.0) || a.z == a.w ? 1.0 : 2.0",
       [](const Point& p) { return (p.a[0] > 0 && !(p.a[1] < 1)) || p.a[2] == p.a[3] ? 1.0f : 2.0f; }},
      {"modf(a.x, whole) * 16.0 + whole",
       [](const Point& p) {
         const float magnitude = std::abs(p.a[0]), sign = std::copysign(1.0f, p.a[0]);
         return (sign * (magnitude - std::floor(magnitude))) * 16.0f + sign * std::floor(magnitude);
       }},
      {"frexp(a.x, power) * 16.0 + float(power)",
       [](const Point& p) {
         int power = 0;
         const float significand = std::frexp(p.a[0], &power);
         return significand * 16.0f + static_cast<float>(power);
       }},
  };
  for (const Case& test : cases) check(test, 0);
}

TEST_CASE("compiler: transcendental functions are close to the C++ ones") {
  const Case cases[] = {
      {"radians(a.x) + degrees(a.y) * 0.01",
       [](const Point& p) { return p.a[0] * 0.01745329252f + p.a[1] * 0.5729577951f; }},
      {"sin(a.x)", [](const Point& p) { return std::sin(p.a[0]); }},
      {"cos(a.x)", [](const Point& p) { return std::cos(p.a[0]); }},
      {"tan(b.x * 0.5)", [](const Point& p) { return std::tan(p.b[0] * 0.5f); }},
      {"asin(a.x * 0.25)", [](const Point& p) { return std::asin(p.a[0] * 0.25f); }},
      {"acos(a.x * 0.25)", [](const Point& p) { return std::acos(p.a[0] * 0.25f); }},
      {"atan(a.x)", [](const Point& p) { return std::atan(p.a[0]); }},
      {"atan(a.x, a.y)", [](const Point& p) { return std::atan2(p.a[0], p.a[1]); }},
      {"sinh(a.x)", [](const Point& p) { return std::sinh(p.a[0]); }},
      {"cosh(a.x)", [](const Point& p) { return std::cosh(p.a[0]); }},
      {"tanh(a.x)", [](const Point& p) { return std::tanh(p.a[0]); }},
      {"asinh(a.x)", [](const Point& p) { return std::asinh(p.a[0]); }},
      {"acosh(b.x + 1.0)", [](const Point& p) { return std::acosh(p.b[0] + 1.0f); }},
      {"atanh(a.x * 0.2)", [](const Point& p) { return std::atanh(p.a[0] * 0.2f); }},
      {"pow(b.x, a.x)", [](const Point& p) { return std::pow(p.b[0], p.a[0]); }},
      {"exp(a.x)", [](const Point& p) { return std::exp(p.a[0]); }},
      {"log(b.x)", [](const Point& p) { return std::log(p.b[0]); }},
      {"exp2(a.x) + log2(b.x)", [](const Point& p) { return std::exp2(p.a[0]) + std::log2(p.b[0]); }},
      {"inversesqrt(b.x)", [](const Point& p) { return 1.0f / std::sqrt(p.b[0]); }},
      {"normalize(a).y", [](const Point& p) { return p.a[1] / std::sqrt(dot4(p.a, p.a)); }},
      {"distance(a, b)",
       [](const Point& p) {
         double sum = 0;
         for (std::size_t k = 0; k < 4; ++k) sum += (double{p.a[k]} - p.b[k]) * (double{p.a[k]} - p.b[k]);
         return static_cast<float>(std::sqrt(sum));
       }},
      {"refract(vec2(0.6, -0.8), vec2(0.0, 1.0), 0.5).y", [](const Point&) { return -0.953939f; }},
  };
  for (const Case& test : cases) check(test, 1.5e-3);
}

TEST_CASE("compiler: integer operations are those of C++") {
  const Case cases[] = {
      {"float(i.x + i.y * i.z - i.w)",
       [](const Point& p) { return static_cast<float>(p.i[0] + p.i[1] * p.i[2] - p.i[3]); }},
      {"float(i.x / (abs(i.y) + 1))",
       [](const Point& p) { return static_cast<float>(p.i[0] / (std::abs(p.i[1]) + 1)); }},
      {"float(uint(i.x + 20) % 7u)",
       [](const Point& p) { return static_cast<float>(static_cast<std::uint32_t>(p.i[0] + 20) % 7u); }},
      {"float(abs(i.x) % 5)", [](const Point& p) { return static_cast<float>(std::abs(p.i[0]) % 5); }},
      {"float((i.x & i.y) ^ (i.z | ~i.w))",
       [](const Point& p) { return static_cast<float>((p.i[0] & p.i[1]) ^ (p.i[2] | ~p.i[3])); }},
      {"float(i.x << 3) + float(i.y >> 2)",
       [](const Point& p) { return static_cast<float>(p.i[0] * 8) + static_cast<float>(p.i[1] >> 2); }},
      {"float(uint(i.x) >> 20)",
       [](const Point& p) { return static_cast<float>(static_cast<std::uint32_t>(p.i[0]) >> 20); }},
      {"float(min(i.x, i.y) + max(i.z, i.w) + clamp(i.x, -3, 4))",
       [](const Point& p) {
         return static_cast<float>(std::min(p.i[0], p.i[1]) + std::max(p.i[2], p.i[3]) +
                                   std::min(std::max(p.i[0], -3), 4));
       }},
      {"float(sign(i.x) + int(i.y < i.z) + 2 * int(uint(i.x) < uint(i.y)))",
       [](const Point& p) {
         const int sign = p.i[0] > 0 ? 1 : p.i[0] < 0 ? -1 : 0;
         return static_cast<float>(
             sign + (p.i[1] < p.i[2] ? 1 : 0) +
             2 * (static_cast<std::uint32_t>(p.i[0]) < static_cast<std::uint32_t>(p.i[1]) ? 1 : 0));
       }},
      {"float(int(a.x)) + float(uint(b.x * 100.0))",
       [](const Point& p) {
         return static_cast<float>(static_cast<int>(p.a[0])) +
                static_cast<float>(static_cast<unsigned>(p.b[0] * 100.0f));
       }},
      {"float(floatBitsToInt(a.x) >> 16)",
       [](const Point& p) { return static_cast<float>(std::bit_cast<std::int32_t>(p.a[0]) >> 16); }},
      {"intBitsToFloat(floatBitsToInt(-a.x) & 0x7fffffff)", [](const Point& p) { return std::abs(p.a[0]); }},
      {"float(i.x == i.y || i.x != i.z)",
       [](const Point& p) { return p.i[0] == p.i[1] || p.i[0] != p.i[2] ? 1.0f : 0.0f; }},
      {"float(all(lessThan(a, b)) ? 3 : any(greaterThanEqual(a, b)) ? 5 : 7)",
       [](const Point& p) {
         bool all = true;
         for (std::size_t k = 0; k < 4; ++k) all = all && p.a[k] < p.b[k];
         return all ? 3.0f : 5.0f;
       }},
  };
  for (const Case& test : cases) check(test, 0);
}

TEST_CASE("compiler: packing rounds to nearest and unpacking inverts it") {
  const Case cases[] = {
      {"float(packUnorm4x8(vec4(a.x, 0.5, 1.0, 2.0)) & 0xffffu)",
       [](const Point& p) {
         return std::nearbyint(std::min(std::max(p.a[0], 0.0f), 1.0f) * 255.0f) + 256.0f * 128.0f;
       }},
      {"unpackUnorm4x8(packUnorm4x8(vec4(b.x * 0.25))).y",
       [](const Point& p) { return std::nearbyint(p.b[0] * 0.25f * 255.0f) / 255.0f; }},
      {"unpackSnorm4x8(packSnorm4x8(vec4(a.x * 0.25))).w",
       [](const Point& p) { return std::nearbyint(p.a[0] * 0.25f * 127.0f) / 127.0f; }},
      {"unpackUnorm2x16(packUnorm2x16(vec2(b.x * 0.25))).x",
       [](const Point& p) { return std::nearbyint(p.b[0] * 0.25f * 65535.0f) / 65535.0f; }},
      {"unpackSnorm2x16(packSnorm2x16(vec2(a.x * 0.25))).y",
       [](const Point& p) { return std::nearbyint(p.a[0] * 0.25f * 32767.0f) / 32767.0f; }},
      {"unpackHalf2x16(packHalf2x16(vec2(a.x, 1.0))).x",
       [](const Point& p) {
         int exponent = 0;
         std::frexp(p.a[0], &exponent);
         return std::ldexp(std::nearbyint(std::ldexp(p.a[0], 11 - exponent)), exponent - 11);
       }},
      {"unpackHalf2x16(packHalf2x16(vec2(70000.0 * b.x + 60000.0, 1e-7 * b.x))).x",
       [](const Point&) { return INFINITY; }},
      {"unpackHalf2x16(packHalf2x16(vec2(0.0, 1e-6 * b.x))).y",
       [](const Point& p) { return std::nearbyint(1e-6f * p.b[0] * 0x1p24f) * 0x1p-24f; }},
  };
  for (const Case& test : cases) check(test, 0);
}

TEST_CASE("compiler: matrices multiply last column first, vectors times matrices are dot products") {
  RunInput input;
  input.points = assorted_points(9);
  const std::string set_up =
      "mat3 m = mat3(a.x, a.y, a.z, b.x, b.y, b.z, a.w, b.w, a.x); vec3 v = vec3(b.z, a.z, b.x);\n";
  const auto element = [](const Point& p, std::size_t row, std::size_t column) {
    const std::array<float, 9> m{p.a[0], p.a[1], p.a[2], p.b[0], p.b[1], p.b[2], p.a[3], p.b[3], p.a[0]};
    return m[column * 3 + row];
  };
  const auto vector = [](const Point& p) { return std::array<float, 3>{p.b[2], p.a[2], p.b[0]}; };
  const RunOutput times = run_snippet(set_up + "color = vec4(m * v, 1);", input);
  const RunOutput rows = run_snippet(set_up + "color = vec4(v * m, 1);", input);
  const RunOutput transposed = run_snippet(set_up + "color = vec4(transpose(m) * v, 1);", input);
  const RunOutput back = run_snippet(set_up + "color = vec4(inverse(m) * (m * v), determinant(m));", input);
  const RunOutput product = run_snippet(set_up + "color = vec4((m * outerProduct(v, v))[1], 1);", input);
  for (int k = 0; k < models::kWarpQuads; ++k) {
    const Point& p = input.points[static_cast<std::size_t>(k)];
    const auto v = vector(p);
    for (std::size_t c = 0; c < 3; ++c) {
      float column_wise = element(p, c, 2) * v[2], row_wise = element(p, 0, c) * v[0];
      float last_first = element(p, c, 2) * (v[2] * v[1]);
      for (const std::size_t n : {std::size_t{1}, std::size_t{0}}) {
        column_wise = element(p, c, n) * v[n] + column_wise;
        last_first = element(p, c, n) * (v[n] * v[1]) + last_first;
      }
      for (const std::size_t n : {std::size_t{1}, std::size_t{2}})
        row_wise = element(p, n, c) * v[n] + row_wise;
      CHECK(times.point(k)[c] == column_wise);
      CHECK(rows.point(k)[c] == row_wise);
      CHECK(transposed.point(k)[c] == row_wise);
      CHECK(product.point(k)[c] == last_first);
      CHECK(back.point(k)[c] == Approx(v[c]).margin(std::abs(back.point(k)[3]) < 0.5f ? 0.05 : 0.005));
    }
  }
}

TEST_CASE("compiler: an expression that is computed twice is computed once") {
  const models::Program once = compile_fragment(fragment_source("color = vec4(exp2(a.x * a.y));"));
  const models::Program twice = compile_fragment(
      fragment_source("color = vec4(exp2(a.x * a.y)); color.y = exp2(a.x * a.y) + 0.0 * exp2(a.y * a.x);"));
  const auto exps = [](const models::Program& p) {
    return std::count_if(p.code.begin(), p.code.end(),
                         [](const models::Instruction& i) { return i.op == models::Op::kFExp2; });
  };
  CHECK(exps(once) == 1);
  CHECK(exps(twice) == 1);
}

TEST_CASE("compiler: a product used by one sum is fused, one used twice is not computed twice") {
  const auto count = [](const char* body, models::Op op) {
    const models::Program p = compile_fragment(fragment_source(body));
    return std::count_if(p.code.begin(), p.code.end(),
                         [&](const models::Instruction& i) { return i.op == op; });
  };
  CHECK(count("color = vec4(a.x * a.y + a.z);", models::Op::kFMad) == 1);
  CHECK(count("color = vec4(a.x * a.y + a.z);", models::Op::kFMul) == 0);
  CHECK(count("float m = a.x * a.y; color = vec4(m + a.z, m + a.w, m, 0);", models::Op::kFMul) == 1);
  CHECK(count("color = vec4(clamp(a.x + a.y, 0.0, 1.0));", models::Op::kFMax) == 0);
}

}  // namespace quadrille::pipeline
