/// KHR_draco_mesh_compression: primitives whose indices and attributes are packed by Draco.
#pragma once

#include "scenes/gltf/file.h"

namespace quadrille::scenes {

/// Expands every primitive that has the extension into `file.decoded_accessors`, under the accessors that it
/// names, and makes it a list of triangles. Counts are read out of the data and bounded before Draco
/// allocates by them. Throws `UserError` with the primitive's place. [KHR_draco_mesh_compression]
void decode_draco_primitives(GltfFile& file);

}  // namespace quadrille::scenes
