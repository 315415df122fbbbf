/// The interpreter against C++: every family of operations, and control flow with lanes that go different
/// ways.
#include "tests/models/reference/lane_shader.h"

#include "models/base/error.h"

#include <catch2/catch.hpp>

#include <functional>

using namespace quadrille;
using namespace quadrille::models::reference;
using quadrille::models::reference::test::LaneShader;
using quadrille::models::reference::test::LaneValues;

namespace {

constexpr LaneValues kA{0.25, -1.5, 3.75, 0.875}, kB{1.5, 2.25, -0.5, 0.125};

void check_binary(const std::string& expression, const std::function<double(double, double)>& expected,
                  LaneValues a = kA, LaneValues b = kB) {
  INFO(expression);
  LaneShader shader("o.x = " + expression + ";");
  shader.set(0, 0, a), shader.set(1, 0, b);
  shader.run();
  for (int lane = 0; lane < kLanes; ++lane) {
    const double want = expected(a[static_cast<std::size_t>(lane)], b[static_cast<std::size_t>(lane)]);
    CHECK(shader.out(lane) == Approx(want).epsilon(1e-14).margin(1e-300));
  }
}

void check_int(const std::string& expression,
               const std::function<std::int32_t(std::int32_t, std::int32_t)>& expected) {
  INFO(expression);
  constexpr std::array<std::int32_t, 4> kI{7, -7, 2147483647, -2147483647 - 1}, kJ{3, 3, -2, 5};
  LaneShader shader("oi.x = " + expression + ";");
  shader.set_int(3, 0, kI), shader.set_int(4, 0, kJ);
  shader.run();
  for (std::size_t lane = 0; lane < 4; ++lane)
    CHECK(shader.out_int(static_cast<int>(lane)) == expected(kI[lane], kJ[lane]));
}

std::uint32_t u(std::int32_t a) { return static_cast<std::uint32_t>(a); }
std::int32_t s(std::uint32_t a) { return static_cast<std::int32_t>(a); }

}  // namespace

TEST_CASE("interpreter: float arithmetic is that of doubles") {
  check_binary("a.x + b.x", std::plus<>());
  check_binary("a.x - b.x", std::minus<>());
  check_binary("a.x * b.x", std::multiplies<>());
  check_binary("a.x / b.x", std::divides<>());
  check_binary("-a.x", [](double a, double) { return -a; });
  check_binary("mod(a.x, b.x)", [](double a, double b) { return a - b * std::floor(a / b); });
  check_binary("a.x + 0.1", [](double a, double) { return a + static_cast<double>(0.1f); });
  check_binary("1.0 / 3.0 * a.x", [](double a, double) { return a * static_cast<double>(1.0f / 3.0f); });
}

