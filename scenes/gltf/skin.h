/// glTF skins: joints and inverse bind matrices, checked, and the joint matrices at a pose. [glTF2.0 #skins]
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/ext/matrix_double4x4.hpp>

#include "scenes/data/scene_data.h"
#include "scenes/gltf/file.h"

namespace quadrille::scenes {

struct Skin {
  std::vector<int> joints;                ///< node numbers
  std::vector<glm::dmat4> inverse_binds;  ///< one a joint
};

/// Reads and checks skin `index`. Throws `UserError` with the place of what is wrong.
[[nodiscard]] Skin read_skin(const GltfFile& file, int index, const std::string& place);

/// The pose that the world matrices of its joints give a skin. `worlds` is by node number; a joint outside
/// the scene has none and is refused. A skin's vertices are put into the world directly, so the matrix of the
/// node that shows it counts for nothing; `model` takes out a size far from one and a place that is far away
/// for the skeleton's size, so that the shader's floats keep what differs between vertices. Throws
/// `UserError` when a joint is not in the scene or a matrix is not finite.
void pose_skin(const GltfFile& file, int index, const Skin& skin,
               const std::vector<std::optional<glm::dmat4>>& worlds, Pose& pose, glm::dmat4& model);

}  // namespace quadrille::scenes
