/// A stream whose shaders choose among arrays of textures, samplers, blocks and buffers.
#pragma once

#include "traces/command_stream.h"

#include <cstdint>

namespace quadrille::pipeline::test {

/// A picture of stripes and squares, drawn over and over with every kind of array: by numbers that are known,
/// by one from a block, and by one that differs from quad to quad. With `storage` from an array of storage
/// buffers too. It is validated; the same seed gives the same stream.
[[nodiscard]] traces::CommandStream descriptor_arrays_stream(std::uint64_t seed, bool storage = false);

}  // namespace quadrille::pipeline::test
