/// Functional rendering: the machine's values without its time. The same models in API order, one warp after
/// another; also the yardstick that every timed run must equal, bit for bit.
#pragma once

#include "hw/frame/frame.h"
#include "models/memory/device_memory.h"
#include "pipeline/functional/fates.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace quadrille::pipeline {

struct FunctionalCounts {
  std::uint64_t vertices = 0, triangles = 0;
  std::uint64_t fragments_covered = 0, fragments_shaded = 0, fragments_written = 0, helper_lanes = 0;
  Fates fates;
  std::vector<std::uint64_t> samples_passed;  ///< by draw, as an occlusion query counts them
};

/// A primitive or a piece of one, in window space, as it was rasterised: for the reference renderer.
struct RasterizedPiece {
  hw::DrawId draw;
  std::uint32_t instance = 0, primitive = 0;
  models::ClippedPiece piece;
};
using PieceObserver = std::function<void(const RasterizedPiece&)>;

/// Renders all passes of the frame into its surfaces in `memory`.
FunctionalCounts render_functional(const hw::Frame& frame, models::DeviceMemory& memory,
                                   const PieceObserver& observer = {});

}  // namespace quadrille::pipeline
