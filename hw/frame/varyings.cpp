#include "hw/frame/varyings.h"

#include "models/raster/interpolate.h"

#include <algorithm>
#include <bit>

namespace quadrille::hw {

void gather_varyings(const std::array<CornerOutputs, 3>& corners, int components, std::vector<float>& out) {
  out.resize(static_cast<std::size_t>(3 * components));
  for (int c = 0; c < components; ++c) {
    const auto value = [&](std::size_t i) {
      return std::bit_cast<float>(
          (*corners[i].rows)[static_cast<std::size_t>(models::kFirstVaryingOutput + c)][corners[i].lane]);
    };
    const float a0 = value(0);
    float* const at = out.data() + 3 * c;
    at[0] = a0;
    at[1] = value(1) - a0;
    at[2] = value(2) - a0;
  }
}

namespace {

void fill_line_coverage(const TriangleSlot& line, const WarpSlot::Quad& quad, int q,
                        models::FragmentInputs& inputs) {
  for (int i = 0; i < models::kQuadPixels; ++i) {
    const double x = quad.x + (i & 1) + 0.5 - line.setup.ref_x,
                 y = quad.y + (i >> 1) + 0.5 - line.setup.ref_y;
    inputs.line_coverage[static_cast<std::size_t>(4 * q + i)] = line.line.at(x, y);
  }
}

}  // namespace

void fill_fragment_inputs(const WarpSlot& work, const TriangleStore& triangles, bool smooth,
                          models::FragmentInputs& inputs) {
  for (int q = 0; q < models::kWarpQuads; ++q) {
    const WarpSlot::Quad& quad = work.quad[static_cast<std::size_t>(std::min(q, work.quads - 1))];
    const TriangleSlot& triangle = triangles[quad.triangle];
    inputs.varyings[static_cast<std::size_t>(q)] = triangle.varyings.data();
    if (q >= work.quads) continue;
    models::interpolate_quad(triangle.setup, quad.x, quad.y, q, inputs);
    if (smooth) fill_line_coverage(triangle, quad, q, inputs);
    for (std::size_t i = 0; i < 4; ++i)
      inputs.primitive_id[4 * static_cast<std::size_t>(q) + i] = triangle.primitive;
  }
}

}  // namespace quadrille::hw
