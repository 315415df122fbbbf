/// Runs snippets of GLSL through the compiler and the warp model, so that tests can compare what comes out
/// with C++.
///
/// A warp carries eight points, one a quad; all four lanes of a quad see the same inputs, apart from
/// gl_FragCoord.
#pragma once

#include "models/shader/warp.h"
#include "pipeline/compiler/compile.h"

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace quadrille::pipeline {

/// Random 32-bit words, the same everywhere.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  std::uint32_t operator()() { return static_cast<std::uint32_t>(engine_()); }

 private:
  std::mt19937 engine_;
};

using Vec4 = std::array<float, 4>;
struct Point {
  Vec4 a{}, b{};                    ///< floats "a" and "b" of the snippet
  std::array<std::int32_t, 4> i{};  ///< flat integers "i"
};
using Points = std::array<Point, models::kWarpQuads>;

struct RunInput {
  Points points{};
  /// (set, binding) -> words
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> blocks;
  std::vector<std::uint32_t> push_constants;
  /// (binding index, u, v, level or bias) -> rgba
  std::function<Vec4(int, float, float, float)> texture = [](int, float u, float v, float) {
    return Vec4{u, v, 0, 1};
  };
};

struct RunOutput {
  std::array<Vec4, models::kWarpLanes> color{};
  std::array<float, models::kWarpLanes> depth{};
  models::LaneMask killed = 0;
  int clauses = 0;
  [[nodiscard]] Vec4 point(int k) const { return color[static_cast<std::size_t>(4 * k)]; }
};

/// The fragment shader around a snippet: `declarations` at module scope; `body` reads vec4 a, vec4 b, ivec4 i
/// and writes vec4 color.
[[nodiscard]] std::string fragment_source(const std::string& body, const std::string& declarations = {});
/// A vertex shader that writes every varying which `fragment_source` declares.
[[nodiscard]] std::string plain_vertex_source();
[[nodiscard]] std::vector<std::uint32_t> fragment_spirv(const std::string& source);
[[nodiscard]] std::vector<std::uint32_t> vertex_spirv(const std::string& source);
/// Compiles a whole fragment shader with `plain_vertex_source`.
[[nodiscard]] models::Program compile_fragment(const std::string& source, const ShaderTarget& target = {});
/// The words of a draw's constant file.
[[nodiscard]] std::vector<std::uint32_t> constant_file(const models::ConstantLayout& layout,
                                                       const RunInput& input);
/// `storage`: of a program with storage buffers.
[[nodiscard]] RunOutput run_fragment(const models::Program& program, const RunInput& input,
                                     models::WarpStorage* storage = nullptr);
/// Both steps for a snippet.
[[nodiscard]] RunOutput run_snippet(const std::string& body, const RunInput& input,
                                    const std::string& declarations = {});
/// Eight points of assorted values, by seed.
[[nodiscard]] Points assorted_points(std::uint32_t seed);
/// Outputs of a vertex program for 32 vertices: rows by output slot.
[[nodiscard]] std::vector<models::LaneWords> run_vertex(
    const models::Program& program,
    const std::function<float(int location, int component, int lane)>& attribute, const RunInput& input = {});

}  // namespace quadrille::pipeline
