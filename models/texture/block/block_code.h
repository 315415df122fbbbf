/// Block compression: how 4x4 texels are packed into 8 or 16 bytes, and back.
///
/// A texture unit needs any texel at once, so each block is of a fixed size and stands by itself. Most codes
/// hold two colours a block, or two for each of a few subsets of its texels, and for every texel an index on
/// the line between them. [KDF #S3TC, #RGTC, #BPTC]
#pragma once

#include "models/base/format.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace quadrille::models {

enum class BlockCode : std::uint8_t {
  kBc1Rgb,   ///< four colours a block, or three and black
  kBc1Rgba,  ///< the same, but the black is transparent
  kBc2,      ///< BC1's four colours, and four bits of alpha a texel
  kBc3,      ///< BC1's four colours, and alpha as BC4
  kBc4Unorm,
  kBc4Snorm,  ///< one channel: eight values, or six and the two ends
  kBc5Unorm,
  kBc5Snorm,  ///< two of BC4
  kBc6hUfloat,
  kBc6hSfloat,  ///< three channels of half floats, in 14 modes
  kBc7          ///< three or four channels of eight bits, in 8 modes
};
inline constexpr BlockCode kLastBlockCode = BlockCode::kBc7;

/// What the decoded texels are: the numbers of a format without compression.
enum class DecodedTexels : std::uint8_t {
  kRgba8,   ///< 4 bytes; UNORM or sRGB is for the format that uses the code to say
  kR8,      ///< 1 byte, unsigned, or two's complement
  kRg8,     ///< 2 bytes, likewise
  kRgba16f  ///< 8 bytes: halves
};

struct BlockCodeInfo {
  std::string_view name;
  std::uint8_t bytes = 0;  ///< of a block
  DecodedTexels decoded = DecodedTexels::kRgba8;
  std::uint8_t decoded_bytes = 0;  ///< of a texel
};
[[nodiscard]] const BlockCodeInfo& block_code_info(BlockCode code);

/// The side of a block, in texels.
inline constexpr std::uint32_t kBlockSide = 4;
inline constexpr std::uint32_t kBlockTexels = kBlockSide * kBlockSide;
inline constexpr std::uint32_t kMaxBlockBytes = 16;

/// The texels of a block, row by row, of `BlockCodeInfo::decoded_bytes` each.
struct BlockTexels {
  alignas(32) std::array<std::byte, std::size_t{kBlockTexels} * 8> bytes{};
};

/// Decodes a block of `BlockCodeInfo::bytes`. Every pattern of bits has texels: those that a specification
/// reserves are zeros. Integers only, so all hosts agree.
void decode_block(BlockCode code, std::span<const std::byte> block, BlockTexels& texels);

}  // namespace quadrille::models
