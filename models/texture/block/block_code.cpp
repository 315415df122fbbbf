#include "models/texture/block/block_code.h"

#include "models/base/error.h"
#include "models/texture/block/astc.h"
#include "models/texture/block/bptc.h"
#include "models/texture/block/etc2.h"
#include "models/texture/block/s3tc.h"

namespace quadrille::models {
namespace {

constexpr BlockCodeInfo astc(std::string_view name, std::uint8_t width, std::uint8_t height) {
  return {name, BlockFamily::kAstc, 16, DecodedTexels::kRgba8, 4, width, height};
}

/// By the value of `BlockCode`.
constexpr std::array<BlockCodeInfo, static_cast<std::size_t>(kLastBlockCode) + 1> kCodes{{
    {"BC1_RGB", BlockFamily::kS3tc, 8, DecodedTexels::kRgba8, 4},
    {"BC1_RGBA", BlockFamily::kS3tc, 8, DecodedTexels::kRgba8, 4},
    {"BC2", BlockFamily::kS3tc, 16, DecodedTexels::kRgba8, 4},
    {"BC3", BlockFamily::kS3tc, 16, DecodedTexels::kRgba8, 4},
    {"BC4_UNORM", BlockFamily::kRgtc, 8, DecodedTexels::kR8, 1},
    {"BC4_SNORM", BlockFamily::kRgtc, 8, DecodedTexels::kR8, 1},
    {"BC5_UNORM", BlockFamily::kRgtc, 16, DecodedTexels::kRg8, 2},
    {"BC5_SNORM", BlockFamily::kRgtc, 16, DecodedTexels::kRg8, 2},
    {"BC6H_UFLOAT", BlockFamily::kBc6h, 16, DecodedTexels::kRgba16f, 8},
    {"BC6H_SFLOAT", BlockFamily::kBc6h, 16, DecodedTexels::kRgba16f, 8},
    {"BC7", BlockFamily::kBc7, 16, DecodedTexels::kRgba8, 4},
    {"ETC2_RGB8", BlockFamily::kEtc2, 8, DecodedTexels::kRgba8, 4},
    {"ETC2_RGB8A1", BlockFamily::kEtc2, 8, DecodedTexels::kRgba8, 4},
    {"ETC2_RGBA8", BlockFamily::kEtc2, 16, DecodedTexels::kRgba8, 4},
    {"EAC_R11_UNORM", BlockFamily::kEac, 8, DecodedTexels::kR16, 2},
    {"EAC_R11_SNORM", BlockFamily::kEac, 8, DecodedTexels::kR16, 2},
    {"EAC_R11G11_UNORM", BlockFamily::kEac, 16, DecodedTexels::kRg16, 4},
    {"EAC_R11G11_SNORM", BlockFamily::kEac, 16, DecodedTexels::kRg16, 4},
    astc("ASTC_4x4_UNORM", 4, 4),
    astc("ASTC_4x4_SRGB", 4, 4),
    astc("ASTC_5x4_UNORM", 5, 4),
    astc("ASTC_5x4_SRGB", 5, 4),
    astc("ASTC_5x5_UNORM", 5, 5),
    astc("ASTC_5x5_SRGB", 5, 5),
    astc("ASTC_6x5_UNORM", 6, 5),
    astc("ASTC_6x5_SRGB", 6, 5),
    astc("ASTC_6x6_UNORM", 6, 6),
    astc("ASTC_6x6_SRGB", 6, 6),
    astc("ASTC_8x5_UNORM", 8, 5),
    astc("ASTC_8x5_SRGB", 8, 5),
    astc("ASTC_8x6_UNORM", 8, 6),
    astc("ASTC_8x6_SRGB", 8, 6),
    astc("ASTC_8x8_UNORM", 8, 8),
    astc("ASTC_8x8_SRGB", 8, 8),
    astc("ASTC_10x5_UNORM", 10, 5),
    astc("ASTC_10x5_SRGB", 10, 5),
    astc("ASTC_10x6_UNORM", 10, 6),
    astc("ASTC_10x6_SRGB", 10, 6),
    astc("ASTC_10x8_UNORM", 10, 8),
    astc("ASTC_10x8_SRGB", 10, 8),
    astc("ASTC_10x10_UNORM", 10, 10),
    astc("ASTC_10x10_SRGB", 10, 10),
    astc("ASTC_12x10_UNORM", 12, 10),
    astc("ASTC_12x10_SRGB", 12, 10),
    astc("ASTC_12x12_UNORM", 12, 12),
    astc("ASTC_12x12_SRGB", 12, 12),
}};

}  // namespace

const BlockCodeInfo& block_code_info(BlockCode code) { return kCodes[static_cast<std::size_t>(code)]; }

void decode_block(BlockCode code, std::span<const std::byte> block, BlockTexels& texels) {
  const BlockCodeInfo& info = block_code_info(code);
  QUADRILLE_CHECK(block.size() == info.bytes, "a block of {} with {} bytes", info.name, block.size());
  switch (info.family) {
    case BlockFamily::kS3tc: return decode_s3tc(code, block, texels);
    case BlockFamily::kRgtc: return decode_rgtc(code, block, texels);
    case BlockFamily::kBc6h: return decode_bc6h(code == BlockCode::kBc6hSfloat, block, texels);
    case BlockFamily::kBc7: return decode_bc7(block, texels);
    case BlockFamily::kEtc2: return decode_etc2(code, block, texels);
    case BlockFamily::kEac: return decode_eac(code, block, texels);
    case BlockFamily::kAstc: return decode_astc(code, block, texels);
  }
}

}  // namespace quadrille::models
