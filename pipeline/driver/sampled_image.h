/// The images that a frame samples, as figures name them.
#pragma once

#include "models/texture/layout.h"
#include "traces/command_stream.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace quadrille::pipeline {

/// An image that some draw of the frame may sample.
struct SampledImage {
  std::string name, format;
  std::uint32_t width = 0, height = 0, depth = 1, layers = 1, levels = 1;  ///< texels
  std::uint64_t begin = 0, end = 0;                                        ///< where it lies in device memory
};

/// Collects them, each once.
class SampledImages {
 public:
  /// A view of the image is bound. Answers the image's number, in the order in which they come first.
  std::uint32_t note(traces::Index index, const traces::Image& image, const models::TextureView& view);
  [[nodiscard]] const std::vector<SampledImage>& all() const { return all_; }

 private:
  std::map<traces::Index, std::uint32_t> number_;
  std::vector<SampledImage> all_;
};

}  // namespace quadrille::pipeline
