/// BC1 to BC5: two ends a block, and an index a texel on the line between them. [KDF #S3TC, #RGTC]
#pragma once

#include "models/texture/block/block_code.h"

namespace quadrille::models {

/// BC1, BC2 and BC3 to RGBA8.
void decode_s3tc(BlockCode code, std::span<const std::byte> block, BlockTexels& texels);
/// BC4 and BC5 to R8 and RG8.
void decode_rgtc(BlockCode code, std::span<const std::byte> block, BlockTexels& texels);

}  // namespace quadrille::models
