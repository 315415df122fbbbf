/// A picture as a few digits: equal for equal colours and depths.
#pragma once

#include <string>

#include "pipeline/render.h"

namespace quadrille::studies {

/// Size, hash of the colours and hash of the depths.
[[nodiscard]] std::string image_hash(const pipeline::FrameImage& image);

}  // namespace quadrille::studies
