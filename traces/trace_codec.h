/// Turns each table of a command stream into the payload of one chunk, and back.
///
/// Each kind of chunk has a version of its own. What an older one had otherwise is read and turned into what
/// stands for it today; only the newest is written.
///
/// Every type lists its fields once, in `transfer`; the same list writes and reads, so that the two cannot
/// drift apart. Numbers are little-endian and fixed width, a string or byte array is a 64-bit length and its
/// bytes, a table is a 64-bit count and its elements, an enumeration or bool is one byte.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
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
  kTargets,  ///< of files of version 1 only: the targets that their passes name
  kCommands
};
struct ChunkInfo {
  const char* tag;
  std::uint32_t version;  ///< that is written; 0: none. Older ones are read
};
inline constexpr std::array<ChunkInfo, 9> kChunks{{{"NAME", 1},
                                                   {"BUFS", 1},
                                                   {"IMGS", 6},
                                                   {"SAMP", 4},
                                                   {"SHAD", 1},
                                                   {"PIPE", 6},
                                                   {"DESC", 4},
                                                   {"TARG", 0},
                                                   {"CMDS", 8}}};

[[nodiscard]] std::vector<std::byte> encode_chunk(const CommandStream& stream, Chunk chunk);

/// Reads the chunks of one file, in their order.
class ChunkReader {
 public:
  /// Fills the chunk's table of `stream`, from any version of it from 1 to that of `kChunks`. Throws
  /// `UserError` that starts with `place` when the payload is not exactly one such table.
  void decode(CommandStream& stream, Chunk chunk, std::uint32_t version, std::span<const std::byte> payload,
              const std::string& place);

 private:
  /// Images that stand for the targets of a file of version 1: colour and depth, which may be `kNone`.
  std::vector<std::pair<Index, Index>> targets_;
};

}  // namespace quadrille::traces