TEST_CASE("interpreter: float functions") {
  check_binary("floor(a.x) + 100.0 * ceil(b.x)",
               [](double a, double b) { return std::floor(a) + 100 * std::ceil(b); });
  check_binary("fract(a.x)", [](double a, double) { return a - std::floor(a); });
  check_binary("trunc(a.x)", [](double a, double) { return std::trunc(a); });
  check_binary("roundEven(a.x * 2.0)", [](double a, double) { return std::nearbyint(a * 2); });
  check_binary("abs(a.x) * sign(b.x)", [](double a, double b) { return std::abs(a) * (b > 0 ? 1 : -1); });
  check_binary("min(a.x, b.x) + 10.0 * max(a.x, b.x)",
               [](double a, double b) { return std::min(a, b) + 10 * std::max(a, b); });
  check_binary("clamp(a.x, 0.0, 1.0)", [](double a, double) { return std::clamp(a, 0.0, 1.0); });
  check_binary("mix(a.x, b.x, 0.25)", [](double a, double b) { return 0.75 * a + 0.25 * b; });
  check_binary("step(a.x, b.x)", [](double a, double b) { return b < a ? 0.0 : 1.0; });
  check_binary("smoothstep(-1.0, 1.0, b.x * 0.5)", [](double, double b) {
    const double t = std::clamp((b * 0.5 + 1) / 2, 0.0, 1.0);
    return t * t * (3 - 2 * t);
  });
  check_binary("fma(a.x, b.x, a.x)", [](double a, double b) { return std::fma(a, b, a); });
  check_binary("sin(a.x) + cos(b.x)", [](double a, double b) { return std::sin(a) + std::cos(b); });
  check_binary("tan(a.x) + atan(b.x)", [](double a, double b) { return std::tan(a) + std::atan(b); });
  check_binary("atan(a.x, b.x)", [](double a, double b) { return std::atan2(a, b); });
  check_binary("asin(b.x * 0.25) - acos(b.x * 0.25)",
               [](double, double b) { return std::asin(b * 0.25) - std::acos(b * 0.25); });
  check_binary("exp(a.x) + exp2(b.x)", [](double a, double b) { return std::exp(a) + std::exp2(b); });
  check_binary("log(abs(a.x)) + log2(abs(b.x))",
               [](double a, double b) { return std::log(std::abs(a)) + std::log2(std::abs(b)); });
  check_binary("pow(abs(a.x), b.x)", [](double a, double b) { return std::pow(std::abs(a), b); });
  check_binary("sqrt(abs(a.x)) + inversesqrt(abs(b.x))",
               [](double a, double b) { return std::sqrt(std::abs(a)) + 1 / std::sqrt(std::abs(b)); });
  check_binary("sinh(a.x) + cosh(b.x) + tanh(a.x)",
               [](double a, double b) { return std::sinh(a) + std::cosh(b) + std::tanh(a); });
  check_binary("radians(a.x) + degrees(b.x)",
               [](double a, double b) { return a * M_PI / 180 + b * 180 / M_PI; });
}

TEST_CASE("interpreter: modf, frexp and ldexp return both parts") {
  LaneShader shader(
      "float whole; o.x = modf(a.x, whole); o.y = whole; int e; o.z = frexp(b.x, e); oi.x = e; o.w = "
      "ldexp(o.z, e);");
  shader.set(0, 0, kA), shader.set(1, 0, kB);
  shader.run();
  for (int lane = 0; lane < kLanes; ++lane) {
    const double a = kA[static_cast<std::size_t>(lane)], b = kB[static_cast<std::size_t>(lane)];
    int exponent = 0;
    CHECK(shader.out(lane, 0) == a - std::trunc(a));
    CHECK(shader.out(lane, 1) == std::trunc(a));
    CHECK(shader.out(lane, 2) == std::frexp(b, &exponent));
    CHECK(shader.out_int(lane, 0) == exponent);
    CHECK(shader.out(lane, 3) == b);
  }
}

TEST_CASE("interpreter: float comparisons, NaN among them") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  LaneShader shader(
      "oi.x = int(a.x < b.x) + 2 * int(a.x <= b.x) + 4 * int(a.x > b.x) + 8 * int(a.x >= b.x) + 16 * int(a.x "
      "== b.x) + 32 * int(a.x != "
      "b.x);"
      "oi.y = int(isnan(a.x)) + 2 * int(isinf(b.x)); oi.z = int(any(lessThan(a.xy, b.xy))) + 2 * "
      "int(all(lessThan(a.xy, b.xy)));");
  shader.set(0, 0, {1, 2, 2, nan}), shader.set(1, 0, {2, 1, 2, std::numeric_limits<double>::infinity()});
  shader.set(0, 1, {0, 0, 0, 0}), shader.set(1, 1, {1, 1, -1, -1});
  shader.run();
  const std::array<int, 4> want_x{1 + 2 + 32, 4 + 8 + 32, 2 + 8 + 16, 32}, want_y{0, 0, 0, 3},
      want_z{3, 1, 0, 0};
  for (std::size_t lane = 0; lane < 4; ++lane) {
    CHECK(shader.out_int(static_cast<int>(lane), 0) == want_x[lane]);
    CHECK(shader.out_int(static_cast<int>(lane), 1) == want_y[lane]);
    CHECK(shader.out_int(static_cast<int>(lane), 2) == want_z[lane]);
  }
}

