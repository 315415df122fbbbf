/// Texels of a capture's image as the stream's: as they are, or, of a few formats that the machine lacks, in
/// the order or size of one that it has. (docs/deviations.md#D170)
#pragma once

#include <cstddef>
#include <vector>

#include "traces/capture/objects.h"

namespace quadrille::capture {

/// All levels of a layer of an image, finest first, in `texture_format` of the view. Levels that the capture
/// does not hold are zeros, and set `missing`.
[[nodiscard]] std::vector<std::byte> texture_texels(const ImageObject& image, const ViewObject& view,
                                                    bool& missing);
/// Throws `UserError` for a view that the stream cannot bring texels for.
[[nodiscard]] traces::Format texture_format(const ViewObject& view);

/// Of a format of Vulkan: texels along the sides of a block, 1 without blocks, and its bytes.
struct TexelBlock {
  std::uint32_t width = 1, height = 1;
  std::size_t bytes = 0;
  friend bool operator==(const TexelBlock&, const TexelBlock&) = default;
};
/// Throws `UserError` for a format that is not known.
[[nodiscard]] TexelBlock texel_block(std::uint32_t format);
/// Is it known what a level of a layer of an image that passes may draw to holds?
[[nodiscard]] bool holds_part(const ImageObject& image, std::uint32_t level, std::uint32_t layer);
/// All levels and layers of such an image of one sample a pixel, as an attachment begins with them; what is
/// not known is zeros. Empty if nothing is.
[[nodiscard]] std::vector<std::byte> attachment_texels(const ImageObject& image);

}  // namespace quadrille::capture
