/// Structured control flow with lanes that diverge, against the same code in C++.
#include "tests/pipeline/compiler/integer_snippets.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

namespace quadrille::pipeline {

TEST_CASE("control flow: nested selections") {
  check(
      "int r = 0; if (i.x > 0) { if (i.y > 0) r = i.x * 3; else { r = i.y - 5; if (i.z > 3) r += 100; } } "
      "else if (i.z < 0) { r = -7; } "
      "color = vec4(r);",
      [](int x, int y, int z, int) {
        int r = 0;
        if (x > 0) {
          if (y > 0) r = x * 3;
          else {
            r = y - 5;
            if (z > 3) r += 100;
          }
        } else if (z < 0) {
          r = -7;
        }
        return r;
      });
}

TEST_CASE("control flow: a loop whose count differs from lane to lane") {
  check("int s = 0; for (int k = 0; k < i.x + 20; ++k) s += k * k; color = vec4(s);",
        [](int x, int, int, int) {
          int s = 0;
          for (int k = 0; k < x + 20; ++k) s += k * k;
          return s;
        });
}

TEST_CASE("control flow: break and continue inside selections inside nested loops") {
  check(R"(int s = 0;
for (int j = 0; j < 7; ++j) {
  if (j == i.w) continue;
  for (int k = 0; ; ++k) {
    if (k > abs(i.x)) break;
    if ((k & 1) == 1) { if (k == i.y) break; continue; }
    s += k * j + 1;
    if (s > 300) { s -= 7; break; }
  }
  if (s > 500) break;
}
color = vec4(s);)",
        [](int x, int y, int, int w) {
          int s = 0;
          for (int j = 0; j < 7; ++j) {
            if (j == w) continue;
            for (int k = 0;; ++k) {
              if (k > std::abs(x)) break;
              if ((k & 1) == 1) {
                if (k == y) break;
                continue;
              }
              s += k * j + 1;
              if (s > 300) {
                s -= 7;
                break;
              }
            }
            if (s > 500) break;
          }
          return s;
        });
}

TEST_CASE("control flow: do-while with continue tests its condition") {
  check(
      "int s = 0, k = abs(i.x); do { --k; if ((k & 3) == 2) continue; s += k; } while (k > i.y && k > -50); "
      "color = vec4(s * 100 + k);",
      [](int x, int y, int, int) {
        int s = 0, k = std::abs(x);
        do {
          --k;
          if ((k & 3) == 2) continue;
          s += k;
        } while (k > y && k > -50);
        return s * 100 + k;
      });
}

TEST_CASE("control flow: values that swap in a loop") {
  check(
      "int x = i.x, y = i.y, n = abs(i.z); for (int k = 0; k < n; ++k) { int t = x; x = y; y = t - y; } "
      "color = vec4(x * 64 + y);",
      [](int x, int y, int z, int) {
        for (int k = 0; k < std::abs(z); ++k) {
          const int t = x;
          x = y;
          y = t - y;
        }
        return x * 64 + y;
      });
}

TEST_CASE("control flow: switch with fall-through, default and breaks inside selections") {
  const std::string body = R"(int r = 1;
switch (i.x & 7) {
  case 0: r = 10; break;
  case 1: r = 20;
  case 2: r += 5; if (i.y > 0) break; r += 1000; break;
  case 3: case 4: if (i.z > 0) { r = 7; break; } r = 8; break;
  default: r = -r - i.y;
}
color = vec4(r);)";
  check(body, [](int x, int y, int z, int) {
    int r = 1;
    switch (x & 7) {
      case 0: r = 10; break;
      case 1: r = 20; [[fallthrough]];
      case 2:
        r += 5;
        if (y > 0) break;
        r += 1000;
        break;
      case 3:
      case 4:
        if (z > 0) {
          r = 7;
          break;
        }
        r = 8;
        break;
      default: r = -r - y;
    }
    return r;
  });
}

