/// From the samples of a pixel to the pixel. [VK1.3 #renderpass-resolve-operations]
#pragma once

#include "models/base/format.h"

#include <cstddef>
#include <cstdint>

namespace quadrille::models {

/// Means of the samples of 64 pixels in linear values; of integers, the first ones. A sample's pixels begin
/// `stride` bytes behind those of the one before; `samples` is a power of two.
void resolve_tile(Format format, const std::byte* planes, std::size_t stride, std::uint32_t samples,
                  std::byte* pixels);

}  // namespace quadrille::models
