/// ASTC by Arm's encoder, libastcenc.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace quadrille::scenes {

/// Rows of blocks, of `block_width` x `block_height` texels each, of `width` x `height` texels of RGBA8. The
/// effort is medium, and errors are those of the codes, for sRGB and linear texels alike. A size of blocks
/// that ASTC has not is an internal error. Which of two encodings that are about equally good is taken hangs
/// on single precision and on the C library's logarithm, sine and cosine.
[[nodiscard]] std::vector<std::byte> encode_astc(std::span<const std::byte> rgba, std::uint32_t width,
                                                 std::uint32_t height, std::uint32_t block_width,
                                                 std::uint32_t block_height);

}  // namespace quadrille::scenes
