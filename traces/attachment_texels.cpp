#include "traces/attachment_texels.h"

namespace quadrille::traces {

std::span<const std::byte> part_texels(const Image& image, std::uint32_t level, std::uint32_t layer) {
  std::uint64_t begin = 0;
  for (std::uint32_t finer = 0; finer < level; ++finer) begin += level_bytes(image, finer) * image.layers;
  const std::uint64_t bytes = level_bytes(image, level);
  return std::span(image.texels).subspan(begin + bytes * layer, bytes);
}

void for_each_begun_part(const CommandStream& stream,
                         const std::function<void(const ImagePart& part)>& visit) {
  for (Index i = 0; i < stream.images.size(); ++i) {
    const Image& image = stream.images[i];
    if (!begins_with_texels(image)) continue;
    for (std::uint32_t level = 0; level < image.levels; ++level)
      for (std::uint32_t layer = 0; layer < image.layers; ++layer) visit({i, level, layer});
  }
}

}  // namespace quadrille::traces
