#include "hw/frame/varyings.h"

#include "models/raster/fine.h"
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

void fill_line_coverage(const TriangleSlot& line, const WarpSlot::Quad& quad,
                        const models::PixelOffset& from_centre, int q, models::FragmentInputs& inputs) {
  for (int i = 0; i < models::kQuadPixels; ++i) {
    const double x = quad.x + (i & 1) + (0.5 + from_centre.x) - line.setup.ref_x,
                 y = quad.y + (i >> 1) + (0.5 + from_centre.y) - line.setup.ref_y;
    inputs.line_coverage[static_cast<std::size_t>(4 * q + i)] = line.line.at(x, y);
  }
}

/// The same quad at the places of centroid varyings, and what it covers.
void fill_coverage(const DrawState& draw, const models::TriangleSetup& triangle, const WarpSlot::Quad& quad,
                   int q, models::FragmentInputs& inputs) {
  const models::SampleGrid& samples = draw.samples();
  for (int i = 0; i < models::kQuadPixels; ++i) {
    const auto lane = static_cast<std::size_t>(4 * q + i);
    const int x = quad.x + (i & 1), y = quad.y + (i >> 1);
    const std::uint32_t covered = models::covered_samples(triangle, x, y, samples) & draw.sample_mask;
    inputs.sample_mask[lane] = draw.by_sample ? covered & 1u << quad.sample : covered;
    models::VertexWeights at{inputs.persp_1[lane], inputs.persp_2[lane], inputs.linear_1[lane],
                             inputs.linear_2[lane]};
    if (!draw.by_sample && covered != 0 && covered != samples.all()) {
      const models::PixelOffset first = samples.from_centre(std::countr_zero(covered));
      at = models::weights_at(triangle, x + (0.5 + first.x), y + (0.5 + first.y));
    }
    inputs.centroid_persp_1[lane] = at.persp_1;
    inputs.centroid_persp_2[lane] = at.persp_2;
    inputs.centroid_linear_1[lane] = at.linear_1;
    inputs.centroid_linear_2[lane] = at.linear_2;
  }
}

void fill_sample(const WarpSlot::Quad& quad, const models::PixelOffset& from_centre, int q,
                 models::FragmentInputs& inputs) {
  const auto first = static_cast<std::ptrdiff_t>(4 * q);
  std::fill_n(inputs.sample_id.begin() + first, 4, quad.sample);
  std::fill_n(inputs.sample_x.begin() + first, 4, static_cast<float>(0.5 + from_centre.x));
  std::fill_n(inputs.sample_y.begin() + first, 4, static_cast<float>(0.5 + from_centre.y));
}

}  // namespace

void fill_fragment_inputs(const DrawState& draw, const WarpSlot& work, const TriangleStore& triangles,
                          models::FragmentInputs& inputs) {
  const bool smooth = draw.smooth_lines();
  for (int q = 0; q < models::kWarpQuads; ++q) {
    const WarpSlot::Quad& quad = work.quad[static_cast<std::size_t>(std::min(q, work.quads - 1))];
    const TriangleSlot& triangle = triangles[quad.triangle];
    inputs.varyings[static_cast<std::size_t>(q)] = triangle.varyings.data();
    if (q >= work.quads) continue;
    const models::PixelOffset from_centre =
        draw.by_sample ? draw.samples().from_centre(quad.sample) : models::PixelOffset{};
    models::interpolate_quad(triangle.setup, quad.x, quad.y, q, inputs, from_centre);
    if (draw.fragment.program->by_sample) fill_sample(quad, from_centre, q, inputs);
    if (draw.reads_coverage) fill_coverage(draw, triangle.setup, quad, q, inputs);
    if (smooth) fill_line_coverage(triangle, quad, from_centre, q, inputs);
    for (std::size_t i = 0; i < 4; ++i)
      inputs.primitive_id[4 * static_cast<std::size_t>(q) + i] = triangle.primitive;
  }
}

}  // namespace quadrille::hw
