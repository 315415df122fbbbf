#include "scenes/record/facets.h"

#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>

#include "models/base/error.h"
#include "scenes/data/vertex_values.h"
#include "scenes/record/host_pose.h"

namespace quadrille::scenes {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{3} << 28;  // 768 MiB

constexpr std::size_t at(Semantic semantic) { return static_cast<std::size_t>(semantic); }

bool wants_facets(const SceneData& scene, const Primitive& primitive, ShaderSet set) {
  if (!draws_triangles(primitive.topology) || primitive.attributes[at(Semantic::kPosition)] < 0) return false;
  const bool lacks = primitive.attributes[at(Semantic::kNormal)] < 0 || primitive.partial_normals;
  if (set == ShaderSet::kNormal) return lacks;
  if (!lights_by_phong(set) || scene.materials[static_cast<std::size_t>(primitive.material)].unlit)
    return false;
  return set == ShaderSet::kFlat || lacks;
}

glm::dvec3 xyz(const Array& array, std::uint32_t vertex) {
  const auto v = values_at(array, vertex);
  return {v[0], v[1], v[2]};
}

/// Of unit length, counter-clockwise seen from its front; zero for a triangle without area.
glm::dvec3 face_normal(const Array& positions, const std::uint32_t* corners) {
  const glm::dvec3 a = xyz(positions, corners[0]);
  const glm::dvec3 normal = glm::cross(xyz(positions, corners[1]) - a, xyz(positions, corners[2]) - a);
  const double length = std::sqrt(glm::dot(normal, normal));
  return length > 0 ? normal / length : normal;
}

class Facets {
 public:
  Facets(const SceneData& scene, ShaderSet set) : scene_(scene), set_(set) {}

  SceneData run() {
    SceneData out;
    static_cast<Placements&>(out) = static_cast<const Placements&>(scene_);
    out.name = scene_.name;
    out.images = scene_.images;
    out.materials = scene_.materials;
    out.poses = scene_.poses;
    out.environment = scene_.environment;
    out.background = scene_.background;
    out.depth = scene_.depth;
    out.post_shader = scene_.post_shader;
    for (Instance& instance : out.instances) replace(out, instance);
    return out;
  }

 private:
  void replace(SceneData& out, Instance& instance) {
    const Primitive& primitive = scene_.primitives[instance.primitive];
    const bool faceted = wants_facets(scene_, primitive, set_);
    const auto [entry, added] = made_.try_emplace({instance.primitive, faceted ? instance.pose : -1});
    if (added) {
      entry->second.first = static_cast<std::uint32_t>(out.primitives.size());
      entry->second.second = faceted ? still_pose(out, instance.pose) : -1;
      out.primitives.push_back(faceted ? facets_of(out, primitive, instance.pose) : kept(out, primitive));
    }
    instance.primitive = entry->second.first;
    if (faceted) instance.pose = entry->second.second;
  }

  /// What is left of a pose whose vertices are where they belong: whether it turned the faces over.
  static int still_pose(SceneData& out, int pose) {
    if (pose < 0) return -1;
    out.poses.push_back({{}, {}, out.poses[static_cast<std::size_t>(pose)].mirrored});
    return static_cast<int>(out.poses.size() - 1);
  }

  /// The same primitive over arrays of the new scene.
  Primitive kept(SceneData& out, const Primitive& primitive) {
    Primitive same = primitive;
    for (int& array : same.attributes) array = array_of(out, array);
    same.indices = array_of(out, same.indices);
    for (MorphTarget& target : same.targets)
      for (int& array : target.deltas) array = array_of(out, array);
    for (JointSet& set : same.joint_sets) {
      set.joints = array_of(out, set.joints);
      set.weights = array_of(out, set.weights);
    }
    return same;
  }

  int array_of(SceneData& out, int array) {
    if (array < 0) return array;
    const auto [entry, added] = kept_arrays_.try_emplace(array, static_cast<int>(out.arrays.size()));
    if (added) out.arrays.push_back(scene_.arrays[static_cast<std::size_t>(array)]);
    return entry->second;
  }

