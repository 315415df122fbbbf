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
constexpr std::array<Row, 54> kRows{{
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
    {Format::kEtc2Rgb8Unorm, BlockCode::kEtc2Rgb8, Format::kR8G8B8A8Unorm},
    {Format::kEtc2Rgb8Srgb, BlockCode::kEtc2Rgb8, Format::kR8G8B8A8Srgb},
    {Format::kEtc2Rgb8A1Unorm, BlockCode::kEtc2Rgb8A1, Format::kR8G8B8A8Unorm},
    {Format::kEtc2Rgb8A1Srgb, BlockCode::kEtc2Rgb8A1, Format::kR8G8B8A8Srgb},
    {Format::kEtc2Rgba8Unorm, BlockCode::kEtc2Rgba8, Format::kR8G8B8A8Unorm},
    {Format::kEtc2Rgba8Srgb, BlockCode::kEtc2Rgba8, Format::kR8G8B8A8Srgb},
    {Format::kEacR11Unorm, BlockCode::kEacR11Unorm, Format::kR16Unorm},
    {Format::kEacR11Snorm, BlockCode::kEacR11Snorm, Format::kR16Snorm},
    {Format::kEacR11G11Unorm, BlockCode::kEacR11G11Unorm, Format::kR16G16Unorm},
    {Format::kEacR11G11Snorm, BlockCode::kEacR11G11Snorm, Format::kR16G16Snorm},
    {Format::kAstc4x4Unorm, BlockCode::kAstc4x4Unorm, Format::kR8G8B8A8Unorm},
    {Format::kAstc4x4Srgb, BlockCode::kAstc4x4Srgb, Format::kR8G8B8A8Srgb},
    {Format::kAstc5x4Unorm, BlockCode::kAstc5x4Unorm, Format::kR8G8B8A8Unorm},
    {Format::kAstc5x4Srgb, BlockCode::kAstc5x4Srgb, Format::kR8G8B8A8Srgb},
    {Format::kAstc5x5Unorm, BlockCode::kAstc5x5Unorm, Format::kR8G8B8A8Unorm},
    {Format::kAstc5x5Srgb, BlockCode::kAstc5x5Srgb, Format::kR8G8B8A8Srgb},
    {Format::kAstc6x5Unorm, BlockCode::kAstc6x5Unorm, Format::kR8G8B8A8Unorm},
    {Format::kAstc6x5Srgb, BlockCode::kAstc6x5Srgb, Format::kR8G8B8A8Srgb},
    {Format::kAstc6x6Unorm, BlockCode::kAstc6x6Unorm, Format::kR8G8B8A8Unorm},
    {Format::kAstc6x6Srgb, BlockCode::kAstc6x6Srgb, Format::kR8G8B8A8Srgb},
    {Format::kAstc8x5Unorm, BlockCode::kAstc8x5Unorm, Format::kR8G8B8A8Unorm},
    {Format::kAstc8x5Srgb, BlockCode::kAstc8x5Srgb, Format::kR8G8B8A8Srgb},
    {Format::kAstc8x6Unorm, BlockCode::kAstc8x6Unorm, Format::kR8G8B8A8Unorm},
    {Format::kAstc8x6Srgb, BlockCode::kAstc8x6Srgb, Format::kR8G8B8A8Srgb},
    {Format::kAstc8x8Unorm, BlockCode::kAstc8x8Unorm, Format::kR8G8B8A8Unorm},
    {Format::kAstc8x8Srgb, BlockCode::kAstc8x8Srgb, Format::kR8G8B8A8Srgb},
    {Format::kAstc10x5Unorm, BlockCode::kAstc10x5Unorm, Format::kR8G8B8A8Unorm},
    {Format::kAstc10x5Srgb, BlockCode::kAstc10x5Srgb, Format::kR8G8B8A8Srgb},
    {Format::kAstc10x6Unorm, BlockCode::kAstc10x6Unorm, Format::kR8G8B8A8Unorm},
    {Format::kAstc10x6Srgb, BlockCode::kAstc10x6Srgb, Format::kR8G8B8A8Srgb},
    {Format::kAstc10x8Unorm, BlockCode::kAstc10x8Unorm, Format::kR8G8B8A8Unorm},
    {Format::kAstc10x8Srgb, BlockCode::kAstc10x8Srgb, Format::kR8G8B8A8Srgb},
    {Format::kAstc10x10Unorm, BlockCode::kAstc10x10Unorm, Format::kR8G8B8A8Unorm},
    {Format::kAstc10x10Srgb, BlockCode::kAstc10x10Srgb, Format::kR8G8B8A8Srgb},
    {Format::kAstc12x10Unorm, BlockCode::kAstc12x10Unorm, Format::kR8G8B8A8Unorm},
    {Format::kAstc12x10Srgb, BlockCode::kAstc12x10Srgb, Format::kR8G8B8A8Srgb},
    {Format::kAstc12x12Unorm, BlockCode::kAstc12x12Unorm, Format::kR8G8B8A8Unorm},
    {Format::kAstc12x12Srgb, BlockCode::kAstc12x12Srgb, Format::kR8G8B8A8Srgb},
}};

const Row& row_of(Format format) {
  const auto first = static_cast<std::size_t>(Format::kBc1RgbUnorm);
  QUADRILLE_CHECK(is_block_format(format), "{} has no blocks", format_info(format).name);
  return kRows[static_cast<std::size_t>(format) - first];
}

}  // namespace

BlockCode block_code(Format format) { return row_of(format).code; }

Format decoded_format(Format format) { return is_block_format(format) ? row_of(format).decoded : format; }

std::optional<Format> block_format(BlockCode code, bool srgb) {
  const BlockCodeInfo& info = block_code_info(code);
  const auto fits = [&](const Row& row) {
    if (format_info(row.format).numeric != (srgb ? Numeric::kSrgb : Numeric::kUnorm)) return false;
    const BlockCodeInfo& other = block_code_info(row.code);
    return row.code == code ||
           (is_astc(code) && is_astc(row.code) && other.width == info.width && other.height == info.height);
  };
  const auto* const row = std::ranges::find_if(kRows, fits);
  return row == kRows.end() ? std::nullopt : std::optional(row->format);
}

std::vector<std::byte> decode_blocks(Format format, std::uint32_t width, std::uint32_t height,
                                     std::span<const std::byte> blocks) {
  const Row& row = row_of(format);
  QUADRILLE_CHECK(blocks.size() == format_area_bytes(format, width, height), "{} bytes of {} for {} x {}",
                  blocks.size(), format_info(format).name, width, height);
  const BlockCodeInfo& info = block_code_info(row.code);
  const std::size_t texel_bytes = format_bytes(row.decoded);
  std::vector<std::byte> texels(std::size_t{width} * height * texel_bytes);
  BlockTexels block;
  for (std::uint32_t y = 0; y < height; y += info.height) {
    for (std::uint32_t x = 0; x < width; x += info.width) {
      decode_block(row.code, blocks.first(info.bytes), block);
      blocks = blocks.subspan(info.bytes);
      const std::size_t run = std::min<std::uint32_t>(info.width, width - x) * texel_bytes;
      for (std::uint32_t r = 0; r < std::min<std::uint32_t>(info.height, height - y); ++r)
        std::memcpy(texels.data() + (std::size_t{y + r} * width + x) * texel_bytes,
                    block.bytes.data() + std::size_t{r} * info.width * texel_bytes, run);
    }
  }
  return texels;
}

}  // namespace quadrille::models
