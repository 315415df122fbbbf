/// Snippets whose result is an integer, held against the same code in C++.
#pragma once

#include "tests/pipeline/compiler/shader_runner.h"

#include <catch2/catch.hpp>

#include <string>

namespace quadrille::pipeline {

/// Runs a snippet that writes an integer result for integer inputs and compares every point with `expected`.
template <class Expected>
void check(const std::string& body, Expected expected, const std::string& declarations = {}) {
  INFO(body);
  for (const std::uint32_t seed : {11u, 12u, 13u}) {
    RunInput input;
    input.points = assorted_points(seed);
    const RunOutput out = run_snippet(body, input, declarations);
    for (int k = 0; k < models::kWarpQuads; ++k) {
      const auto& p = input.points[static_cast<std::size_t>(k)];
      INFO("i = " << p.i[0] << ", " << p.i[1] << ", " << p.i[2] << ", " << p.i[3]);
      CHECK(out.point(k)[0] == static_cast<float>(expected(p.i[0], p.i[1], p.i[2], p.i[3])));
    }
  }
}

}  // namespace quadrille::pipeline
