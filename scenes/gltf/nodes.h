/// What a node of a file says by itself: its matrix, whether it is shown, the weights of its morph targets;
/// and which nodes a scene begins with.
///
/// All throw `UserError` with the place of what is wrong.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/ext/matrix_double4x4.hpp>

#include "scenes/gltf/animation.h"
#include "scenes/gltf/file.h"

namespace quadrille::scenes {

/// How errors name a node. Made when it is needed: a file may have a million nodes, each visited at many
/// moments.
[[nodiscard]] std::string place_of_node(int number);

/// From the node to its parent, moved as the animation says.
[[nodiscard]] glm::dmat4 local_matrix(const GltfFile& file, int number, const NodeMotion& motion);

/// The scene that `choice` names by number or name, or, if it is empty, the file's own; none in a file
/// without scenes.
[[nodiscard]] std::optional<std::size_t> scene_number(const GltfFile& file, const std::string& choice);

/// The roots of the scene that `choice` names by number or name, or, if it is empty, of the file's own;
/// without any scene, the nodes that are nobody's child. [glTF2.0 #scenes]
[[nodiscard]] std::vector<int> scene_roots(const GltfFile& file, const std::string& choice);

/// By the node itself. [KHR_node_visibility]
[[nodiscard]] bool is_visible(const tinygltf::Node& node);

/// Of a node with a mesh that exists: its own over the mesh's, and the animation's over both; zeros by
/// default. [glTF2.0 #morph-targets]
[[nodiscard]] std::vector<float> morph_weights(const GltfFile& file, int number, const NodeMotion& motion);

}  // namespace quadrille::scenes
