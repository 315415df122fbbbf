/// Images in and out of files: by libpng and libjpeg-turbo where they are of the usual kinds
/// (scenes/image/plain_image.h), by OpenImageIO for all else.
///
/// OpenImageIO brings hundreds of shared libraries, so it lives in a module of its own (scenes/image/) that
/// is loaded on first use: a program that touches no unusual image file does not pay for it. Written files
/// appear whole or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace quadrille::scenes {

inline constexpr std::uint32_t kMaxImageSide = 16384;
/// of a file that is read: 8192x8192
inline constexpr std::uint64_t kMaxImagePixels = std::uint64_t{1} << 26;

/// 8-bit RGBA, rows top to bottom, tightly packed, values as in the file (sRGB-encoded where the file is).
struct Rgba8Image {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  ///< 4 * width * height
};
/// Floating-point samples, rows top to bottom, channels interleaved.
struct FloatImage {
  std::uint32_t width = 0, height = 0, channels = 1;
  std::vector<float> pixels;  ///< channels * width * height
};

/// Loads the module now, for processes to be forked that would each load it. Throws `UserError` when it is
/// not found.
void open_image_module();

/// Decodes a PNG, JPEG, WebP, DDS, EXR or HDR file held in memory. Grey becomes r=g=b, missing alpha 255;
/// 16-bit and float files are rounded to 8 bits. Throws `UserError` that starts with `name` when the data is
/// damaged, truncated, or has more than 16384 pixels a side or `kMaxImagePixels` in all.
[[nodiscard]] Rgba8Image decode_image(std::span<const std::byte> bytes, const std::string& name);
/// The same by OpenImageIO alone, whatever the file: the pixels and errors that `decode_image` has to have.
[[nodiscard]] Rgba8Image decode_any_image(std::span<const std::byte> bytes, const std::string& name);
/// Reads an image file as 8-bit RGBA. Throws `UserError` with the path.
[[nodiscard]] Rgba8Image load_image(const std::string& path);
/// Reads an image file as float, with its own number of channels (EXR: linear values as stored; 8-bit files:
/// 0..1). Throws `UserError` with the path, also for more pixels than `most`.
[[nodiscard]] FloatImage load_float_image(const std::string& path, std::uint64_t most = kMaxImagePixels);

/// Writes 8-bit RGBA as PNG. Throws `UserError` with the path.
void save_png(const std::string& path, const Rgba8Image& image);
/// The same file by OpenImageIO.
void save_png_by_module(const std::string& path, const Rgba8Image& image);
/// Writes 32-bit float channels as EXR: 1 channel is named Z (depth), 3 R G B, 4 R G B A. Throws `UserError`
/// with the path.
void save_exr(const std::string& path, const FloatImage& image);

}  // namespace quadrille::scenes
