/// Properties of formats and images. Sizes and component counts follow the names. [VK1.3 #formats-definition]
#include "traces/command_stream.h"

#include <algorithm>

namespace quadrille::traces {

std::uint32_t format_bytes(Format format) {
  switch (format) {
    case Format::kUndefined: return 0;
    case Format::kR8G8Unorm: return 2;
    case Format::kR8G8B8A8Unorm:
    case Format::kR8G8B8A8Srgb:
    case Format::kD32Float:
    case Format::kR32Float:
    case Format::kR8G8B8A8UnormVertex:
    case Format::kR16G16Unorm:
    case Format::kR8G8B8A8Snorm:
    case Format::kR8G8B8A8Uint: return 4;
    case Format::kR32G32Float:
    case Format::kR16G16B16A16Unorm:
    case Format::kR16G16B16A16Snorm:
    case Format::kR16G16B16A16Uint: return 8;
    case Format::kR32G32B32Float: return 12;
    case Format::kR32G32B32A32Float: return 16;
  }
  return 0;
}

int format_components(Format format) {
  switch (format) {
    case Format::kUndefined: return 0;
    case Format::kD32Float:
    case Format::kR32Float: return 1;
    case Format::kR32G32Float:
    case Format::kR8G8Unorm:
    case Format::kR16G16Unorm: return 2;
    case Format::kR32G32B32Float: return 3;
    case Format::kR8G8B8A8Unorm:
    case Format::kR8G8B8A8Srgb:
    case Format::kR32G32B32A32Float:
    case Format::kR8G8B8A8UnormVertex:
    case Format::kR16G16B16A16Unorm:
    case Format::kR8G8B8A8Snorm:
    case Format::kR16G16B16A16Snorm:
    case Format::kR8G8B8A8Uint:
    case Format::kR16G16B16A16Uint: return 4;
  }
  return 0;
}

bool is_integer_format(Format format) {
  return format == Format::kR8G8B8A8Uint || format == Format::kR16G16B16A16Uint;
}

std::uint64_t level_bytes(const Image& image, std::uint32_t level) {
  return std::uint64_t{4} * std::max(1u, image.width >> level) * std::max(1u, image.height >> level);
}

std::uint64_t texel_bytes(const Image& image) {
  std::uint64_t bytes = 0;
  for (std::uint32_t level = 0; level < image.levels; ++level) bytes += level_bytes(image, level);
  return bytes;
}

void unpack(Image& image) {
  if (!image.packed) return;
  std::vector<std::byte> texels;
  texels.reserve(texel_bytes(image));
  (*image.packed)([&](std::uint32_t /*level*/, std::span<const std::byte> level) {
    texels.insert(texels.end(), level.begin(), level.end());
  });
  image.texels = std::move(texels);
  image.packed = nullptr;
}

}  // namespace quadrille::traces
