/// From the samples of a pixel to the pixel. [VK1.3 #renderpass-resolve-operations]
#pragma once

#include "models/base/format.h"

#include <cstdint>
#include <span>

namespace quadrille::models {

/// Means of the samples of 64 pixels in linear values, encoded. `planes` holds the pixels of one sample after
/// the other; their number is a power of two.
void resolve_tile(Format format, std::span<const std::uint32_t> planes, std::uint32_t pixels[64]);

}  // namespace quadrille::models
