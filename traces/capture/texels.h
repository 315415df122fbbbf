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

/// Of a format of Vulkan: texels along a side of a block, 1 without blocks, and its bytes.
struct TexelBlock {
  std::uint32_t side = 1;
  std::size_t bytes = 0;
};
/// Throws `UserError` for a format that is not known.
[[nodiscard]] TexelBlock texel_block(std::uint32_t format);
/// Does the capture bring the view's level of its layer?
[[nodiscard]] bool has_texels(const ImageObject& image, const ViewObject& view);

}  // namespace quadrille::capture
