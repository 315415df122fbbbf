/// Block-compressed texels with components of eight bits: BC1 to BC5 and BC7.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace quadrille::capture {

/// Bytes of a block of 4x4 texels; 0 of a format that is none of these.
[[nodiscard]] std::size_t block_bytes(std::uint32_t format);
[[nodiscard]] bool is_srgb_block(std::uint32_t format);
/// The texels of an image of that size, row by row; `blocks` holds all of them.
[[nodiscard]] std::vector<std::array<std::uint8_t, 4>> block_texels(std::uint32_t format, std::uint32_t width,
                                                                    std::uint32_t height,
                                                                    std::span<const std::byte> blocks);

}  // namespace quadrille::capture
