/// Triangles for benches of units behind set-up, made by the real set-up from whole pixel positions.
#pragma once

#include "hw/frame/stores.h"
#include "models/raster/triangle_setup.h"

namespace quadrille::hw::bench {

/// A triangle with corners in pixels at one depth, within a target of 64 x 64 pixels.
[[nodiscard]] inline TriangleSlot flat_triangle(std::array<glm::ivec2, 3> corners, float depth = 0.5f,
                                                std::uint32_t draw = 0) {
  std::array<models::WindowVertex, 3> vertices;
  for (std::size_t i = 0; i < 3; ++i) vertices[i] = {corners[i].x * 256, corners[i].y * 256, depth, 1.0f};
  models::SetupState state;
  state.scissor = {0, 0, 64, 64};
  TriangleSlot slot;
  slot.draw = DrawId(draw);
  const models::SetupOutcome outcome =
      models::setup_triangle(vertices, models::whole_triangle_weights(), state, slot.setup);
  QUADRILLE_CHECK(outcome == models::SetupOutcome::kKept, "the test's triangle is not kept");
  return slot;
}

}  // namespace quadrille::hw::bench
