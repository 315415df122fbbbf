/// The entry points of the module `quadrille_images`, which alone links OpenImageIO. Plain types only: both
/// sides are built apart and meet through dlsym.
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" {

/// Pixels that the module allocated (return them with `quadrille_images_free`), or an error text.
struct QuadrilleImage {
  std::uint32_t width, height, channels;
  void* data;        ///< bytes or floats, interleaved, rows top to bottom; for an encoder: the file
  std::size_t size;  ///< bytes
  char error[400];
};

/// Decodes a file held in memory; `format` is an extension ("png"). As 8-bit RGBA, or as float with the
/// file's own channels; at most `max_bytes` of pixels. Returns false and an error.
using QuadrilleDecode = bool (*)(const void* bytes, std::size_t size, const char* format, bool as_float,
                                 std::uint64_t max_bytes, QuadrilleImage* result);
/// Encodes 8-bit RGBA as PNG, or float channels as EXR. Returns false and an error.
using QuadrilleEncode = bool (*)(const void* pixels, std::uint32_t width, std::uint32_t height,
                                 std::uint32_t channels, bool as_float, QuadrilleImage* result);
using QuadrilleFree = void (*)(void* data);

}  // extern "C"
