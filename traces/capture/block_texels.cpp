#include "traces/capture/block_texels.h"

#include <vulkan/vulkan_core.h>

#include <algorithm>

#include "models/texture/block/block_code.h"

namespace quadrille::capture {
namespace {

using models::BlockCode;

struct BlockFormat {
  VkFormat format;
  BlockCode code;
  bool srgb = false;
};
/// Those whose texels have components of eight bits, from 0 to 1.
constexpr BlockFormat kFormats[] = {
    {VK_FORMAT_BC1_RGB_UNORM_BLOCK, BlockCode::kBc1Rgb},
    {VK_FORMAT_BC1_RGB_SRGB_BLOCK, BlockCode::kBc1Rgb, true},
    {VK_FORMAT_BC1_RGBA_UNORM_BLOCK, BlockCode::kBc1Rgba},
    {VK_FORMAT_BC1_RGBA_SRGB_BLOCK, BlockCode::kBc1Rgba, true},
    {VK_FORMAT_BC2_UNORM_BLOCK, BlockCode::kBc2},
    {VK_FORMAT_BC2_SRGB_BLOCK, BlockCode::kBc2, true},
    {VK_FORMAT_BC3_UNORM_BLOCK, BlockCode::kBc3},
    {VK_FORMAT_BC3_SRGB_BLOCK, BlockCode::kBc3, true},
    {VK_FORMAT_BC4_UNORM_BLOCK, BlockCode::kBc4Unorm},
    {VK_FORMAT_BC5_UNORM_BLOCK, BlockCode::kBc5Unorm},
    {VK_FORMAT_BC7_UNORM_BLOCK, BlockCode::kBc7},
    {VK_FORMAT_BC7_SRGB_BLOCK, BlockCode::kBc7, true},
};

const BlockFormat* block_format(std::uint32_t format) {
  const auto* row = std::ranges::find(kFormats, static_cast<VkFormat>(format), &BlockFormat::format);
  return row == std::end(kFormats) ? nullptr : row;
}

}  // namespace

std::size_t block_bytes(std::uint32_t format) {
  const BlockFormat* known = block_format(format);
  return known == nullptr ? 0 : models::block_code_info(known->code).bytes;
}

bool is_srgb_block(std::uint32_t format) {
  const BlockFormat* known = block_format(format);
  return known != nullptr && known->srgb;
}

std::vector<std::array<std::uint8_t, 4>> block_texels(std::uint32_t format, std::uint32_t width,
                                                      std::uint32_t height,
                                                      std::span<const std::byte> blocks) {
  const BlockCode code = block_format(format)->code;
  const models::BlockCodeInfo& info = models::block_code_info(code);
  constexpr std::uint32_t kSide = models::kBlockSide;
  const std::uint32_t across = (width + kSide - 1) / kSide, down = (height + kSide - 1) / kSide;
  std::vector<std::array<std::uint8_t, 4>> texels(std::size_t{width} * height, {0, 0, 0, 255});
  for (std::uint32_t block = 0; block < across * down; ++block) {
    models::BlockTexels decoded;
    models::decode_block(code, blocks.subspan(std::size_t{block} * info.bytes, info.bytes), decoded);
    for (std::uint32_t place = 0; place < models::kBlockTexels; ++place) {
      const std::uint32_t x = block % across * kSide + place % kSide,
                          y = block / across * kSide + place / kSide;
      if (x >= width || y >= height) continue;
      for (std::size_t c = 0; c < info.decoded_bytes; ++c)
        texels[std::size_t{y} * width + x][c] =
            static_cast<std::uint8_t>(decoded.bytes[std::size_t{place} * info.decoded_bytes + c]);
    }
  }
  return texels;
}

}  // namespace quadrille::capture