TEST_CASE("control flow: a switch inside a loop with continue and break of the loop") {
  check(R"(int s = 0;
for (int k = 0; k < 12; ++k) {
  switch ((i.x + k) & 3) {
    case 0: if (i.y > k) { s += 1; continue; } s += 2; break;
    case 1: if (k > abs(i.z)) { s += 1000; break; } s += 4; break;
    case 2: if (s > 40) break; s += 10;
    default: s += 3;
  }
  if (s > 100) break;
}
color = vec4(s);)",
        [](int x, int y, int z, int) {
          int s = 0;
          for (int k = 0; k < 12; ++k) {
            switch ((x + k) & 3) {
              case 0:
                if (y > k) {
                  s += 1;
                  continue;
                }
                s += 2;
                break;
              case 1:
                if (k > std::abs(z)) {
                  s += 1000;
                  break;
                }
                s += 4;
                break;
              case 2:
                if (s > 40) break;
                s += 10;
                [[fallthrough]];
              default: s += 3;
            }
            if (s > 100) break;
          }
          return s;
        });
}

TEST_CASE("control flow: early returns of functions, also from inside loops") {
  check(
      "color = vec4(find(i.x, i.y) * 10 + find(i.z, i.w));",
      [](int x, int y, int z, int w) {
        const auto find = [](int p, int q) {
          if (p > 10) return 1;
          for (int k = 0; k < 15; ++k) {
            if (k * k > p + 20) return k;
            for (int j = 0; j < 3; ++j)
              if (j + k == q) return 100 + j;
          }
          return -1;
        };
        return find(x, y) * 10 + find(z, w);
      },
      "int find(int p, int q) { if (p > 10) return 1; for (int k = 0; k < 15; ++k) { if (k * k > p + 20) "
      "return k; "
      "for (int j = 0; j < 3; ++j) if (j + k == q) return 100 + j; } return -1; }");
}

TEST_CASE("control flow: unrolled and rolled loops agree, and unrolling leaves no loop") {
  for (const char* hint : {"[[unroll]]", "[[dont_unroll]]"}) {
    const std::string body =
        std::string("int s = i.x; ") + hint +
        " for (int k = 0; k < 9; ++k) { if (k == 4) s *= 2; s += k * i.y; } color = vec4(s);";
    const std::string extension = "#extension GL_EXT_control_flow_attributes : require\n";
    check(
        body,
        [](int x, int y, int, int) {
          int s = x;
          for (int k = 0; k < 9; ++k) {
            if (k == 4) s *= 2;
            s += k * y;
          }
          return s;
        },
        extension);
    const models::Program p = compile_fragment(fragment_source(body, extension));
    const bool has_loop = std::any_of(p.code.begin(), p.code.end(),
                                      [](const models::Instruction& i) { return i.op == models::Op::kLoop; });
    CHECK(has_loop == (std::string(hint) == "[[dont_unroll]]"));
  }
}

TEST_CASE("control flow: local arrays indexed at run time, written and read") {
  check(
      "int t[6]; for (int k = 0; k < 6; ++k) t[k] = k * i.x; t[abs(i.y) % 6] = 77; int s = 0; for (int k = "
      "0; k < 6; ++k) s = s * 3 + t[(k "
      "+ abs(i.z)) % 6]; "
      "color = vec4(s & 4095);",
      [](int x, int y, int z, int) {
        int t[6];
        for (int k = 0; k < 6; ++k) t[k] = k * x;
        t[std::abs(y) % 6] = 77;
        int s = 0;
        for (int k = 0; k < 6; ++k) s = s * 3 + t[(k + std::abs(z)) % 6];
        return s & 4095;
      });
  check("const int t[5] = int[](3, 1, 4, 1, 5); color = vec4(t[abs(i.x) % 5] * 10 + t[abs(i.y) % 5]);",
        [](int x, int y, int, int) {
          const int t[5] = {3, 1, 4, 1, 5};
          return t[std::abs(x) % 5] * 10 + t[std::abs(y) % 5];
        });
}

TEST_CASE("control flow: discard marks lanes and the others go on") {
  RunInput input;
  input.points = assorted_points(3);
  const RunOutput out = run_snippet("if (i.x > 0) discard; color = vec4(i.x);", input);
  for (int k = 0; k < models::kWarpQuads; ++k) {
    const bool dies = input.points[static_cast<std::size_t>(k)].i[0] > 0;
    CHECK(((out.killed >> (4 * k)) & 0xfu) == (dies ? 0xfu : 0u));
    if (!dies) CHECK(out.point(k)[0] == static_cast<float>(input.points[static_cast<std::size_t>(k)].i[0]));
  }
  const models::Program p = compile_fragment(fragment_source("if (a.x > 0.5) discard; color = a;"));
  CHECK(p.uses_discard);
  CHECK(std::none_of(p.code.begin(), p.code.end(),
                     [](const models::Instruction& i) { return i.op == models::Op::kIf; }));
}

