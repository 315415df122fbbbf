#include "scenes/gltf/instancing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <glm/ext/matrix_double3x3.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/ext/quaternion_double.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "models/base/error.h"
#include "scenes/gltf/accessor.h"
#include "scenes/gltf/value.h"

namespace quadrille::scenes {
namespace {

constexpr std::uint32_t kMaxInstances = 1u << 20;

bool all_finite(const glm::mat4& m) {
  for (int i = 0; i < 16; ++i) {
    if (!std::isfinite(m[i / 4][i % 4])) return false;
  }
  return true;
}

class InstanceReader {
 public:
  InstanceReader(const GltfFile& file, const tinygltf::Value& extension, const std::string& place)
      : file_(file), object_(file.path, place + ".EXT_mesh_gpu_instancing", extension) {}

  std::vector<glm::dmat4> read() {
    if (!object_.has("attributes")) return {};
    const GltfObject attributes = object_.object("attributes");
    for (const char* name : {"TRANSLATION", "ROTATION", "SCALE"}) {
      if (attributes.has(name)) count(attributes, name);
    }
    for (const std::string& name : attributes.value().Keys()) count(attributes, name);
    const auto translation = stream(attributes, "TRANSLATION", 3),
               rotation = stream(attributes, "ROTATION", 4), scale = stream(attributes, "SCALE", 3);
    std::vector<glm::dmat4> result;
    result.reserve(count_.value_or(0));
    for (std::uint32_t i = 0; i < count_.value_or(0); ++i) {
      glm::dmat4 m(1);
      if (rotation) m = glm::mat4_cast(quaternion(attributes, *rotation, i));
      if (scale) {
        for (std::size_t k = 0; k < 3; ++k) m[static_cast<int>(k)] *= value(*scale, i, k);
      }
      if (translation)
        m[3] = glm::dvec4(value(*translation, i, 0), value(*translation, i, 1), value(*translation, i, 2), 1);
      result.push_back(m);
    }
    return result;
  }

 private:
  static double value(const Elements& elements, std::uint32_t i, std::size_t k) {
    return static_cast<double>(component_value(elements, i, k));
  }

  /// All attributes are of one number of elements, those too that only an application knows the meaning of:
  /// that many copies there are.
  void count(const GltfObject& attributes, const std::string& name) {
    const std::size_t elements =
        file_.model
            .accessors[static_cast<std::size_t>(attributes.index(name.c_str(), file_.model.accessors.size()))]
            .count;
    if (elements == 0) attributes.fail(name, "its accessor has no elements");
    if (elements > kMaxInstances)
      attributes.fail(name, fmt::format("{} instances; at most {} are drawn", elements, kMaxInstances));
    if (count_ && *count_ != elements)
      attributes.fail(name, fmt::format("{} elements where another attribute has {}", elements, *count_));
    count_ = static_cast<std::uint32_t>(elements);
  }

  /// Floats, or for rotations normalized integers too.
  std::optional<Elements> stream(const GltfObject& attributes, const char* name, std::size_t components) {
    if (!attributes.has(name)) return std::nullopt;
    const int accessor = attributes.index(name, file_.model.accessors.size());
    Elements elements = read_accessor(file_, accessor, attributes.place() + "." + name);
    const bool is_float = elements.component == Component::kFloat;
    const bool is_fraction =
        components == 4 && elements.normalized &&
        (elements.component == Component::kInt8 || elements.component == Component::kInt16);
    if (elements.components != components || !(is_float || is_fraction))
      attributes.fail(name, fmt::format("accessor {} is not of {} floats{}", accessor, components,
                                        components == 4 ? " or normalized bytes or shorts" : ""));
    for (std::uint32_t i = 0; i < elements.count; ++i) {
      for (std::size_t k = 0; k < components; ++k) {
        if (!std::isfinite(value(elements, i, k)))
          attributes.fail(name, fmt::format("element {} is not finite", i));
      }
    }
    return elements;
  }

  static glm::dquat quaternion(const GltfObject& attributes, const Elements& rotation, std::uint32_t i) {
    const glm::dquat q(value(rotation, i, 3), value(rotation, i, 0), value(rotation, i, 1),
                       value(rotation, i, 2));
    const double length = glm::length(q);
    if (!(length > 0)) attributes.fail("ROTATION", fmt::format("element {} is not a quaternion", i));
    return q / length;
  }

  const GltfFile& file_;
  GltfObject object_;
  std::optional<std::uint32_t> count_;
};

}  // namespace

std::vector<glm::dmat4> read_instances(const GltfFile& file, const tinygltf::Value& extension,
                                       const std::string& place) {
  return InstanceReader(file, extension, place).read();
}

bool place_copies(const GltfFile& file, const tinygltf::Value& extension, const std::string& place,
                  const glm::dmat4& world, std::size_t first, SceneData& scene, PlacedCopies& placed_copies) {
  const auto [entry, added] = placed_copies.matrices.try_emplace(&extension);
  if (added) entry->second = read_instances(file, extension, place);
  if (entry->second.empty()) return false;
  placed_copies.drawn += entry->second.size() * std::max<std::size_t>(1, scene.instances.size() - first);
  if (placed_copies.drawn > kMaxInstances)
    throw user_error("{}: {}: the scene has more than {} instances of primitives", file.path, place,
                     kMaxInstances);
  std::array<std::vector<glm::dmat4>, 2> sides;
  for (const glm::dmat4& matrix : entry->second) {
    const glm::dmat4 placed = world * matrix;
    if (!all_finite(glm::mat4(placed)))
      throw user_error("{}: {}: the matrix of one of its instances is not finite", file.path, place);
    sides[glm::determinant(glm::dmat3(placed)) < 0 ? 1 : 0].push_back(placed);
  }
  const std::vector<Instance> originals(scene.instances.begin() + static_cast<std::ptrdiff_t>(first),
                                        scene.instances.end());
  scene.instances.resize(first);
  for (std::vector<glm::dmat4>& side : sides) {
    if (side.empty()) continue;
    for (Instance instance : originals) {
      instance.copies = static_cast<int>(scene.copies.size());
      scene.instances.push_back(std::move(instance));
    }
    scene.copies.push_back(std::move(side));
  }
  return true;
}

}  // namespace quadrille::scenes
