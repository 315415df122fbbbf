/// ETC2 and EAC: a base colour, or two, for 4x4 texels, and for every texel an index to one of a few steps
/// away from it. Words of 64 bits, the first byte highest; texels are counted column by column. [KDF #ETC2]
#pragma once

#include "models/texture/block/block_code.h"

namespace quadrille::models {

/// ETC2 with no alpha, with one bit of it and with eight, to RGBA8. A texel that one bit makes transparent is
/// black.
void decode_etc2(BlockCode code, std::span<const std::byte> block, BlockTexels& texels);
/// EAC of one channel or two, of 11 bits, to channels of 16: the high bits are repeated below.
void decode_eac(BlockCode code, std::span<const std::byte> block, BlockTexels& texels);

}  // namespace quadrille::models
