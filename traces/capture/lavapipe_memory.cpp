#include "traces/capture/lavapipe_memory.h"

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <optional>

#include "traces/capture/texels.h"

namespace quadrille::capture {
namespace {

constexpr std::size_t kCacheLine = 64, kRasterBlock = 4;

constexpr std::size_t up_to_multiple(std::size_t n, std::size_t of) { return (n + of - 1) / of * of; }

std::optional<TexelBlock> block_of(std::uint32_t format) {
  try {
    return texel_block(format);
  } catch (const UserError&) { return std::nullopt; }
}

/// One level: its rows and slices as they are, and as they lie in memory.
struct Level {
  std::size_t row, rows, slices;   ///< bytes of a row; rows of a slice; slices of all layers
  std::size_t pitch, slice_bytes;  ///< bytes from a row to the next, and from a slice to the next

  [[nodiscard]] std::size_t bytes() const { return slice_bytes * slices; }
};

Level level_of(const ImageObject& image, const TexelBlock& block, std::uint32_t number) {
  const auto side = [&](std::uint32_t size) { return std::size_t{std::max(1u, size >> number)}; };
  const auto blocks = [](std::size_t texels, std::uint32_t each) { return (texels + each - 1) / each; };
  const bool compressed = block.width > 1, lines = image.type == VK_IMAGE_TYPE_1D;
  const std::size_t width = side(image.width), height = side(image.height);
  Level level{};
  level.row = blocks(width, block.width) * block.bytes;
  level.rows = blocks(height, block.height);
  level.slices = side(image.depth) * image.layers;
  level.pitch =
      compressed ? level.row : up_to_multiple(up_to_multiple(width, kRasterBlock) * block.bytes, kCacheLine);
  level.slice_bytes = level.pitch * (compressed || lines ? level.rows : up_to_multiple(height, kRasterBlock));
  return level;
}

}  // namespace

bool is_lavapipe(std::uint64_t vendor, std::uint64_t device_type) {
  return vendor == VK_VENDOR_ID_MESA && device_type == VK_PHYSICAL_DEVICE_TYPE_CPU;
}

std::vector<std::vector<std::byte>> texels_in_memory(const ImageObject& image,
                                                     std::span<const std::byte> memory) {
  const std::optional<TexelBlock> block = block_of(image.format);
  if (!block || image.samples > 1) return {};
  std::vector<std::vector<std::byte>> texels;
  std::size_t begin = 0;
  for (std::uint32_t number = 0; number < image.levels; ++number) {
    const Level level = level_of(image, *block, number);
    if (begin > memory.size() || level.bytes() > memory.size() - begin) return {};
    std::vector<std::byte>& to = texels.emplace_back();
    to.reserve(level.row * level.rows * level.slices);
    for (std::size_t slice = 0; slice < level.slices; ++slice)
      for (std::size_t y = 0; y < level.rows; ++y) {
        const auto row = memory.subspan(begin + slice * level.slice_bytes + y * level.pitch, level.row);
        to.insert(to.end(), row.begin(), row.end());
      }
    begin += up_to_multiple(level.bytes(), kCacheLine);
  }
  return texels;
}

}  // namespace quadrille::capture
