/// Texels that an attachment begins with: what earlier frames left in it. They lie in the image's `texels`
/// as a texture's do, all levels and layers of them, each pixel as its format stores it; of a format with
/// stencil values, which no texture has, `models::encode_depth` says how.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "traces/command_stream.h"

namespace quadrille::traces {

/// Of an attachment: does it hold something before a pass has stored it?
[[nodiscard]] inline bool begins_with_texels(const Image& image) {
  return image.is_attachment() && !image.texels.empty();
}
/// Of an image whose texels are there: those of a level of a layer.
[[nodiscard]] std::span<const std::byte> part_texels(const Image& image, std::uint32_t level,
                                                     std::uint32_t layer);
/// Names every level of every layer of the attachments that begin with texels.
void for_each_begun_part(const CommandStream& stream,
                         const std::function<void(const ImagePart& part)>& visit);

}  // namespace quadrille::traces