  Primitive facets_of(SceneData& out, const Primitive& primitive, int pose) {
    std::array<std::optional<Array>, kSemantics> posed;
    if (pose >= 0) {
      const Pose& how = scene_.poses[static_cast<std::size_t>(pose)];
      posed = pose_on_host(scene_, primitive, how, !how.joints.empty());
    }
    const auto stream = [&](std::size_t semantic) -> const Array& {
      return posed[semantic] ? *posed[semantic]
                             : scene_.arrays[static_cast<std::size_t>(primitive.attributes[semantic])];
    };
    const Corners corners = corners_of(scene_, primitive);
    Primitive faceted = primitive;
    faceted.topology = traces::Topology::kTriangleList;
    faceted.indices = -1;
    faceted.restarts = faceted.partial_normals = false;
    faceted.count = static_cast<std::uint32_t>(corners.vertices.size());
    faceted.targets.clear();
    faceted.joint_sets = {};
    faceted.joint_boxes.clear();
    for (std::size_t s = 0; s < kSemantics; ++s) {
      if (primitive.attributes[s] < 0 || s == at(Semantic::kNormal) || s == at(Semantic::kTangent)) continue;
      faceted.attributes[s] = add(out, taken_apart(stream(s), corners));
    }
    faceted.attributes[at(Semantic::kTangent)] = -1;
    const Array* const normals = primitive.partial_normals && set_ != ShaderSet::kFlat &&
                                         primitive.attributes[at(Semantic::kNormal)] >= 0
                                     ? &stream(at(Semantic::kNormal))
                                     : nullptr;
    faceted.attributes[at(Semantic::kNormal)] =
        add(out, face_normals(stream(at(Semantic::kPosition)), normals, corners));
    if (pose >= 0) set_bounds(faceted, stream(at(Semantic::kPosition)));
    return faceted;
  }

  static Array taken_apart(const Array& shared, const Corners& corners) {
    const std::size_t bytes = traces::format_bytes(shared.format);
    Array own{shared.name + " by faces", shared.format, static_cast<std::uint32_t>(corners.vertices.size()),
              std::vector<std::byte>(corners.vertices.size() * bytes)};
    for (std::size_t i = 0; i < corners.vertices.size(); ++i)
      std::memcpy(&own.data[i * bytes], &shared.data[corners.vertices[i] * bytes], bytes);
    return own;
  }

  /// Those of the faces, or of the vertices in `normals` that have one.
  static Array face_normals(const Array& positions, const Array* normals, const Corners& corners) {
    Array own{positions.name + " face normals", traces::Format::kR32G32B32Float,
              static_cast<std::uint32_t>(corners.vertices.size()),
              std::vector<std::byte>(corners.vertices.size() * sizeof(glm::vec3))};
    for (std::size_t i = 0; i < corners.vertices.size(); ++i) {
      glm::dvec3 normal(0);
      if (normals != nullptr) normal = xyz(*normals, corners.vertices[i]);
      if (normal == glm::dvec3(0)) normal = face_normal(positions, &corners.vertices[i - i % 3]);
      const glm::vec3 rounded(normal);
      std::memcpy(&own.data[i * sizeof(rounded)], &rounded, sizeof(rounded));
    }
    return own;
  }

  static void set_bounds(Primitive& primitive, const Array& positions) {
    primitive.bounds = {};
    for (std::uint32_t i = 0; i < positions.count; ++i) primitive.bounds.add(glm::vec3(xyz(positions, i)));
  }

  int add(SceneData& out, Array array) {
    bytes_ += array.data.size();
    if (bytes_ > kMaxBytes)
      throw user_error("{}: vertices of faces of their own take more than {} bytes", scene_.name, kMaxBytes);
    out.arrays.push_back(std::move(array));
    return static_cast<int>(out.arrays.size() - 1);
  }

  const SceneData& scene_;
  ShaderSet set_;
  /// by primitive and pose: the new primitive and pose
  std::map<std::pair<std::uint32_t, int>, std::pair<std::uint32_t, int>> made_;
  std::map<int, int> kept_arrays_;
  std::size_t bytes_ = 0;
};

}  // namespace

std::optional<SceneData> with_facets(const SceneData& scene, ShaderSet set) {
  for (const Instance& instance : scene.instances) {
    if (wants_facets(scene, scene.primitives[instance.primitive], set)) return Facets(scene, set).run();
  }
  return std::nullopt;
}

}  // namespace quadrille::scenes
