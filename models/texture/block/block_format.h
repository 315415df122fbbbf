/// Which code a format's blocks have, and which format their texels.
#pragma once

#include "models/texture/block/block_code.h"

#include <optional>
#include <vector>

namespace quadrille::models {

/// The code of a block format (`is_block_format`); of any other an internal error.
[[nodiscard]] BlockCode block_code(Format format);
/// The format of the texels that a block format decodes to; any other is its own. Components that the block
/// format lacks are those that it would read as.
[[nodiscard]] Format decoded_format(Format format);

/// The format, of 8 to 16 bits a component and without a sign, whose blocks have that code; of ASTC, the same
/// size. None, where there is none with (without) sRGB.
[[nodiscard]] std::optional<Format> block_format(BlockCode code, bool srgb);

/// Decodes a level of an image: rows of blocks, top to bottom, to rows of texels, tightly packed. Of blocks
/// that reach beyond the level, only the texels inside count. Another number of bytes than the level has is
/// an internal error.
[[nodiscard]] std::vector<std::byte> decode_blocks(Format format, std::uint32_t width, std::uint32_t height,
                                                   std::span<const std::byte> blocks);

}  // namespace quadrille::models
