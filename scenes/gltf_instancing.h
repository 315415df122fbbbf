/// EXT_mesh_gpu_instancing: a node that draws its mesh many times.
#pragma once

#include <string>
#include <vector>

#include <glm/ext/matrix_double4x4.hpp>

#include "scenes/gltf_file.h"
#include "scenes/scene_data.h"

namespace quadrille::scenes {

/// The matrices of the extension's instances relative to their node, at most 2^20. Attributes other than TRANSLATION, ROTATION and SCALE are passed over.
/// Throws `UserError` for accessors of other types, of unequal counts, or with values that are not finite. [EXT_mesh_gpu_instancing]
[[nodiscard]] std::vector<glm::dmat4> read_instances(const GltfFile& file, const tinygltf::Value& extension, const std::string& place);

/// Turns the instances of `scene` from `first` on, which a node with the matrix `world` placed, into instanced draws: one of the copies that mirror and one of
/// those that do not, since they face the other way. At most 2^20 copies a scene. Throws `UserError` for a matrix that is not finite.
void place_copies(const GltfFile& file, const tinygltf::Value& extension, const std::string& place, const glm::dmat4& world,
                  std::size_t first, SceneData& scene);

}  // namespace quadrille::scenes
