/// Texels of images in memory that a capture holds as bytes.
///
/// Where an image shares an allocation with buffers that the program has mapped, gfxreconstruct may keep the
/// allocation's bytes alone, and no texels of the image. How an image lies in memory is its driver's own
/// affair. lavapipe's is known: rows one below the other, each level behind the one before. [Mesa 22.3.6]
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "traces/capture/objects.h"

namespace quadrille::capture {

/// Is it lavapipe, by VkPhysicalDeviceProperties' vendor and kind of device?
[[nodiscard]] bool is_lavapipe(std::uint64_t vendor, std::uint64_t device_type);

/// What the image holds if its bytes begin at those of `memory`: levels as `ImageObject::texels`. Empty where
/// the bytes do not reach, and for formats and numbers of samples that are not known.
[[nodiscard]] std::vector<std::vector<std::byte>> texels_in_memory(const ImageObject& image,
                                                                   std::span<const std::byte> memory);

}  // namespace quadrille::capture
