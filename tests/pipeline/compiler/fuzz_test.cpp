/// Random expressions and random control flow, evaluated by the compiled program and by C++ at the same time.
#include "tests/pipeline/compiler/shader_runner.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include <bit>
#include <cmath>
#include <memory>

namespace quadrille::pipeline {
namespace {

/// A float expression: its GLSL text and its value for a point.
struct Expression {
  std::string text;
  std::function<float(const Point&)> value;
};

class Generator {
 public:
  explicit Generator(std::uint32_t seed) : random_(seed) {}

  Expression expression(int depth) {
    if (depth == 0 || random_() % 8 == 0) return leaf();
    const Expression x = expression(depth - 1), y = expression(depth - 1);
    switch (random_() % 11) {
      case 0:
        return {fmt::format("({} + {})", x.text, y.text),
                [=](const Point& p) { return x.value(p) + y.value(p); }};
      case 1:
        return {fmt::format("({} - {})", x.text, y.text),
                [=](const Point& p) { return x.value(p) - y.value(p); }};
      case 2:
      case 3:
        return {fmt::format("({} * {})", x.text, y.text),
                [=](const Point& p) { return x.value(p) * y.value(p); }};
      case 4: return {fmt::format("(-{})", x.text), [=](const Point& p) { return -x.value(p); }};
      case 5: return {fmt::format("abs({})", x.text), [=](const Point& p) { return std::abs(x.value(p)); }};
      case 6:
        return {fmt::format("min({}, {})", x.text, y.text),
                [=](const Point& p) { return std::fmin(x.value(p), y.value(p)); }};
      case 7:
        return {fmt::format("clamp({}, 0.0, 1.0)", x.text),
                [=](const Point& p) { return std::fmin(std::fmax(x.value(p), 0.0f), 1.0f); }};
      case 8:
        return {fmt::format("floor({})", x.text), [=](const Point& p) { return std::floor(x.value(p)); }};
      case 9: {
        const Expression c = expression(depth - 1), d = expression(depth - 1);
        return {fmt::format("({} < {} ? {} : {})", x.text, y.text, c.text, d.text),
                [=](const Point& p) { return x.value(p) < y.value(p) ? c.value(p) : d.value(p); }};
      }
      default: {
        const Expression c = expression(depth - 1);
        return {fmt::format("fma({}, {}, {})", x.text, y.text, c.text), [=](const Point& p) {
                  const float product = x.value(p) * y.value(p);
                  return product + c.value(p);
                }};
      }
    }
  }

 private:
  Expression leaf() {
    const std::size_t k = random_() % 4;
    switch (random_() % 3) {
      case 0: return {fmt::format("a[{}]", k), [=](const Point& p) { return p.a[k]; }};
      case 1: return {fmt::format("b[{}]", k), [=](const Point& p) { return p.b[k]; }};
      default: {
        const float v = static_cast<float>(static_cast<int>(random_() % 17) - 8) * 0.25f;
        return {fmt::format("({:.2f})", v), [=](const Point&) { return v; }};
      }
    }
  }
  Random random_;
};

/// An integer program over variables x[0..3], as text and as something to run.
struct Statement {
  std::string text;
  /// 0 goes on, 1 breaks, 2 continues the innermost loop
  std::function<int(std::array<int, 4>&, int depth)> run;
};

class ProgramGenerator {
 public:
  explicit ProgramGenerator(std::uint32_t seed) : random_(seed) {}

  Statement block(int depth, bool in_loop) {
    std::vector<Statement> parts;
    for (std::uint32_t n = random_() % 3 + 1; n > 0; --n) parts.push_back(statement(depth, in_loop));
    std::string text;
    for (const Statement& part : parts) text += part.text;
    return {text, [parts](std::array<int, 4>& x, int d) {
              for (const Statement& part : parts)
                if (const int how = part.run(x, d); how != 0) return how;
              return 0;
            }};
  }

