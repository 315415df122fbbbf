/// From the outputs of order-independent draws to nodes in memory, and from these to colours: rules without
/// time, which the functional run uses too. Values are those of models/rop/transparency.h.
///
/// A k-buffer has a plane of entries for each sample and layer. An A-buffer has a head for each pixel, and a
/// pool of nodes in blocks of 64; a partition takes those of its part one after the other. So where a node
/// lies depends on the machine, and which nodes a pixel has does not.
#pragma once

#include "hw/frame/fragment_output.h"
#include "hw/frame/stores.h"
#include "models/memory/device_memory.h"
#include "models/rop/transparency.h"

#include <array>
#include <cstdint>

namespace quadrille::hw {

/// The part of the pool that a partition appends to.
struct NodePool {
  std::uint32_t next = 0, end = 0;  ///< nodes, from 0
};
/// That of a partition: as many nodes as the pixels of its tiles can hold.
[[nodiscard]] NodePool node_pool_of(const PassState& pass, PartitionId partition, std::uint32_t partitions);

/// Nodes that came, and those of them that met as many as there may be: merged in a k-buffer, lost in an
/// A-buffer.
struct NodeCounts {
  std::uint64_t offered = 0, overflowed = 0;
};

/// Puts a quad of one sample among the entries of its pixels.
NodeCounts put_layers(const DrawState& draw, const PassState& pass, const WarpSlot& warp,
                      const QuadOfWarp& quad, models::DeviceMemory& memory);

/// What appending a warp's fragments will do.
struct AppendPlan {
  std::array<std::uint64_t, models::kWarpLanes> head{};  ///< by lane: address of its pixel's; 0: appends none
  std::uint32_t nodes = 0;
  NodeCounts counts;
};
[[nodiscard]] AppendPlan plan_append(const PassState& pass, const WarpSlot& warp,
                                     const models::DeviceMemory& memory);
/// Appends a node for each lane of the plan, in the order of lanes, to the list of its pixel.
void append_nodes(const DrawState& draw, const PassState& pass, const WarpSlot& warp, const AppendPlan& plan,
                  NodePool& pool, models::DeviceMemory& memory);

[[nodiscard]] models::ListHead head_at(const PassState& pass, std::uint32_t tile_x, std::uint32_t tile_y,
                                       int pixel, const models::DeviceMemory& memory);
/// By its number, from 1.
[[nodiscard]] models::TransparencyNode node_at(const PassState& pass, std::uint32_t number,
                                               const models::DeviceMemory& memory);

/// Nodes of a tile.
struct TileNodes {
  std::uint64_t nodes = 0;
  std::array<std::uint64_t, models::kMaxSamples> pixels{};  ///< that have some, by sample
  std::array<std::uint8_t, models::kTileQuads> most{};      ///< of a pixel, by quad
};
[[nodiscard]] TileNodes tile_nodes(const PassState& pass, std::uint32_t tile_x, std::uint32_t tile_y,
                                   const models::DeviceMemory& memory);
/// Puts a tile's nodes over the colours of attachment 0.
void compose_tile(const PassState& pass, std::uint32_t tile_x, std::uint32_t tile_y,
                  models::DeviceMemory& memory);

}  // namespace quadrille::hw
