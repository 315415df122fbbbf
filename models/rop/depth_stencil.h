/// The tests of stored depths and stencil values: depth bounds, then stencil, then depth. [VK1.3 #fragops]
#pragma once

#include "models/base/pipeline_state.h"
#include "models/rop/depth_plane.h"

#include <array>
#include <cstdint>

namespace quadrille::models {

struct DepthStencilState {
  bool depth_test = false, depth_write = false;
  CompareOp depth_compare = CompareOp::kLess;
  DepthBoundsTest bounds{};
  StencilState stencil{};
  /// Does a fragment have to meet what is stored?
  [[nodiscard]] bool tests() const { return depth_test || bounds.test || stencil.test; }
  [[nodiscard]] bool writes() const {
    return (depth_test && depth_write) || (stencil.test && (stencil.front.writes() || stencil.back.writes()));
  }
  /// A fragment that fails the depth test leaves nothing behind, so that it may be dropped before its turn.
  [[nodiscard]] bool keeps_when_hidden() const {
    return !stencil.test || (stencil.front.keeps_when_hidden() && stencil.back.keeps_when_hidden());
  }
  [[nodiscard]] const StencilFace& face(bool front) const { return front ? stencil.front : stencil.back; }
};

/// What the tests of a tile's pixels come to. Pixels by bit, quad-major (raster/tile.h).
struct DepthStencilOutcome {
  std::uint64_t passed = 0;
  std::uint64_t depth_written = 0;
  std::uint64_t stencil_written = 0;       ///< values may be what they were
  std::array<std::uint8_t, 64> stencil{};  ///< new values, where they are written
  [[nodiscard]] std::uint64_t written() const { return depth_written | stencil_written; }
};

/// Tests the pixels of `mask` of a triangle that faces the viewer or not; changes nothing yet. `incoming` are
/// depths that the format can hold.
[[nodiscard]] DepthStencilOutcome test_depth_stencil(const DepthStencilState& state, bool front,
                                                     const DepthPlane& stored, const float incoming[64],
                                                     std::uint64_t mask);
/// Writes what the outcome says.
void write_depth_stencil(const DepthStencilOutcome& outcome, const float incoming[64], DepthPlane& stored);

/// A stored value under an operation, before the write mask.
[[nodiscard]] std::uint8_t stencil_value(StencilOp op, std::uint8_t stored, std::uint8_t reference);

}  // namespace quadrille::models
