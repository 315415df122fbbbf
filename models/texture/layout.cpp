#include "models/texture/layout.h"

#include "models/base/error.h"

#include <algorithm>
#include <bit>

namespace quadrille::models {

TextureLayout make_texture_layout(std::uint32_t width, std::uint32_t height, std::uint32_t levels) {
  if (width < 1 || height < 1 || width > kMaxTextureSize || height > kMaxTextureSize) {
    throw user_error("texture of {} x {} texels: each side must be 1 to {}", width, height, kMaxTextureSize);
  }
  const auto most = static_cast<std::uint32_t>(std::bit_width(std::max(width, height)));
  if (levels < 1 || levels > most)
    throw user_error("texture of {} x {} texels with {} levels: it can have 1 to {}", width, height, levels, most);

  TextureLayout layout;
  layout.levels = levels;
  std::uint32_t next = 0;
  for (std::uint32_t level = 0; level < levels; ++level) {
    const std::uint32_t w = std::max(width >> level, 1u), h = std::max(height >> level, 1u);
    layout.width[level] = static_cast<std::int32_t>(w);
    layout.height[level] = static_cast<std::int32_t>(h);
    layout.pitch[level] = static_cast<std::int32_t>((w + 31) / 32 * 1024);
    layout.first[level] = static_cast<std::int32_t>(next);
    next =
        layout.texel_index(level, w - 1, h - 1) / 32 * 32 + 32;  // ends with the line of its last texel, which has the highest index of all
  }
  layout.bytes = 4 * std::uint64_t{next};
  return layout;
}

TextureView upload_texture(DeviceMemory& memory, TexelFormat format, std::uint32_t width, std::uint32_t height, std::uint32_t levels,
                           std::span<const std::byte> texels) {
  TextureView view{0, format, make_texture_layout(width, height, levels)};
  std::uint64_t expected = 0;
  for (std::uint32_t level = 0; level < levels; ++level)
    expected += 4 * static_cast<std::uint64_t>(view.layout.width[level]) * static_cast<std::uint64_t>(view.layout.height[level]);
  if (texels.size() != expected) {
    throw user_error("texture of {} x {} texels with {} levels: {} bytes of texels, {} are needed", width, height, levels, texels.size(),
                     expected);
  }
  view.base = memory.allocate(view.layout.bytes);
  std::byte* const tiled = memory.write(view.base, view.layout.bytes).data();
  const std::byte* source = texels.data();
  for (std::uint32_t level = 0; level < levels; ++level) {
    const auto w = static_cast<std::uint32_t>(view.layout.width[level]), h = static_cast<std::uint32_t>(view.layout.height[level]);
    for (std::uint32_t y = 0; y < h; ++y) {
      for (std::uint32_t x = 0; x < w; x += 4) {  // a sector's row of four texels is contiguous
        const std::size_t run = 4 * std::size_t{std::min(4u, w - x)};
        std::memcpy(tiled + 4 * std::size_t{view.layout.texel_index(level, x, y)}, source, run);
        source += run;
      }
    }
  }
  return view;
}

}  // namespace quadrille::models