TEST_CASE("interpreter: integers are 32 bits and wrap") {
  check_int("i.x + j.x", [](auto i, auto j) { return s(u(i) + u(j)); });
  check_int("i.x - j.x", [](auto i, auto j) { return s(u(i) - u(j)); });
  check_int("i.x * j.x", [](auto i, auto j) { return s(u(i) * u(j)); });
  check_int("i.x / j.x", [](auto i, auto j) { return i / j; });
  check_int("int(uint(i.x) / uint(j.x))", [](auto i, auto j) { return s(u(i) / u(j)); });
  check_int("int(uint(i.x) % uint(j.x))", [](auto i, auto j) { return s(u(i) % u(j)); });
  check_int("(i.x << 3) ^ (i.x >> 2)", [](auto i, auto) { return s(u(i) << 3) ^ (i >> 2); });
  check_int("int(uint(i.x) >> 5u)", [](auto i, auto) { return s(u(i) >> 5); });
  check_int("(i.x & j.x) | ~j.x", [](auto i, auto j) { return (i & j) | ~j; });
  check_int("min(i.x, j.x) ^ max(i.x, j.x)", [](auto i, auto j) { return std::min(i, j) ^ std::max(i, j); });
  check_int("clamp(i.x, -5, 5) * sign(j.x)",
            [](auto i, auto j) { return std::clamp(i, -5, 5) * (j > 0 ? 1 : -1); });
  check_int("int(min(uint(i.x), uint(j.x)))", [](auto i, auto j) { return s(std::min(u(i), u(j))); });
  check_int("int(i.x < j.x) + 2 * int(uint(i.x) < uint(j.x)) + 4 * int(i.x == 7)",
            [](auto i, auto j) { return (i < j ? 1 : 0) + (u(i) < u(j) ? 2 : 0) + (i == 7 ? 4 : 0); });
  check_int("bitCount(i.x) + 100 * findLSB(i.x) + 10000 * findMSB(uint(i.x))", [](auto i, auto) {
    return std::popcount(u(i)) + 100 * std::countr_zero(u(i)) + 10000 * (31 - std::countl_zero(u(i)));
  });
  check_int("bitfieldExtract(i.x, 4, 8)", [](auto i, auto) { return static_cast<std::int8_t>(i >> 4); });
  check_int("bitfieldInsert(i.x, j.x, 8, 4)",
            [](auto i, auto j) { return s((u(i) & ~0xf00u) | ((u(j) & 0xfu) << 8)); });
  check_int("floatBitsToInt(intBitsToFloat(i.x & 0x3fffffff))", [](auto i, auto) { return i & 0x3fffffff; });
}

TEST_CASE("interpreter: conversions to integers truncate, saturate, and take NaN to zero") {
  LaneShader shader("oi.x = int(a.x); oi.y = int(uint(b.x)); o.x = float(i.x); o.y = float(uint(i.x));");
  shader.set(0, 0, {-2.75, 3e10, std::numeric_limits<double>::quiet_NaN(), -3e10}),
      shader.set(1, 0, {2.75, -1.0, 3e9, 1e20});
  shader.set_int(3, 0, {5, -5, 16777217, -1});
  shader.run();
  const std::array<std::int32_t, 4> x{-2, 2147483647, 0, -2147483647 - 1}, y{2, 0, s(3000000000u), -1};
  const LaneValues fx{5, -5, 16777217, -1}, fy{5, 4294967291.0, 16777217, 4294967295.0};
  for (std::size_t lane = 0; lane < 4; ++lane) {
    CHECK(shader.out_int(static_cast<int>(lane), 0) == x[lane]);
    CHECK(shader.out_int(static_cast<int>(lane), 1) == y[lane]);
    CHECK(shader.out(static_cast<int>(lane), 0) == fx[lane]);
    CHECK(shader.out(static_cast<int>(lane), 1) == fy[lane]);
  }
}

