/// Version 1 of meshoptimizer's codec of vertex attributes, which KHR_meshopt_compression adds and the
/// library of Debian 12 does not know.
///
/// Elements come in blocks, of each block one byte position after the other, of each position groups of 16
/// deltas. A position's control says which widths its groups choose from; a channel of four bytes says
/// whether its deltas are of bytes, of halves of it, or exclusive ors of the whole. [KHR_meshopt_compression:
/// appendix A]
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace quadrille::scenes {

/// Does the stream say that it is of version 1?
[[nodiscard]] bool is_attribute_stream_1(std::span<const std::byte> source);

/// Decodes `count` elements of `stride` bytes (a multiple of 4 up to 256) into `out`, which is that large.
/// False when the stream is damaged: too short, too long, or with modes that there are not.
[[nodiscard]] bool decode_attribute_stream_1(std::span<const std::byte> source, std::uint64_t count,
                                             std::uint64_t stride, std::vector<std::byte>& out);

}  // namespace quadrille::scenes
