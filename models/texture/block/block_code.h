/// Block compression: how 4x4 to 12x12 texels are packed into 8 or 16 bytes, and back.
///
/// A texture unit needs any texel at once, so each block is of a fixed size and stands by itself. Most codes
/// hold two colours a block, or two for each of a few subsets of its texels, and for every texel an index on
/// the line between them. [KDF #S3TC, #RGTC, #BPTC, #ETC2, #ASTC]
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
  kBc7,         ///< three or four channels of eight bits, in 8 modes
  kEtc2Rgb8,    ///< a colour or two and steps from it, in five modes
  kEtc2Rgb8A1,  ///< the same, and texels may be transparent
  kEtc2Rgba8,   ///< the same, and alpha as EAC of eight bits
  kEacR11Unorm,
  kEacR11Snorm,  ///< one channel of 11 bits: a base and eight steps from it
  kEacR11G11Unorm,
  kEacR11G11Snorm,  ///< two of it
  kAstc4x4Unorm,    ///< four channels of eight bits, coded as each block chooses
  kAstc4x4Srgb,     ///< the same, rounded otherwise
  kAstc5x4Unorm,
  kAstc5x4Srgb,
  kAstc5x5Unorm,
  kAstc5x5Srgb,
  kAstc6x5Unorm,
  kAstc6x5Srgb,
  kAstc6x6Unorm,
  kAstc6x6Srgb,
  kAstc8x5Unorm,
  kAstc8x5Srgb,
  kAstc8x6Unorm,
  kAstc8x6Srgb,
  kAstc8x8Unorm,
  kAstc8x8Srgb,
  kAstc10x5Unorm,
  kAstc10x5Srgb,
  kAstc10x6Unorm,
  kAstc10x6Srgb,
  kAstc10x8Unorm,
  kAstc10x8Srgb,
  kAstc10x10Unorm,
  kAstc10x10Srgb,
  kAstc12x10Unorm,
  kAstc12x10Srgb,
  kAstc12x12Unorm,
  kAstc12x12Srgb
};
inline constexpr BlockCode kLastBlockCode = BlockCode::kAstc12x12Srgb;
[[nodiscard]] constexpr bool is_astc(BlockCode code) { return code >= BlockCode::kAstc4x4Unorm; }

/// What the decoded texels are: the numbers of a format without compression.
enum class DecodedTexels : std::uint8_t {
  kRgba8,   ///< 4 bytes; UNORM or sRGB is for the format that uses the code to say
  kR8,      ///< 1 byte, unsigned, or two's complement
  kRg8,     ///< 2 bytes, likewise
  kR16,     ///< 2 bytes, likewise
  kRg16,    ///< 4 bytes, likewise
  kRgba16f  ///< 8 bytes: halves
};

/// Codes that one decoder has.
enum class BlockFamily : std::uint8_t { kS3tc, kRgtc, kBc6h, kBc7, kEtc2, kEac, kAstc };

struct BlockCodeInfo {
  std::string_view name;
  BlockFamily family = BlockFamily::kS3tc;
  std::uint8_t bytes = 0;  ///< of a block
  DecodedTexels decoded = DecodedTexels::kRgba8;
  std::uint8_t decoded_bytes = 0;      ///< of a texel
  std::uint8_t width = 4, height = 4;  ///< of a block, in texels
  [[nodiscard]] constexpr std::uint32_t texels() const { return std::uint32_t{width} * height; }
};
[[nodiscard]] const BlockCodeInfo& block_code_info(BlockCode code);

/// The side of a block of all codes but ASTC, in texels.
inline constexpr std::uint32_t kBlockSide = 4;
inline constexpr std::uint32_t kBlockTexels = kBlockSide * kBlockSide;
inline constexpr std::size_t kMostBlockTexels = 144;  ///< of ASTC
/// Bytes of the texels of the largest block, which are RGBA8.
inline constexpr std::size_t kMostDecodedBytes = 4 * kMostBlockTexels;
inline constexpr std::uint32_t kMaxBlockBytes = 16;

/// The texels of a block, row by row, of `BlockCodeInfo::decoded_bytes` each.
struct BlockTexels {
  alignas(32) std::array<std::byte, kMostDecodedBytes> bytes{};
};

/// Decodes a block of `BlockCodeInfo::bytes`. Every pattern of bits has texels: those that a specification
/// reserves are zeros, of ASTC magenta. Integers only, so all hosts agree.
void decode_block(BlockCode code, std::span<const std::byte> block, BlockTexels& texels);

}  // namespace quadrille::models
