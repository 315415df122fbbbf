#include "scenes/gltf/skin.h"

#include <algorithm>
#include <cmath>

#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "models/base/error.h"
#include "scenes/gltf/accessor.h"

namespace quadrille::scenes {
namespace {

constexpr double kAffineTolerance = 1e-3;  // [G: rounding of exporters]
// sizes whose squares the shader's cross products hold with ease; also what is far, in sizes of the
// skeleton
constexpr double kFarFromOne = 1024;

glm::dmat4 matrix_of(const Elements& e, std::size_t index) {
  glm::dmat4 m(1);
  for (int i = 0; i < 16; ++i)
    m[i / 4][i % 4] = static_cast<double>(component_value(e, index, static_cast<std::size_t>(i)));
  return m;
}

bool is_affine(const glm::dmat4& m) {
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 3; ++r) {
      if (!std::isfinite(m[c][r])) return false;
    }
    if (!(std::abs(m[c][3] - (c == 3 ? 1.0 : 0.0)) <= kAffineTolerance)) return false;
  }
  return true;
}

/// The longest column of all joints' matrices: how large the skin is drawn.
double size_of(const std::vector<glm::dmat4>& joints) {
  double size = 0;
  for (const glm::dmat4& m : joints) {
    for (int c = 0; c < 3; ++c) size = std::max(size, glm::length(glm::dvec3(m[c])));
  }
  return size;
}

/// Where the skeleton is, if that is far away for its size; otherwise the origin. A point that floats hold.
glm::dvec3 far_center(const std::vector<glm::dvec3>& places, double size) {
  glm::dvec3 mean(0);
  for (const glm::dvec3& p : places) mean += p / static_cast<double>(places.size());
  double reach = size;
  for (const glm::dvec3& p : places) reach = std::max(reach, glm::length(p - mean));
  return glm::length(mean) > kFarFromOne * reach ? glm::dvec3(glm::vec3(mean)) : glm::dvec3(0);
}

}  // namespace

Skin read_skin(const GltfFile& file, int index, const std::string& place) {
  const auto& skins = file.model.skins;
  if (index < 0 || static_cast<std::size_t>(index) >= skins.size())
    throw user_error("{}: {}: skin {} does not exist (the file has {})", file.path, place, index,
                     skins.size());
  const tinygltf::Skin& source = skins[static_cast<std::size_t>(index)];
  if (source.joints.empty()) throw user_error("{}: skins[{}].joints: there are none", file.path, index);
  for (const int node : source.joints) {
    if (node < 0 || static_cast<std::size_t>(node) >= file.model.nodes.size())
      throw user_error("{}: skins[{}].joints: node {} does not exist (the file has {})", file.path, index,
                       node, file.model.nodes.size());
  }
  Skin skin{source.joints, std::vector<glm::dmat4>(source.joints.size(), glm::dmat4(1))};
  if (source.inverseBindMatrices < 0) return skin;
  const std::string at = fmt::format("skins[{}].inverseBindMatrices", index);
  const Elements e = read_accessor(file, source.inverseBindMatrices, at);
  if (e.components != 16 || e.component != Component::kFloat)
    throw user_error("{}: {}: accessor {} is not of 4x4 float matrices", file.path, at,
                     source.inverseBindMatrices);
  if (e.count < skin.joints.size())
    throw user_error("{}: {}: {} matrices for {} joints", file.path, at, e.count, skin.joints.size());
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    skin.inverse_binds[i] = matrix_of(e, i);
    if (!is_affine(skin.inverse_binds[i]))
      throw user_error("{}: {}: matrix {} is not finite and affine", file.path, at, i);
  }
  return skin;
}

void pose_skin(const GltfFile& file, int index, const Skin& skin,
               const std::vector<std::optional<glm::dmat4>>& worlds, Pose& pose, glm::dmat4& model) {
  std::vector<glm::dmat4> joints;
  std::vector<glm::dvec3> places;
  joints.reserve(skin.joints.size());
  for (std::size_t i = 0; i < skin.joints.size(); ++i) {
    const std::optional<glm::dmat4>& world = worlds[static_cast<std::size_t>(skin.joints[i])];
    if (!world)
      throw user_error("{}: skins[{}].joints: node {} is not in the scene that is drawn", file.path, index,
                       skin.joints[i]);
    joints.push_back(*world * skin.inverse_binds[i]);
    places.emplace_back((*world)[3]);
  }
  const double size = size_of(joints);
  if (!std::isfinite(static_cast<float>(size)))
    throw user_error("{}: skins[{}]: a joint's matrix is not finite", file.path, index);
  const bool plain = size == 0 || (size < kFarFromOne && size * kFarFromOne > 1);
  const double unit = plain ? 1.0 : std::ldexp(1.0, std::ilogb(size));
  const glm::dvec3 center = far_center(places, size);
  model = glm::dmat4(unit);
  model[3] = glm::dvec4(center, 1);
  std::ptrdiff_t mirrored = 0;
  pose.joints.clear();
  for (const glm::dmat4& m : joints) {
    JointMatrix rows;
    for (int r = 0; r < 3; ++r)
      rows[static_cast<std::size_t>(r)] =
          glm::vec4(m[0][r] / unit, m[1][r] / unit, m[2][r] / unit, (m[3][r] - center[r]) / unit);
    if (!std::isfinite(rows[0].w + rows[1].w + rows[2].w))
      throw user_error("{}: skins[{}]: a joint's matrix is not finite", file.path, index);
    pose.joints.push_back(rows);
    mirrored += glm::determinant(glm::dmat3(m)) < 0 ? 1 : -1;
  }
  pose.mirrored = mirrored > 0;
}

}  // namespace quadrille::scenes
