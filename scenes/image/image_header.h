/// What an image file says about itself, read before a decoder allocates for it: the format, the size, and
/// how much work it announces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace quadrille::scenes {

enum class ImageFormat : std::uint8_t { kPng, kJpeg, kWebp, kDds, kExr, kHdr };

struct ImageHeader {
  ImageFormat format = ImageFormat::kPng;
  std::uint32_t width = 0, height = 0;
};

/// Recognises a PNG, JPEG, WebP, DDS, EXR or HDR (Radiance) file by its first bytes and checks its headers:
/// sides of 1..`kMaxImageSide`, at most `kMaxImagePixels`, parts that lie within the file, a bounded number of passes.
/// Throws `UserError` that starts with `name`.
[[nodiscard]] ImageHeader check_image_header(std::span<const std::byte> bytes, const std::string& name);

/// The file name extension by which OpenImageIO knows the format.
[[nodiscard]] const char* format_extension(ImageFormat format);

}  // namespace quadrille::scenes
