/// Draws whose provoking vertex is the last one of each primitive, as OpenGL has it. This machine takes the
/// first, as Vulkan without an extension does. So the primitives get indices of their own, each turned so
/// that its last vertex comes first; lists take the place of strips and fans.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "traces/command_stream.h"

namespace quadrille::capture {

/// The topology that `turned_indices` are of.
[[nodiscard]] traces::Topology turned_topology(traces::Topology topology);

/// Vertices in the order in which a draw names them, with nothing where a strip ends. Vulkan's winding is
/// kept. [VK1.3 #drawing-primitive-topologies]
[[nodiscard]] std::vector<std::uint32_t> turned_indices(
    traces::Topology topology, std::span<const std::optional<std::uint32_t>> vertices);

/// What an index buffer says, from `first` on; `restart`: an index of all ones ends a strip. Throws
/// `UserError` if it has fewer indices.
[[nodiscard]] std::vector<std::optional<std::uint32_t>> read_indices(std::span<const std::byte> buffer,
                                                                     std::uint64_t offset,
                                                                     traces::IndexType type,
                                                                     std::uint32_t first, std::uint32_t count,
                                                                     bool restart);

}  // namespace quadrille::capture
