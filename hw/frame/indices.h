/// A draw's indices in memory: rules without time, which vertex fetch and the functional run share.
#pragma once

#include "hw/frame/frame.h"
#include "models/geometry/primitive_walk.h"
#include "models/memory/device_memory.h"

#include <cstdint>
#include <cstring>

namespace quadrille::hw {

/// Of the index at a position of an indexed draw's list.
[[nodiscard]] inline std::uint64_t index_address(const DrawState& draw, std::uint32_t position) {
  return draw.index_address + std::uint64_t{position} * draw.index_bytes;
}

[[nodiscard]] inline std::uint32_t index_at(const DrawState& draw, const models::DeviceMemory& memory,
                                            std::uint32_t position) {
  std::uint32_t index = 0;
  std::memcpy(&index, memory.read(index_address(draw, position), draw.index_bytes).data(), draw.index_bytes);
  return index;
}

/// Is it the special index that ends a strip or fan?
[[nodiscard]] inline bool is_restart(const DrawState& draw, const models::DeviceMemory& memory,
                                     std::uint32_t position) {
  return index_at(draw, memory, position) == models::restart_index(draw.index_bytes);
}

/// The vertex at a position of the draw's list.
[[nodiscard]] inline std::uint32_t vertex_number(const DrawState& draw, const models::DeviceMemory& memory,
                                                 std::uint32_t position) {
  if (!draw.indexed) return draw.first_vertex + position;
  return index_at(draw, memory, position) + static_cast<std::uint32_t>(draw.vertex_offset);
}

}  // namespace quadrille::hw
