/// EXT_mesh_gpu_instancing: a node that draws its mesh many times.
#pragma once

#include <string>
#include <vector>

#include <glm/ext/matrix_double4x4.hpp>

#include "scenes/gltf_file.h"

namespace quadrille::scenes {

/// The matrices of the extension's instances relative to their node, at most 2^20. Attributes other than TRANSLATION, ROTATION and SCALE are passed over.
/// Throws `UserError` for accessors of other types, of unequal counts, or with values that are not finite. [EXT_mesh_gpu_instancing]
[[nodiscard]] std::vector<glm::dmat4> read_instances(const GltfFile& file, const tinygltf::Value& extension, const std::string& place);

}  // namespace quadrille::scenes
