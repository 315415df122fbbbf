#include "studies/image_hash.h"

#include <xxhash.h>

#include <fmt/format.h>

namespace quadrille::studies {

std::string image_hash(const pipeline::FrameImage& image) {
  const std::uint64_t color = XXH3_64bits(image.color.data(), image.color.size() * sizeof(image.color[0]));
  const std::uint64_t depth = XXH3_64bits(image.depth.data(), image.depth.size() * sizeof(image.depth[0]));
  return fmt::format("{}x{} {:016x} {:016x}", image.width, image.height, color, depth);
}

}  // namespace quadrille::studies
