/// ASTC of low dynamic range: 16 bytes for a block of 4x4 to 12x12 texels, of which each block chooses how
/// many weights there are between the ends of how many partitions, and with how many bits. [KDF #ASTC]
#pragma once

#include "models/texture/block/block_code.h"

namespace quadrille::models {

/// ASTC to RGBA8: of the 16 bits between two ends the high eight, which for linear texels is the decode mode
/// decode_unorm8. Ends are widened to 16 bits by repeating them, or for sRGB by half a step, alpha too.
/// Blocks that are not legal, and what has high dynamic range, are magenta. Void extents are checked, and
/// otherwise passed over. [KDF #ASTC], [VK_EXT_astc_decode_mode], [astcenc]
void decode_astc(BlockCode code, std::span<const std::byte> block, BlockTexels& texels);

}  // namespace quadrille::models
