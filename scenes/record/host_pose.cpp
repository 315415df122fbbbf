#include "scenes/record/host_pose.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/ext/matrix_double3x3.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/ext/vector_double4.hpp>
#include <glm/geometric.hpp>

#include "scenes/data/vertex_values.h"

namespace quadrille::scenes {
namespace {

using Vector = std::array<double, 4>;

glm::dvec3 xyz(const Vector& v) { return {v[0], v[1], v[2]}; }
void set_xyz(Vector& v, const glm::dvec3& value) { v = {value.x, value.y, value.z, v[3]}; }

/// The weighted sum of a vertex's joints, by rows.
struct Blend {
  std::array<glm::dvec4, 3> rows{};
  [[nodiscard]] glm::dvec3 direction(const glm::dvec3& v) const {
    return {glm::dot(glm::dvec3(rows[0]), v), glm::dot(glm::dvec3(rows[1]), v),
            glm::dot(glm::dvec3(rows[2]), v)};
  }
  [[nodiscard]] glm::dvec3 point(const glm::dvec3& v) const {
    return direction(v) + glm::dvec3(rows[0].w, rows[1].w, rows[2].w);
  }
  /// By cofactors, as the shader does: perpendicular to what `direction` makes of a surface.
  [[nodiscard]] glm::dvec3 normal(const glm::dvec3& v) const {
    const glm::dvec3 x(rows[0]), y(rows[1]), z(rows[2]);
    return {glm::dot(glm::cross(y, z), v), glm::dot(glm::cross(z, x), v), glm::dot(glm::cross(x, y), v)};
  }
};

glm::dvec3 unit(const glm::dvec3& v) {
  const double length = glm::length(v);
  return length > 0 ? v / length : v;
}

class HostPose {
 public:
  HostPose(const SceneData& scene, const Primitive& primitive, const Pose& pose, bool skinned)
      : scene_(scene), primitive_(primitive), pose_(pose), skinned_(skinned) {}

  std::array<std::optional<Array>, kSemantics> run() const {
    std::array<std::optional<Array>, kSemantics> out;
    for (std::size_t s = 0; s < kSemantics; ++s) {
      if (primitive_.attributes[s] >= 0 && changes(s)) out[s] = posed(s);
    }
    return out;
  }

 private:
  [[nodiscard]] const Array& array(int index) const { return scene_.arrays[static_cast<std::size_t>(index)]; }

  [[nodiscard]] bool changes(std::size_t semantic) const {
    if (skinned_ && semantic <= static_cast<std::size_t>(Semantic::kTangent)) return true;
    for (std::size_t t = 0; t < std::min(primitive_.targets.size(), pose_.weights.size()); ++t) {
      if (pose_.weights[t] != 0 && primitive_.targets[t].deltas[semantic] >= 0) return true;
    }
    return false;
  }

  [[nodiscard]] Array posed(std::size_t semantic) const {
    constexpr std::array<traces::Format, 5> kFormats{
        traces::Format::kUndefined, traces::Format::kR32Float, traces::Format::kR32G32Float,
        traces::Format::kR32G32B32Float, traces::Format::kR32G32B32A32Float};
    const Array& base = array(primitive_.attributes[semantic]);
    const auto kind = static_cast<Semantic>(semantic);
    // A normal stored in four small integers becomes three floats; a colour keeps its alpha.
    const int components = kind == Semantic::kNormal ? 3 : traces::format_components(base.format);
    const std::size_t bytes = sizeof(float) * static_cast<std::size_t>(components);
    Array out{base.name + " posed", kFormats[static_cast<std::size_t>(components)], base.count,
              std::vector<std::byte>(base.count * bytes)};
    for (std::size_t vertex = 0; vertex < base.count; ++vertex) {
      Vector value = values_at(base, vertex);
      morph(value, semantic, vertex);
      if (skinned_) skin(value, kind, vertex);
      std::array<float, 4> rounded{};
      for (std::size_t c = 0; c < 4; ++c) rounded[c] = static_cast<float>(value[c]);
      std::memcpy(&out.data[vertex * bytes], rounded.data(), bytes);
    }
    return out;
  }

  void morph(Vector& value, std::size_t semantic, std::size_t vertex) const {
    for (std::size_t t = 0; t < std::min(primitive_.targets.size(), pose_.weights.size()); ++t) {
      const int delta = primitive_.targets[t].deltas[semantic];
      const auto weight = static_cast<double>(pose_.weights[t]);
      if (weight == 0 || delta < 0) continue;
      const Vector add = values_at(array(delta), vertex);
      const int components = traces::format_components(array(delta).format);
      for (std::size_t c = 0; c < static_cast<std::size_t>(components); ++c) value[c] += weight * add[c];
    }
    if (static_cast<Semantic>(semantic) == Semantic::kColor) {
      // [glTF2.0 #morph-targets: colours are clamped after morphing]
      for (double& v : value) v = std::clamp(v, 0.0, 1.0);
    }
  }

  void skin(Vector& value, Semantic kind, std::size_t vertex) const {
    switch (kind) {
      case Semantic::kPosition: return set_xyz(value, blend(vertex).point(xyz(value)));
      case Semantic::kNormal: return set_xyz(value, unit(blend(vertex).normal(xyz(value))));
      case Semantic::kTangent: return set_xyz(value, unit(blend(vertex).direction(xyz(value))));
      case Semantic::kUv0:
      case Semantic::kUv1:
      case Semantic::kColor: return;
    }
  }

  [[nodiscard]] Blend blend(std::size_t vertex) const {
    Blend sum;
    for (const JointSet& set : primitive_.joint_sets) {
      if (set.joints < 0) continue;
      const auto joints = words_at(array(set.joints), vertex);
      const Vector weights = values_at(array(set.weights), vertex);
      for (std::size_t i = 0; i < 4; ++i) {
        if (weights[i] == 0) continue;
        const JointMatrix& matrix = pose_.joints[joints[i]];
        for (std::size_t r = 0; r < 3; ++r) sum.rows[r] += weights[i] * glm::dvec4(matrix[r]);
      }
    }
    return sum;
  }

  const SceneData& scene_;
  const Primitive& primitive_;
  const Pose& pose_;
  bool skinned_;
};

}  // namespace

std::array<std::optional<Array>, kSemantics> pose_on_host(const SceneData& scene, const Primitive& primitive,
                                                          const Pose& pose, bool skinned) {
  return HostPose(scene, primitive, pose, skinned).run();
}

}  // namespace quadrille::scenes
