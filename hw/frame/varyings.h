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

/// The inputs of a fragment warp: planes of its quads' triangles at their pixels' centres, or at the samples
/// that its draw is shaded by. Quads that are not used repeat the last one's varyings.
///
/// A centroid varying is taken at the first covered sample where not all are covered. What is covered is
/// decided anew from the triangle: what depth tests have left of it would depend on timing.
void fill_fragment_inputs(const DrawState& draw, const WarpSlot& work, const TriangleStore& triangles,
                          models::FragmentInputs& inputs);

}  // namespace quadrille::hw
