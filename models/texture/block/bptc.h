/// BC7 and BC6H: a block says by its first bits in which of several modes it is, how many subsets of its
/// texels have ends of their own, and how many bits ends and indices have. [KDF #BPTC]
#pragma once

#include "models/texture/block/block_code.h"

namespace quadrille::models {

/// BC7 to RGBA8. A block of no mode is transparent black.
void decode_bc7(std::span<const std::byte> block, BlockTexels& texels);
/// BC6H to RGBA of halves, alpha 1. A block of no mode is opaque black.
void decode_bc6h(bool is_signed, std::span<const std::byte> block, BlockTexels& texels);

}  // namespace quadrille::models
