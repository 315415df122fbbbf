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
/// it covers of the pixel.
void take_outputs(const DrawState& draw, std::span<const models::LaneWords> outputs,
                  const models::FragmentInputs& inputs, WarpSlot& warp);

/// A quad of a warp, and where its pixels lie.
struct QuadOfWarp {
  int number = 0;  ///< in the warp
  models::QuadPlace place;
  models::LaneMask lanes = 0;  ///< to write, bits 0..3
};
/// Tests a quad's depths against those stored in its tile, and writes where it shall; lanes that pass.
[[nodiscard]] models::LaneMask test_depth(const DrawState& draw, const WarpSlot& warp, const QuadOfWarp& quad,
                                          float* tile_depths);
/// Blends a quad's colours into one attachment of its pass.
void write_color(const DrawState& draw, const PassState& pass, std::size_t attachment, const WarpSlot& warp,
                 const QuadOfWarp& quad, models::DeviceMemory& memory);

}  // namespace quadrille::hw
