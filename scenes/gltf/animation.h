/// glTF animations: which one is played, its tracks, and where they put the nodes at a time.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/ext/quaternion_double.hpp>
#include <glm/ext/vector_double3.hpp>

#include "scenes/data/animation.h"
#include "scenes/gltf/file.h"

namespace quadrille::scenes {

/// What an animation says of a node at a time; the rest stays as the node has it.
struct NodeMotion {
  std::optional<glm::dvec3> translation, scale;
  std::optional<glm::dquat> rotation;
  std::optional<std::vector<double>> weights;
};
using NodeMotions = std::map<int, NodeMotion>;  ///< by node number

/// Reads and checks animation `index`. Channels of KHR_animation_pointer are left out. Throws `UserError`
/// with the place of what is wrong.
[[nodiscard]] Animation read_animation(const GltfFile& file, std::size_t index);

/// The animations that `choice` names: a number, a name, `all`, or empty for the first; none when the file
/// has none and nothing is named. Notes a file that uses KHR_animation_pointer.
/// Throws `UserError` that lists the file's animations when there is no such one.
[[nodiscard]] std::vector<Animation> choose_animations(GltfFile& file, const std::string& choice);

/// Where the animations put the nodes at `time`, in seconds; of two that move the same, the later one counts.
[[nodiscard]] NodeMotions motions_at(const std::vector<Animation>& animations, double time);

}  // namespace quadrille::scenes
