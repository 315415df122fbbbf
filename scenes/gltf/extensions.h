/// Which extensions of glTF are known, and what happens to the others.
#pragma once

#include "scenes/gltf/file.h"

namespace quadrille::scenes {

/// Throws `UserError` naming every extension in `extensionsRequired` that is not supported, and those that
/// are. Notes, in one line for the file, those in `extensionsUsed` that are not drawn.
void check_extensions(GltfFile& file);

}  // namespace quadrille::scenes