TEST_CASE("interpreter: vectors and matrices") {
  LaneShader shader(
      "mat3 m = mat3(a.xyz, b.xyz, vec3(0.5, -0.25, 2.0)); vec3 v = vec3(a.w, b.w, 1.0);"
      "vec3 back = inverse(m) * (m * v); vec3 left = v * m - transpose(m) * v; mat3 unit = m * inverse(m);"
      "o = vec4(length(back - v), length(left), determinant(m), unit[0][0] + unit[1][1] + unit[2][2]);"
      "oi.x = int(dot(cross(a.xyz, b.xyz), a.xyz) * 1e6); oi.y = int(distance(reflect(v, normalize(b.xyz)), "
      "v) * 1e3);"
      "oi.z = int(outerProduct(a.xy, b.xyz)[2][1] * 1e3); oi.w = int(length(refract(normalize(a.xyz), "
      "normalize(b.xyz), 0.1)) * 1e3 + "
      "0.5);");
  shader.set(0, 0, {1, 2, 3, 4}), shader.set(0, 1, {0.5, 0.25, -1, 2}), shader.set(0, 2, {2, 2, 0, 1}),
      shader.set(0, 3, {1, -1, 2, 0});
  shader.set(1, 0, {0, 1, 0, -1}), shader.set(1, 1, {3, 2, 1, 5}), shader.set(1, 2, {0.5, 1, 2, 3}),
      shader.set(1, 3, {4, 3, 2, 1});
  shader.run();
  const LaneValues ax{1, 2, 3, 4}, ay{0.5, 0.25, -1, 2}, az{2, 2, 0, 1}, aw{1, -1, 2, 0}, bx{0, 1, 0, -1},
      by{3, 2, 1, 5}, bz{0.5, 1, 2, 3}, bw{4, 3, 2, 1};
  for (std::size_t l = 0; l < 4; ++l) {
    const int lane = static_cast<int>(l);
    CHECK(shader.out(lane, 0) == Approx(0).margin(1e-12));
    CHECK(shader.out(lane, 1) == Approx(0).margin(1e-12));
    const double det = ax[l] * (by[l] * 2 + 0.25 * bz[l]) - bx[l] * (ay[l] * 2 + 0.25 * az[l]) +
                       0.5 * (ay[l] * bz[l] - by[l] * az[l]);
    CHECK(shader.out(lane, 2) == Approx(det));
    CHECK(shader.out(lane, 3) == Approx(3));
    CHECK(shader.out_int(lane, 0) == 0);
    const double size = std::sqrt(bx[l] * bx[l] + by[l] * by[l] + bz[l] * bz[l]);
    CHECK(shader.out_int(lane, 1) ==
          static_cast<int>(2 * std::abs((aw[l] * bx[l] + bw[l] * by[l] + bz[l]) / size) * 1e3));
    CHECK(shader.out_int(lane, 2) == static_cast<int>(ay[l] * bz[l] * 1e3));
    CHECK(shader.out_int(lane, 3) == 1000);
  }
}

