/// Short loops are written out where literals decide when they end. These end, or may end, where a lane's own
/// values say so, or are too many.
#include "tests/pipeline/compiler/integer_snippets.h"

#include <catch2/catch.hpp>

#include <bit>
#include <string>

namespace quadrille::pipeline {

TEST_CASE("short loops: a short loop left under a condition of the lane") {
  check("int s = 0; for (int k = 0; k < 3; ++k) { if (i.x < 0) break; s += 1; } color = vec4(s);",
        [](int x, int, int, int) { return x < 0 ? 0 : 3; });
  check(
      "int s = 0; [[unroll]] for (int k = 0; k < 20; ++k) { if (k > i.x) break; s += k; } color = vec4(s);",
      [](int x, int, int, int) {
        int s = 0;
        for (int k = 0; k < 20 && k <= x; ++k) s += k;
        return s;
      },
      "#extension GL_EXT_control_flow_attributes : require");
  check(
      "int s = 0; do { if (i.x < 0) break; s = 5; if (i.y < 0) break; s += 9; } while (false); color = "
      "vec4(s);",
      [](int x, int y, int, int) { return x < 0   ? 0
                                          : y < 0 ? 5
                                                  : 14; });
}

TEST_CASE("short loops: a break in a short loop leaves that loop and not the one around it") {
  check(
      "int s = 0; for (int j = 0; j < 100; ++j) { for (int k = 0; k < 4; ++k) { if (k > i.x) break; s += 1; "
      "} } color = vec4(s);",
      [](int x, int, int, int) { return 100 * std::clamp(x + 1, 0, 4); });
  check(
      "int s = 0; for (int j = 0; j < 3; ++j) { for (int k = 0; k < 4; ++k) { if (k > i.x) break; s += 1; } "
      "s += 10; } color = vec4(s);",
      [](int x, int, int, int) { return 3 * (std::clamp(x + 1, 0, 4) + 10); });
  check(
      "int s = 0; for (int j = 0; j < i.y; ++j) { do { if (s > i.x) break; s += 2; } while (false); s += 1; "
      "} color = vec4(s);",
      [](int x, int y, int, int) {
        int s = 0;
        for (int j = 0; j < y; ++j) s += s > x ? 1 : 3;
        return s;
      });
}

TEST_CASE("short loops: a return from a short loop of a called function leaves the function and no more") {
  const std::string first =
      "int first(int limit) { for (int k = 0; k < 5; ++k) { if (k * k > limit) return k; } return -1; }";
  const auto expected_first = [](int limit) {
    for (int k = 0; k < 5; ++k) {
      if (k * k > limit) return k;
    }
    return -1;
  };
  check(
      "int s = 0; for (int j = 0; j < 9; ++j) s = s * 2 + first(i.x + j); color = vec4(s);",
      [&](int x, int, int, int) {
        int s = 0;
        for (int j = 0; j < 9; ++j) s = s * 2 + expected_first(x + j);
        return s;
      },
      first);
}

TEST_CASE("short loops: what follows the last iteration of a loop that is written out is not run") {
  check(
      "int s = 0; for (int k = 0; k < 6; ++k) { s += i.x; if (k == 3) { s += 1; break; } s += 100; } color = "
      "vec4(s);",
      [](int x, int, int, int) { return 4 * x + 301; });
  check("int s = 0; for (int k = 0; ; ++k) { if (k == 3) break; s += i.x; } color = vec4(s);",
        [](int x, int, int, int) { return 3 * x; });
}

TEST_CASE("short loops: a vertex shader leaves a short loop under a condition of the lane") {
  const auto vertex = vertex_spirv(R"(#version 450
layout(location=0) in vec4 p; layout(location=0) out vec4 a;
void main() { float s = 0.0; for (int k = 0; k < 3; ++k) { if (float(k) > p.x) break; s += 1.0; } gl_Position = p; a = vec4(s); })");
  const auto fragment = fragment_spirv(
      "#version 450\nlayout(location=0) in vec4 a; layout(location=0) out vec4 o; void main() { o = a; }");
  const auto outputs = run_vertex(compile_pipeline(vertex, "v", fragment, "f").vertex,
                                  [](int, int, int lane) { return static_cast<float>(lane % 5) - 1.5f; });
  for (std::size_t lane = 0; lane < models::kWarpLanes; ++lane) {
    const float x = static_cast<float>(lane % 5) - 1.5f;
    CHECK(std::bit_cast<float>(outputs[4][lane]) == (x < 0 ? 0.0f : x < 1 ? 1.0f : x < 2 ? 2.0f : 3.0f));
  }
}

TEST_CASE("short loops: short loops nested so deeply that they cannot all be written out") {
  const auto loop = [](int k) {
    return "for (int k" + std::to_string(k) + " = 0; k" + std::to_string(k) + " < 8; ++k" +
           std::to_string(k) + ") ";
  };
  const std::string nest = loop(0) + loop(1) + loop(2) + loop(3) + loop(4) + "++s; ";
  check("int s = 0; " + nest + "color = vec4(s + i.x);", [](int x, int, int, int) { return 32768 + x; });
  std::string row = "int s = 0; ";
  for (int k = 0; k < 40; ++k) row += loop(1) + loop(2) + loop(3) + "++s; ";
  check(row + "color = vec4(s + i.x);", [](int x, int, int, int) { return 40 * 512 + x; });
}

}  // namespace quadrille::pipeline
