/// EXT_meshopt_compression: buffer views whose bytes are packed by meshoptimizer's codecs.
#pragma once

#include "scenes/gltf/file.h"

namespace quadrille::scenes {

/// Expands every buffer view that has the extension into `file.decoded_views`. What the extension says of
/// counts, strides and lengths is checked before the library sees a byte, and the codecs' least size bounds
/// the memory. Throws `UserError` with the view's place. [EXT_meshopt_compression]
void decode_meshopt_views(GltfFile& file);

}  // namespace quadrille::scenes