TEST_CASE("interpreter: packing and unpacking round to nearest") {
  LaneShader shader(
      "oi.x = int(packUnorm4x8(a)); o = unpackUnorm4x8(packUnorm4x8(a)); oi.y = int(packSnorm2x16(a.xy)); "
      "oi.z = "
      "int(unpackSnorm2x16(uint(oi.y)).y * 32767.0);");
  shader.set(0, 0, {0, 1, 0.5, -3}), shader.set(0, 1, {1, -1, 0.25, -0.5});
  shader.run();
  const std::array<std::uint32_t, 4> x{0x0000ff00u, 0x000000ffu, 0x00004080u, 0},
      y{0x7fff0000u, 0x80017fffu, 0x20004000u, 0xc0008001u};
  for (std::size_t l = 0; l < 4; ++l) {
    CHECK(u(shader.out_int(static_cast<int>(l), 0)) == x[l]);
    CHECK(u(shader.out_int(static_cast<int>(l), 1)) == y[l]);
    CHECK(shader.out_int(static_cast<int>(l), 2) == static_cast<std::int16_t>(y[l] >> 16));
  }
  CHECK(shader.out(2, 0) == 128.0 / 255.0);
}

TEST_CASE("interpreter: lanes that loop different numbers of times keep their own results") {
  LaneShader shader(
      "float sum = 0.0; int k = 0; for (; k < i.x; ++k) { if (k == 2) continue; if (k == 6) break; sum += "
      "a.x * float(k); } o.x = sum; "
      "oi.x = k;");
  shader.set_int(3, 0, {0, 3, 5, 100}), shader.set(0, 0, {1, 10, 100, 1000});
  shader.run();
  const LaneValues sums{0, 10, 800, 13000};
  const std::array<int, 4> counts{0, 3, 5, 6};
  for (std::size_t l = 0; l < 4; ++l) {
    CHECK(shader.out(static_cast<int>(l)) == sums[l]);
    CHECK(shader.out_int(static_cast<int>(l)) == counts[l]);
  }
}

TEST_CASE("interpreter: nested branches, switch with fall-through, and ?: choose lane by lane") {
  LaneShader shader(
      "int r = 0; switch (i.x) { case 0: r = 1; case 1: r += 10; break; case 7: if (j.x > 0) { r = 70; } "
      "else { r = 71; } break; default: "
      "r = 99; }"
      "oi.x = r; oi.y = i.x > 0 && j.x > 0 ? 5 : 6;");
  shader.set_int(3, 0, {0, 1, 7, 50}), shader.set_int(4, 0, {1, 1, -1, 1});
  shader.run();
  const std::array<int, 4> x{11, 10, 71, 99}, y{6, 5, 6, 5};
  for (std::size_t l = 0; l < 4; ++l) {
    CHECK(shader.out_int(static_cast<int>(l), 0) == x[l]);
    CHECK(shader.out_int(static_cast<int>(l), 1) == y[l]);
  }
}

TEST_CASE("interpreter: functions with several returns, out and inout parameters") {
  LaneShader shader("float p = a.x; float q; o.x = f(p, q); o.y = p; o.z = q; o.w = f(p, q);",
                    "float f(inout float x, out float y) { y = x * 2.0; x += 1.0; if (y > 3.0) return y; for "
                    "(int k = 0; k < 4; ++k) { if "
                    "(float(k) > y) return -float(k); } return 0.5; }");
  shader.set(0, 0, {0.25, 1, 2, -5});
  shader.run();
  const auto f = [](double& x, double& y) {
    y = x * 2, x += 1;
    if (y > 3) return y;
    for (int k = 0; k < 4; ++k) {
      if (k > y) return -static_cast<double>(k);
    }
    return 0.5;
  };
  for (int lane = 0; lane < 4; ++lane) {
    double p = LaneValues{0.25, 1, 2, -5}[static_cast<std::size_t>(lane)], q = 0;
    CHECK(shader.out(lane, 0) == f(p, q));
    CHECK(shader.out(lane, 1) == p);
    CHECK(shader.out(lane, 2) == q);
    CHECK(shader.out(lane, 3) == f(p, q));
  }
}

