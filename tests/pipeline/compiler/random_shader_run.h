/// What a random shader computes: compiled and run by the shader core's model, and in double precision by the
/// reference's interpreter.
#pragma once

#include "models/shader/isa.h"
#include "pipeline/compiler/target.h"
#include "tests/pipeline/compiler/random_shader.h"

#include <array>
#include <cstdint>

namespace quadrille::pipeline {

/// The four bytes that each pixel or vertex of a random shader writes (red lowest), or `kDiscarded`. Lanes
/// are in the order of a warp: eight quads side by side, or 32 vertices.
inline constexpr std::uint64_t kDiscarded = std::uint64_t{1} << 32;
using RandomShaderResult = std::array<std::uint64_t, models::kWarpLanes>;

/// Where lane `lane` of a fragment shader's warp lies: pixel centres, x in 16 .. 32, y in 20 .. 22.
struct LanePlace {
  float x, y;
};
[[nodiscard]] LanePlace place_of_lane(std::size_t lane);

/// `UserError` if it cannot be compiled.
[[nodiscard]] RandomShaderResult run_compiled(const RandomShader& shader, const ShaderTarget& target = {});
[[nodiscard]] RandomShaderResult run_in_reference(const RandomShader& shader);

}  // namespace quadrille::pipeline
