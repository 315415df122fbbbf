/// Which extensions of glTF are known, and what happens to the others.
#pragma once

#include <string>

#include "scenes/tiny_gltf.h"

namespace quadrille::scenes {

/// Throws `UserError` naming every extension in `extensionsRequired` that is not supported, and those that are. Warns on stderr, in one line for the file, of
/// those in `extensionsUsed` that are not drawn.
void check_extensions(const std::string& path, const tinygltf::Model& model);

}  // namespace quadrille::scenes