 private:
  Statement statement(int depth, bool in_loop) {
    const std::size_t d = random_() % 4, s = random_() % 4, t = random_() % 4;
    const int k = static_cast<int>(random_() % 5) - 2;
    const std::uint32_t kind = depth == 0 ? random_() % 2 : random_() % 7;
    if (kind == 2 || kind == 3) {
      const Statement yes = block(depth - 1, in_loop), no = block(depth - 1, in_loop);
      return {
          fmt::format("if ((x{} & 3) > x{} - {}) {{ {} }} else {{ {} }} ", s, t, k, yes.text, no.text),
          [=](std::array<int, 4>& x, int n) { return (x[s] & 3) > x[t] - k ? yes.run(x, n) : no.run(x, n); }};
    }
    if (kind == 4) {
      const Statement body = block(depth - 1, true);
      const std::string counter = fmt::format("k{}", counters_++);
      return {fmt::format("for (int {0} = 0; {0} < (x{1} & 7); ++{0}) {{ x{2} += {0}; {3} }} ", counter, s, d,
                          body.text),
              [=](std::array<int, 4>& x, int n) {
                for (int c = 0; c < (x[s] & 7); ++c) {
                  x[d] += c;
                  if (body.run(x, n + 1) == 1) break;
                }
                return 0;
              }};
    }
    if (kind == 5 && in_loop) {
      const bool breaks = random_() % 2 == 0;
      return {fmt::format("if (x{} > x{} + {}) {}; ", s, t, k, breaks ? "break" : "continue"),
              [=](std::array<int, 4>& x, int) { return x[s] > x[t] + k ? (breaks ? 1 : 2) : 0; }};
    }
    if (kind == 6) {
      const Statement first = block(depth - 1, false), second = block(depth - 1, false);
      return {fmt::format("switch (x{} & 3) {{ case 0: {} case 1: {} break; case 3: x{} -= 9; }} ", s,
                          first.text, second.text, d),
              [=](std::array<int, 4>& x, int n) {
                const int selector = x[s] & 3;
                if (selector == 0) first.run(x, n);
                if (selector <= 1) second.run(x, n);
                if (selector == 3) x[d] -= 9;
                return 0;
              }};
    }
    return {fmt::format("x{0} = ((x{1} * {2} + x{3}) & 1023) - 300; ", d, s, k, t),
            [=](std::array<int, 4>& x, int) { return x[d] = ((x[s] * k + x[t]) & 1023) - 300, 0; }};
  }
  Random random_;
  int counters_ = 0;
};

}  // namespace

TEST_CASE("fuzz: random float expressions have the bits of C++") {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    Generator generator(seed);
    std::array<Expression, 4> parts;
    for (Expression& part : parts) part = generator.expression(5);
    RunInput input;
    input.points = assorted_points(seed + 1000);
    INFO(parts[0].text << "\n" << parts[1].text << "\n" << parts[2].text << "\n" << parts[3].text);
    const RunOutput out = run_snippet(fmt::format("color = vec4({}, {}, {}, {});", parts[0].text,
                                                  parts[1].text, parts[2].text, parts[3].text),
                                      input);
    for (int k = 0; k < models::kWarpQuads; ++k)
      for (std::size_t c = 0; c < 4; ++c) {
        const float want = parts[c].value(input.points[static_cast<std::size_t>(k)]), got = out.point(k)[c];
        if (std::isnan(want)) CHECK(std::isnan(got));
        else CHECK(got == want);
      }
  }
}

TEST_CASE("fuzz: random control flow computes what C++ does, lane by lane") {
  for (std::uint32_t seed = 0; seed < 80; ++seed) {
    const Statement program = ProgramGenerator(seed).block(4, false);
    RunInput input;
    input.points = assorted_points(seed + 500);
    INFO(program.text);
    const RunOutput out = run_snippet(
        "int x0 = i.x, x1 = i.y, x2 = i.z, x3 = i.w; " + program.text + " color = vec4(x0, x1, x2, x3);",
        input);
    for (int k = 0; k < models::kWarpQuads; ++k) {
      const auto& i = input.points[static_cast<std::size_t>(k)].i;
      std::array<int, 4> x{i[0], i[1], i[2], i[3]};
      program.run(x, 0);
      for (std::size_t c = 0; c < 4; ++c) CHECK(out.point(k)[c] == static_cast<float>(x[c]));
    }
  }
}

TEST_CASE("fuzz: the same module gives the same program") {
  const std::string source = fragment_source(
      "vec4 s = a; for (int k = 0; k < i.x; ++k) { s = s.yzwx * b; if (s.x > 2.0) break; } color = s;");
  const auto vertex = vertex_spirv(plain_vertex_source());
  const auto fragment = fragment_spirv(source);
  CHECK(models::disassemble(compile_pipeline(vertex, "v", fragment, "f").fragment) ==
        models::disassemble(compile_pipeline(vertex, "v", fragment, "f").fragment));
}

}  // namespace quadrille::pipeline
