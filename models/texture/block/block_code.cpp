#include "models/texture/block/block_code.h"

#include "models/base/error.h"
#include "models/texture/block/bptc.h"
#include "models/texture/block/s3tc.h"

namespace quadrille::models {
namespace {

/// By the value of `BlockCode`.
constexpr std::array<BlockCodeInfo, static_cast<std::size_t>(kLastBlockCode) + 1> kCodes{{
    {"BC1_RGB", 8, DecodedTexels::kRgba8, 4},
    {"BC1_RGBA", 8, DecodedTexels::kRgba8, 4},
    {"BC2", 16, DecodedTexels::kRgba8, 4},
    {"BC3", 16, DecodedTexels::kRgba8, 4},
    {"BC4_UNORM", 8, DecodedTexels::kR8, 1},
    {"BC4_SNORM", 8, DecodedTexels::kR8, 1},
    {"BC5_UNORM", 16, DecodedTexels::kRg8, 2},
    {"BC5_SNORM", 16, DecodedTexels::kRg8, 2},
    {"BC6H_UFLOAT", 16, DecodedTexels::kRgba16f, 8},
    {"BC6H_SFLOAT", 16, DecodedTexels::kRgba16f, 8},
    {"BC7", 16, DecodedTexels::kRgba8, 4},
}};

}  // namespace

const BlockCodeInfo& block_code_info(BlockCode code) { return kCodes[static_cast<std::size_t>(code)]; }

void decode_block(BlockCode code, std::span<const std::byte> block, BlockTexels& texels) {
  QUADRILLE_CHECK(block.size() == block_code_info(code).bytes, "a block of {} with {} bytes",
                  block_code_info(code).name, block.size());
  switch (code) {
    case BlockCode::kBc1Rgb:
    case BlockCode::kBc1Rgba:
    case BlockCode::kBc2:
    case BlockCode::kBc3: decode_s3tc(code, block, texels); break;
    case BlockCode::kBc4Unorm:
    case BlockCode::kBc4Snorm:
    case BlockCode::kBc5Unorm:
    case BlockCode::kBc5Snorm: decode_rgtc(code, block, texels); break;
    case BlockCode::kBc6hUfloat: decode_bc6h(false, block, texels); break;
    case BlockCode::kBc6hSfloat: decode_bc6h(true, block, texels); break;
    case BlockCode::kBc7: decode_bc7(block, texels); break;
  }
}

}  // namespace quadrille::models