TEST_CASE(
    "interpreter: arrays, matrices and vectors indexed by lane-varying values, indices beyond the end are "
    "clamped") {
  LaneShader shader(
      "float t[3] = float[](1.0, 20.0, 300.0); t[i.x] += a.x; mat2 m = mat2(1, 2, 3, 4); vec4 v = a; v[j.x] "
      "= 7.0;"
      "o = vec4(t[0] + t[1] + t[2], t[i.x], m[j.x][1], v[j.x] + a[j.x]); S s[2]; s[j.x].v[1] = 3.5; oi.x = "
      "int(s[1].v[1] * 10.0);",
      "struct S { float pad; float v[2]; };");
  shader.set_int(3, 0, {0, 1, 2, 1000}), shader.set_int(4, 0, {0, 1, 1, 0});
  for (std::uint32_t c = 0; c < 4; ++c) shader.set(0, c, {0.5 + c, 1.5 + c, 2.5 + c, 3.5 + c});
  shader.run();
  const std::array<std::size_t, 4> i{0, 1, 2, 2}, j{0, 1, 1, 0};
  for (std::size_t l = 0; l < 4; ++l) {
    const double ax = 0.5 + static_cast<double>(l);
    CHECK(shader.out(static_cast<int>(l), 0) == 321 + ax);
    CHECK(shader.out(static_cast<int>(l), 1) == LaneValues{1, 20, 300, 0}[i[l]] + ax);
    CHECK(shader.out(static_cast<int>(l), 2) == (j[l] == 0 ? 2 : 4));
    CHECK(shader.out(static_cast<int>(l), 3) == 7 + ax + static_cast<double>(j[l]));
    CHECK(shader.out_int(static_cast<int>(l), 0) == (j[l] == 1 ? 35 : 0));
  }
}

TEST_CASE("interpreter: a loop swaps values through phis at once") {
  LaneShader shader(
      "float x = a.x, y = b.x; for (int k = 0; k < i.x; ++k) { float t = x; x = y; y = t; } o.xy = vec2(x, "
      "y);");
  shader.set(0, 0, {1, 2, 3, 4}), shader.set(1, 0, {10, 20, 30, 40}), shader.set_int(3, 0, {0, 1, 2, 3});
  shader.run();
  for (int l = 0; l < 4; ++l) CHECK(shader.out(l, static_cast<std::uint32_t>(l % 2)) == l + 1);
}

TEST_CASE("interpreter: derivatives, fine by default") {
  LaneShader shader(
      "o = vec4(dFdx(a.x), dFdy(a.x), dFdxCoarse(a.x), dFdyCoarse(a.x)); oi.x = int(fwidth(a.x)); oi.y = "
      "int(fwidthCoarse(a.x));"
      "oi.z = int(dFdxFine(a.x)); oi.w = int(dFdyFine(a.x));");
  shader.set(0, 0, {1, 4, 11, 19});
  shader.run();
  for (int l = 0; l < 4; ++l) {
    const int dx = l < 2 ? 3 : 8, dy = l % 2 == 0 ? 10 : 15;
    CHECK(shader.out(l, 0) == dx);
    CHECK(shader.out(l, 1) == dy);
    CHECK(shader.out(l, 2) == 3);
    CHECK(shader.out(l, 3) == 10);
    CHECK(shader.out_int(l, 0) == dx + dy);
    CHECK(shader.out_int(l, 1) == 13);
    CHECK(shader.out_int(l, 2) == dx);
    CHECK(shader.out_int(l, 3) == dy);
  }
}

TEST_CASE("interpreter: discarded lanes are marked and go on as helpers, so that derivatives stay defined") {
  LaneShader shader("if (a.x < 0.5) discard; o.x = dFdx(a.x * 2.0);");
  shader.set(0, 0, {0.25, 1.0, 0.75, 0.5});
  shader.run();
  CHECK(shader.lanes.killed == 1u);
  CHECK(shader.out(1) == 1.5);  // from the discarded lane
  CHECK(shader.out(2) == -0.5);
  CHECK(shader.out(3) == -0.5);
  CHECK(shader.lanes.discard_margin == std::array<double, 4>{0.25, 0.5, 0.25, 0.0});
}

