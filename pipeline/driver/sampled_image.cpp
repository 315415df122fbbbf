#include "pipeline/driver/sampled_image.h"

#include "models/base/format.h"

#include <algorithm>

namespace quadrille::pipeline {

std::uint32_t SampledImages::note(traces::Index index, const traces::Image& image,
                                  const models::TextureView& view) {
  const auto [entry, added] = number_.try_emplace(index, static_cast<std::uint32_t>(all_.size()));
  if (added)
    all_.push_back({image.name, std::string(models::format_info(image.format).name), image.width,
                    image.height, image.depth, image.layers, image.levels, view.base, view.base});
  SampledImage& whole = all_[entry->second];
  whole.begin = std::min(whole.begin, view.base);
  whole.end = std::max(whole.end, view.base + view.layout.bytes);
  return entry->second;
}

}  // namespace quadrille::pipeline
