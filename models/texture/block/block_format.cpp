#include "models/texture/block/block_format.h"

#include "models/base/error.h"

#include <algorithm>
#include <cstring>

namespace quadrille::models {
namespace {

struct Row {
  Format format;
  BlockCode code;
  Format decoded;
};
constexpr std::array<Row, 16> kRows{{
    {Format::kBc1RgbUnorm, BlockCode::kBc1Rgb, Format::kR8G8B8A8Unorm},
    {Format::kBc1RgbSrgb, BlockCode::kBc1Rgb, Format::kR8G8B8A8Srgb},
    {Format::kBc1RgbaUnorm, BlockCode::kBc1Rgba, Format::kR8G8B8A8Unorm},
    {Format::kBc1RgbaSrgb, BlockCode::kBc1Rgba, Format::kR8G8B8A8Srgb},
    {Format::kBc2Unorm, BlockCode::kBc2, Format::kR8G8B8A8Unorm},
    {Format::kBc2Srgb, BlockCode::kBc2, Format::kR8G8B8A8Srgb},
    {Format::kBc3Unorm, BlockCode::kBc3, Format::kR8G8B8A8Unorm},
    {Format::kBc3Srgb, BlockCode::kBc3, Format::kR8G8B8A8Srgb},
    {Format::kBc4Unorm, BlockCode::kBc4Unorm, Format::kR8Unorm},
    {Format::kBc4Snorm, BlockCode::kBc4Snorm, Format::kR8Snorm},
    {Format::kBc5Unorm, BlockCode::kBc5Unorm, Format::kR8G8Unorm},
    {Format::kBc5Snorm, BlockCode::kBc5Snorm, Format::kR8G8Snorm},
    {Format::kBc6hUfloat, BlockCode::kBc6hUfloat, Format::kR16G16B16A16Float},
    {Format::kBc6hSfloat, BlockCode::kBc6hSfloat, Format::kR16G16B16A16Float},
    {Format::kBc7Unorm, BlockCode::kBc7, Format::kR8G8B8A8Unorm},
    {Format::kBc7Srgb, BlockCode::kBc7, Format::kR8G8B8A8Srgb},
}};

const Row& row_of(Format format) {
  const auto first = static_cast<std::size_t>(Format::kBc1RgbUnorm);
  QUADRILLE_CHECK(is_block_format(format), "{} has no blocks", format_info(format).name);
  return kRows[static_cast<std::size_t>(format) - first];
}

}  // namespace

BlockCode block_code(Format format) { return row_of(format).code; }

Format decoded_format(Format format) { return is_block_format(format) ? row_of(format).decoded : format; }

std::vector<std::byte> decode_blocks(Format format, std::uint32_t width, std::uint32_t height,
                                     std::span<const std::byte> blocks) {
  const Row& row = row_of(format);
  QUADRILLE_CHECK(blocks.size() == format_area_bytes(format, width, height), "{} bytes of {} for {} x {}",
                  blocks.size(), format_info(format).name, width, height);
  const std::size_t block_bytes = format_bytes(format), texel_bytes = format_bytes(row.decoded);
  std::vector<std::byte> texels(std::size_t{width} * height * texel_bytes);
  BlockTexels block;
  for (std::uint32_t y = 0; y < height; y += kBlockSide) {
    for (std::uint32_t x = 0; x < width; x += kBlockSide) {
      decode_block(row.code, blocks.first(block_bytes), block);
      blocks = blocks.subspan(block_bytes);
      const std::size_t run = std::min(kBlockSide, width - x) * texel_bytes;
      for (std::uint32_t r = 0; r < std::min(kBlockSide, height - y); ++r)
        std::memcpy(texels.data() + (std::size_t{y + r} * width + x) * texel_bytes,
                    block.bytes.data() + std::size_t{r} * kBlockSide * texel_bytes, run);
    }
  }
  return texels;
}

}  // namespace quadrille::models