TEST_CASE("interpreter: a discard inside a function and a compound condition is seen") {
  LaneShader shader("cut(a.x); o.x = 1.0;", "void cut(float x) { if (x < 0.5 || x > 2.0) { discard; } }");
  shader.set(0, 0, {0.25, 1.0, 2.25, 2.0});
  shader.run();
  CHECK(shader.lanes.killed == 0b0101u);
  CHECK(shader.program().discards);
}

TEST_CASE("interpreter: a loop that does not end is the user's mistake, and named") {
  LaneShader shader("float x = a.x; while (x > 0.0) { x += 1.0; } o.x = x;");
  shader.set(0, 0, {1, 1, 1, 1});
  REQUIRE_THROWS_WITH(shader.run(), Catch::Contains("'test'") && Catch::Contains("loop"));
}

TEST_CASE("interpreter: what is outside the subset is named") {
  using quadrille::models::reference::test::glsl;
  const auto decode = [](std::string_view source) { return decode_shader(glsl(source)); };
  CHECK_THROWS_WITH(decode("#version 450\nlayout(binding = 0) uniform samplerBuffer t; layout(location = 0) "
                           "out vec4 o; void main() { o = "
                           "texelFetch(t, 1); }"),
                    Catch::Contains("an image other than a sampled one, 1D, 2D, 3D or a cube"));
  CHECK_THROWS_WITH(decode("#version 450\nlayout(location = 0) out vec4 o; void main() { double d = "
                           "gl_FragCoord.x; o = vec4(float(d * d)); }"),
                    Catch::Contains("32 bits"));
  CHECK_THROWS_WITH(decode("#version 450\nlayout(binding = 0) buffer B { float x; }; layout(location = 0) "
                           "out vec4 o; void main() { o = "
                           "vec4(x); x = 1.0; }"),
                    Catch::Contains("variable"));
  CHECK_THROWS_AS(decode_shader(traces::Shader{"empty", traces::ShaderStage::kFragment, {}}), UserError);
  CHECK_THROWS_AS(
      decode_shader(traces::Shader{
          "noise", traces::ShaderStage::kFragment, {0x07230203, 0x10300, 0, 8, 0, 0xffff0001, 3}}),
      UserError);
  const traces::Shader vertex =
      glsl("#version 450\nvoid main() { gl_Position = vec4(0); }", traces::ShaderStage::kVertex);
  CHECK_THROWS_WITH(decode_shader({"wrong stage", traces::ShaderStage::kFragment, vertex.spirv}),
                    Catch::Contains("entry point"));
}

TEST_CASE("interpreter: specialisation constants that are computed") {
  const std::string declarations =
      R"(layout(constant_id = 0) const int N = 3; layout(constant_id = 1) const bool B = true;
layout(constant_id = 2) const float F = 0.5; layout(constant_id = 3) const uint U = 0xfffffff0u;
const float S = N == 3 ? 1.0 : F; const vec3 V = B ? vec3(F, 2.0, 3.0) : vec3(0.0); const vec2 W = N > 5 ? vec2(1.0) : V.yx;
const ivec3 I = ivec3(N, N + 6, N * 7) % 4; const uint X = (U >> 2) ^ uint(N); const bvec2 P = bvec2(B, !B); const vec2 Q = P.y ? V.xy : W;
const int M = (N << 4) / (N - 1) - (~N & 5); const bool O = (uint(N) < U) == (B != false);)";
  LaneShader shader(
      R"(o.x = S + V.x + 10.0 * V.z + 100.0 * W.x + 1000.0 * Q.y + float(I.x * 3 - I.y + M) + (O ? 0.25 : 0.0) + (X == 0x3fffffffu ? 1000.0 : 0.0);)",
      declarations);
  shader.run();
  CHECK(shader.out(0) == 1759.75);
}
