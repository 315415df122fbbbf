/// From the outputs of a fragment warp to the pixels of its pass: rules without time, which the functional
/// run uses too.
#pragma once

#include "hw/frame/stores.h"
#include "models/memory/device_memory.h"
#include "models/raster/quad_place.h"

#include <span>

namespace quadrille::hw {

/// Hands the colours and depths that a fragment warp's program wrote to its slot; `outputs` by output slot.
/// A program that writes no depth keeps the interpolated ones. Alpha of a smooth line is multiplied by what
/// it covers of the pixel. Samples that the program's mask or alpha to coverage takes away are not alive any
/// more, nor is a lane that has none left.
void take_outputs(const DrawState& draw, std::span<const models::LaneWords> outputs,
                  const models::FragmentInputs& inputs, WarpSlot& warp);

/// A quad of a warp, and where its pixels lie.
struct QuadOfWarp {
  int number = 0;  ///< in the warp
  models::QuadPlace place;
  models::LaneMask lanes = 0;  ///< to write, bits 0..3
  int sample = 0;              ///< of these pixels
};
/// What the tests of a quad, of one or all of its samples, came to.
struct QuadOutcome {
  models::LaneMask passed = 0;  ///< lanes of which a sample passed
  int stencil_written = 0;      ///< samples whose stencil value was operated on
};
/// Tests a quad against the depths and stencil values stored in its tile, and writes where it shall. Depths
/// are the program's, or else those of the triangle at the sample.
[[nodiscard]] QuadOutcome test_depth(const DrawState& draw, const WarpSlot& warp,
                                     const models::TriangleSetup& triangle, const QuadOfWarp& quad,
                                     models::DepthPlane stored);
/// The plane of one sample in a tile of a depth attachment.
[[nodiscard]] models::DepthPlane depth_plane(const AttachmentState& depth, models::DeviceMemory& memory,
                                             std::uint32_t tile_x, std::uint32_t tile_y,
                                             std::uint32_t sample);
/// Tests all samples of a quad that are alive, and takes those from `warp` that fail.
/// `plane_of(sample)` is the tile's `DepthPlane`.
template <class PlaneOf>
QuadOutcome test_samples(const DrawState& draw, WarpSlot& warp, const models::TriangleSetup& triangle,
                         QuadOfWarp quad, const PlaneOf& plane_of) {
  const int count = draw.samples().count;
  QuadOutcome outcome;
  for (quad.sample = 0; quad.sample < count; ++quad.sample) {
    quad.lanes = warp.lanes_of(quad.number, count, quad.sample);
    if (quad.lanes == 0) continue;
    const auto [passed, stencil_written] = test_depth(draw, warp, triangle, quad, plane_of(quad.sample));
    outcome.passed |= passed;
    outcome.stencil_written += stencil_written;
    for (unsigned i = 0; i < 4; ++i) {
      std::uint8_t& samples = warp.samples[4 * static_cast<std::size_t>(quad.number) + i];
      if ((quad.lanes & ~passed & 1u << i) != 0)
        samples = static_cast<std::uint8_t>(samples & ~(1u << quad.sample));
    }
  }
  return outcome;
}
/// Blends a quad's colours into one attachment of its pass.
void write_color(const DrawState& draw, const PassState& pass, std::size_t attachment, const WarpSlot& warp,
                 const QuadOfWarp& quad, models::DeviceMemory& memory);
/// Writes the means of the samples in one tile of a colour attachment to what it is resolved to.
void resolve_tile(const PassState& pass, std::size_t attachment, std::uint32_t tile_x, std::uint32_t tile_y,
                  models::DeviceMemory& memory);

}  // namespace quadrille::hw
