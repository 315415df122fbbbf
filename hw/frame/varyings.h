/// From the outputs of three vertices to the inputs of a fragment warp: rules without time, which the
/// functional run uses too.
#pragma once

#include "hw/frame/stores.h"
#include "models/shader/warp.h"

#include <array>
#include <vector>

namespace quadrille::hw {

/// Outputs of a shaded vertex: a lane of its batch's rows.
struct CornerOutputs {
  const std::vector<models::LaneWords>* rows = nullptr;
  std::uint8_t lane = 0;
};
/// Fills a triangle slot's varyings, 3 floats a component: a0, a1 - a0, a2 - a0 of the corners.
void gather_varyings(const std::array<CornerOutputs, 3>& corners, int components, std::vector<float>& out);

/// The inputs of a fragment warp: planes of its quads' triangles at their pixels. Quads that are not used
/// repeat the last one's varyings. `smooth`: they are of smooth lines, whose coverage counts.
void fill_fragment_inputs(const WarpSlot& work, const TriangleStore& triangles, bool smooth,
                          models::FragmentInputs& inputs);

}  // namespace quadrille::hw
