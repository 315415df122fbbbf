/// The usual kinds of PNG and JPEG files, by libpng and libjpeg-turbo alone: most runs then never load
/// OpenImageIO with its hundreds of libraries.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "scenes/image/image_header.h"
#include "scenes/image/image_io.h"

namespace quadrille::scenes {

/// Decodes what OpenImageIO would decode to the same pixels: PNGs of up to 8 bits a channel that are not
/// interlaced, JPEGs of grey or of three colours. None for all else, and for a file that the library so much
/// as warns about: OpenImageIO decides on those, and words their errors.
[[nodiscard]] std::optional<Rgba8Image> decode_plain_image(std::span<const std::byte> bytes,
                                                           const ImageHeader& header);
/// The PNG file of an image with a pixel at least, the same bytes as OpenImageIO's. None when the library
/// fails.
[[nodiscard]] std::optional<std::vector<std::byte>> encode_plain_png(const Rgba8Image& image);

}  // namespace quadrille::scenes
