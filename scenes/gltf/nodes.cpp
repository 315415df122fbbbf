#include "scenes/gltf/nodes.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <glm/ext/quaternion_double.hpp>
#include <glm/gtc/quaternion.hpp>

#include "models/base/error.h"
#include "scenes/data/named_choice.h"

namespace quadrille::scenes {
namespace {

[[noreturn]] void fail(const GltfFile& file, const std::string& place, const std::string& reason) {
  throw user_error("{}: {}: {}", file.path, place, reason);
}

int chosen_scene(const GltfFile& file, const std::string& choice) {
  std::vector<std::string> names;
  names.reserve(file.model.scenes.size());
  for (const tinygltf::Scene& scene : file.model.scenes) names.push_back(scene.name);
  const std::optional<std::size_t> found = find_choice(names, choice);
  if (!found)
    fail(file, "scenes",
         fmt::format("scene '{}' does not exist; scenes: {}", choice.substr(0, 60), list_of_choices(names)));
  return static_cast<int>(*found);
}

}  // namespace

std::string place_of_node(int number) { return fmt::format("nodes[{}]", number); }

glm::dmat4 local_matrix(const GltfFile& file, int number, const NodeMotion& motion) {
  const tinygltf::Node& node = file.model.nodes[static_cast<std::size_t>(number)];
  const auto sized = [&](const std::vector<double>& values, std::size_t size, const char* member) {
    if (!values.empty() && values.size() != size)
      fail(file, place_of_node(number),
           fmt::format("{}: {} numbers instead of {}", member, values.size(), size));
    return !values.empty();
  };
  glm::dmat4 m(1);
  if (sized(node.matrix, 16, "matrix")) {
    for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
    return m;
  }
  if (motion.rotation) {
    m = glm::mat4_cast(*motion.rotation);
  } else if (sized(node.rotation, 4, "rotation")) {
    const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    const double length = glm::length(q);
    if (!(length > 0) || !std::isfinite(length))
      fail(file, place_of_node(number), "rotation: not a quaternion");
    m = glm::mat4_cast(q / length);
  }
  if (motion.scale) {
    for (int i = 0; i < 3; ++i) m[i] *= (*motion.scale)[i];
  } else if (sized(node.scale, 3, "scale")) {
    for (int i = 0; i < 3; ++i) m[i] *= node.scale[static_cast<std::size_t>(i)];
  }
  if (motion.translation) {
    m[3] = glm::dvec4(*motion.translation, 1);
  } else if (sized(node.translation, 3, "translation")) {
    m[3] = glm::dvec4(node.translation[0], node.translation[1], node.translation[2], 1);
  }
  return m;
}

std::optional<std::size_t> scene_number(const GltfFile& file, const std::string& choice) {
  const tinygltf::Model& model = file.model;
  if (model.scenes.empty()) return std::nullopt;
  const int scene = choice.empty() ? std::max(0, model.defaultScene) : chosen_scene(file, choice);
  if (static_cast<std::size_t>(scene) >= model.scenes.size())
    fail(file, "scene", fmt::format("scene {} does not exist (the file has {})", scene, model.scenes.size()));
  return static_cast<std::size_t>(scene);
}

std::vector<int> scene_roots(const GltfFile& file, const std::string& choice) {
  const tinygltf::Model& model = file.model;
  if (const std::optional<std::size_t> scene = scene_number(file, choice)) return model.scenes[*scene].nodes;
  if (!choice.empty()) (void)chosen_scene(file, choice);
  std::vector<bool> child(model.nodes.size());
  for (const tinygltf::Node& node : model.nodes) {
    for (const int c : node.children) {
      if (c >= 0 && static_cast<std::size_t>(c) < child.size()) child[static_cast<std::size_t>(c)] = true;
    }
  }
  std::vector<int> result;
  for (std::size_t i = 0; i < child.size(); ++i) {
    if (!child[i]) result.push_back(static_cast<int>(i));
  }
  return result;
}

bool is_visible(const tinygltf::Node& node) {
  const auto found = node.extensions.find("KHR_node_visibility");
  if (found == node.extensions.end() || !found->second.Has("visible")) return true;
  const tinygltf::Value& visible = found->second.Get("visible");
  return !visible.IsBool() || visible.Get<bool>();
}

std::vector<float> morph_weights(const GltfFile& file, int number, const NodeMotion& motion) {
  const tinygltf::Node& node = file.model.nodes[static_cast<std::size_t>(number)];
  const tinygltf::Mesh& mesh = file.model.meshes[static_cast<std::size_t>(node.mesh)];
  const std::size_t targets = mesh.primitives.empty() ? 0 : mesh.primitives.front().targets.size();
  const std::vector<double>& weights = motion.weights         ? *motion.weights
                                       : node.weights.empty() ? mesh.weights
                                                              : node.weights;
  if (!weights.empty() && weights.size() != targets)
    fail(file, place_of_node(number),
         fmt::format("{} weights for a mesh of {} morph targets", weights.size(), targets));
  std::vector<float> result;
  result.reserve(weights.size());
  for (const double weight : weights) {
    result.push_back(static_cast<float>(weight));
    if (!std::isfinite(result.back()))
      fail(file, place_of_node(number), "a morph target's weight is not finite");
  }
  return result;
}

}  // namespace quadrille::scenes