TEST_CASE("control flow: a lane discarded inside nested loops that only end by its own values leaves them") {
  RunInput input;
  input.points = assorted_points(5);
  const std::string body = R"(int s = 0;
while (true) {
  while (true) { if (s > abs(i.x)) discard; s += 3; if ((s & 3) == (i.y & 3)) break; }
  s += 2;
  if (s > abs(i.z) * 2 + 8) break;
}
color = vec4(s);)";
  const RunOutput out = run_snippet(body, input);
  for (int k = 0; k < models::kWarpQuads; ++k) {
    const auto& i = input.points[static_cast<std::size_t>(k)].i;
    int s = 0;
    bool dead = false, done = false;
    while (!done && !dead) {
      for (;;) {
        if (s > std::abs(i[0])) {
          dead = true;
          break;
        }
        s += 3;
        if ((s & 3) == (i[1] & 3)) break;
      }
      s += 2;
      done = s > std::abs(i[2]) * 2 + 8;
    }
    CHECK((((out.killed >> (4 * k)) & 1u) != 0) == dead);
    if (!dead) CHECK(out.point(k)[0] == static_cast<float>(s));
  }
}

TEST_CASE("control flow: derivatives are differences within the quad") {
  RunInput input;
  const RunOutput out = run_snippet(
      "float f = gl_FragCoord.x * gl_FragCoord.x + 3.0 * gl_FragCoord.y; color = vec4(dFdx(f), dFdy(f), "
      "fwidth(f), 0);",
      input);
  for (int lane = 0; lane < models::kWarpLanes; ++lane) {
    const int quad = lane / 4;
    const float x = 10.5f + 2.0f * static_cast<float>(quad);
    const float dx = (x + 1) * (x + 1) - x * x;
    CHECK(out.color[static_cast<std::size_t>(lane)] == Vec4{dx, 3.0f, dx + 3.0f, 0.0f});
  }
}

TEST_CASE("control flow: a switch whose default falls into a case") {
  const auto expected = [](int x, int, int, int) {
    int r = 1;
    switch (x & 7) {
      case 2: r = 40; [[fallthrough]];
      default: r += 5; [[fallthrough]];
      case 0: r *= 3; [[fallthrough]];
      case 1: r += 1; break;
      case 4: r = 9;
    }
    return r;
  };
  check(
      "int r = 1; switch (i.x & 7) { case 2: r = 40; default: r += 5; case 0: r *= 3; case 1: r += 1; break; "
      "case 4: r = 9; } color = "
      "vec4(r);",
      expected);
}

TEST_CASE("control flow: a called function that discards, wherever it is called") {
  const std::string functions = R"(int s = 0;
bool stop(int at) { if (at > i.x) discard; return false; }
int always() { discard; return 1; }
void deeper(int at) { for (int k = 0; k < 3; ++k) { if (k + at == i.y) discard; } }
bool both(int at) { deeper(at); return stop(at); })";
  const auto dies = [&](const std::string& body, auto expected) {
    INFO(body);
    RunInput input;
    input.points = assorted_points(21);
    const RunOutput out = run_snippet(body + " color = vec4(s);", input, functions);
    for (int k = 0; k < models::kWarpQuads; ++k) {
      const auto& p = input.points[static_cast<std::size_t>(k)].i;
      INFO("i = " << p[0] << ", " << p[1]);
      CHECK(((out.killed >> (4 * k)) & 0xfu) == (expected(p[0], p[1]) ? 0xfu : 0u));
      if (!expected(p[0], p[1])) CHECK(out.point(k)[0] == 5.0f);
    }
  };
  dies("s = 5; if (i.x < 0) s = always();", [](int x, int) { return x < 0; });
  dies("do { ++s; } while (s < 5 && !stop(s));", [](int x, int) { return x < 4; });
  dies("for (s = 0; s < 5; s += stop(s) ? 2 : 1) {}", [](int x, int) { return x < 4; });
  dies("for (int j = 0; j < 2; ++j) { s = 0; do { ++s; } while (s < 5 && !both(s)); }",
       [](int x, int y) { return x < 4 || (y >= 1 && y <= 6); });
  // Only the function ends this loop; what it returns after a discard does not.
  dies("do { if (i.x >= 4) { s = 5; break; } ++s; } while (!stop(s) || s < 100); s = 5;",
       [](int x, int) { return x < 4; });
}

}  // namespace quadrille::pipeline
