/// The warps that live on a core. Shared with the core's texture and load-store unit: a slot's requests and
/// results belong to whoever holds its token.
#pragma once

#include "hw/frame/stores.h"

namespace quadrille::hw {

struct CoreSlot {
  models::Warp warp;
  models::FragmentInputs fragment;
  std::array<models::LaneWords, models::kFragmentOutputs> outputs;  ///< fragment stage: colour, depth, mask
  /// Filtered texels of `warp.textures`, by request.
  std::array<std::array<models::LaneFloats, 4>, models::kMaxClauseRequests> texels;
  models::WarpStorage storage;
  int replies = 0;  ///< units that work on the requests of the clause that ended
  DrawId draw;
  std::uint32_t batch = 0;  ///< vertex stage: its slot in the batch store
  // Fragment stage: the warp's slot, and the place of its first quad.
  WarpSlotId warp_slot;
  PartitionId partition;
  std::uint16_t tile_x = 0, tile_y = 0;
  models::ShaderStage stage = models::ShaderStage::kVertex;
  std::uint16_t simd = 0;                                  ///< where its clauses issue
  models::ClauseEnd end = models::ClauseEnd::kProgramEnd;  ///< of the clause that issues
  /// cycles from that clause's last issue until its results are there
  std::uint32_t drain = 0;
  /// For a log of legs: what the clause began with, and the cycles that it would wait if it issued alone.
  std::uint32_t leg_take = 0, leg_latency = 0;
};

}  // namespace quadrille::hw
