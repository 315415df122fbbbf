/// Turns each table of a command stream into the payload of one chunk, and back.
///
/// Every type lists its fields once, in `transfer`; the same list writes and reads, so that the two cannot
/// drift apart. Numbers are little-endian and fixed width, a string or byte array is a 64-bit length and its
/// bytes, a table is a 64-bit count and its elements, an enumeration or bool is one byte.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "traces/command_stream.h"

namespace quadrille::traces {

/// The chunks of a file, in their order. Tags are four characters.
enum class Chunk : std::uint8_t {
  kName,
  kBuffers,
  kImages,
  kSamplers,
  kShaders,
  kPipelines,
  kDescriptorSets,
  kTargets,
  kCommands
};
inline constexpr std::array<const char*, 9> kChunkTags{"NAME", "BUFS", "IMGS", "SAMP", "SHAD",
                                                       "PIPE", "DESC", "TARG", "CMDS"};

[[nodiscard]] std::vector<std::byte> encode_chunk(const CommandStream& stream, Chunk chunk);
/// Fills the chunk's table of `stream`. Throws `UserError` that starts with `place` when the payload is not
/// exactly one such table.
void decode_chunk(CommandStream& stream, Chunk chunk, std::span<const std::byte> payload,
                  const std::string& place);

}  // namespace quadrille::traces
