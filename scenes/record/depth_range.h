/// Between which window depths a frame's primitives lie.
#pragma once

#include <limits>

#include <glm/ext/vector_double4.hpp>

#include <array>
#include <optional>

#include "scenes/material/frame_block.h"

namespace quadrille::scenes {

/// Takes triangles, lines (a corner twice) and points (a corner three times) in clip space, and keeps the
/// least and the greatest window depth of what of them is in the picture. Depth is linear in the window, so
/// these are depths of corners after clipping.
class DepthRangeFinder {
 public:
  using Triangle = std::array<glm::dvec4, 3>;
  void add(const Triangle& corners);
  /// None: nothing was in the picture.
  [[nodiscard]] std::optional<DepthRange> range() const;

 private:
  double least_ = std::numeric_limits<double>::infinity(), greatest_ = -least_;
};

}  // namespace quadrille::scenes
