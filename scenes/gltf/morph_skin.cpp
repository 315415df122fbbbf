/// What moves a mesh's vertices: its morph targets, and the joints that a skin moves them with.
#include "scenes/gltf/mesh.h"

#include <cstring>

#include <fmt/format.h>

#include "models/base/error.h"
#include "scenes/gltf/accessor.h"
#include "scenes/gltf/joint_streams.h"

namespace quadrille::scenes {
namespace {

// of all distinct streams of joints [G: a second]
constexpr std::size_t kMaxJointedVertices = std::size_t{1} << 27;
constexpr std::size_t kMaxJointBoxes = std::size_t{1} << 22;  // of all primitives: 100 MB
constexpr std::array<const char*, kSemantics> kTargetNames{"POSITION",   "NORMAL",     "TANGENT",
                                                           "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"};

std::uint32_t joint_at(const Array& joints, std::size_t component) {
  const std::size_t size = joints.format == traces::Format::kR16G16B16A16Uint ? 2 : 1;
  std::uint32_t value = 0;
  std::memcpy(&value, &joints.data[component * size], size);
  return value;
}

bool has_weight(const Array& weights, std::size_t component) {
  const std::size_t size = traces::format_bytes(weights.format) / 4;
  std::uint32_t bits = 0;
  std::memcpy(&bits, &weights.data[component * size], size);
  return bits << 1 != 0;  // minus zero is none either
}

bool is_vec4(const GltfFile& file, int accessor) {
  const auto& all = file.model.accessors;
  return accessor >= 0 && static_cast<std::size_t>(accessor) < all.size() &&
         all[static_cast<std::size_t>(accessor)].type == TINYGLTF_TYPE_VEC4;
}

glm::vec3 point_at(const Array& positions, std::size_t vertex) {
  glm::vec3 point;
  std::memcpy(&point, &positions.data[vertex * sizeof(point)], sizeof(point));
  return point;
}

}  // namespace

int MeshReader::delta_array(int accessor, std::size_t components, const std::string& place) {
  const auto [entry, added] = delta_arrays_.try_emplace({accessor, components}, -1);
  if (!added) return entry->second;
  const Elements elements = read_accessor(file_, accessor, place);
  require_room(float_bytes(elements), place);
  Array array = to_delta_array(file_, elements, components, fmt::format("{}: accessor {}", place, accessor));
  return entry->second = add_array(std::move(array), place);
}

void MeshReader::read_targets(const tinygltf::Primitive& source, const std::string& place,
                              Primitive& primitive) {
  for (std::size_t t = 0; t < source.targets.size(); ++t) {
    MorphTarget& target = primitive.targets.emplace_back();
    for (std::size_t i = 0; i < kSemantics; ++i) {
      const auto found = source.targets[t].find(kTargetNames[i]);
      if (found == source.targets[t].end() || primitive.attributes[i] < 0) continue;
      const std::string at = fmt::format("{}.targets[{}].{}", place, t, kTargetNames[i]);
      const Array& base = scene_.arrays[static_cast<std::size_t>(primitive.attributes[i])];
      const auto given = static_cast<std::size_t>(traces::format_components(base.format));
      const bool alpha = static_cast<Semantic>(i) == Semantic::kColor && is_vec4(file_, found->second);
      target.deltas[i] = delta_array(found->second, alpha ? 4 : std::min<std::size_t>(3, given), at);
      require_vertices(scene_.arrays[static_cast<std::size_t>(target.deltas[i])].count,
                       scene_.arrays[static_cast<std::size_t>(primitive.attributes[0])].count, at);
    }
    if (target.deltas[0] >= 0) {
      const auto [box, added] = bounds_.try_emplace(target.deltas[0]);
      if (added) box->second = position_bounds(scene_.arrays[static_cast<std::size_t>(target.deltas[0])]);
      target.reach = box->second;
    }
  }
}

/// The streams of all sets that the primitive has; primitives of the same accessors share them.
const std::array<JointSet, 2>& MeshReader::joint_sets(const tinygltf::Primitive& source,
                                                      const std::string& place, std::size_t vertices) {
  std::array<int, 4> accessors{-1, -1, -1, -1};
  std::size_t sets = 0;
  for (; sets < 2; ++sets) {
    const auto joints = source.attributes.find(fmt::format("JOINTS_{}", sets)),
               weights = source.attributes.find(fmt::format("WEIGHTS_{}", sets));
    const bool has_joints = joints != source.attributes.end(),
               has_weights = weights != source.attributes.end();
    if (has_joints != has_weights)
      throw user_error("{}: {}: JOINTS_{} and WEIGHTS_{} come together; one is missing", file_.path, place,
                       sets, sets);
    if (!has_joints) break;
    accessors[2 * sets] = joints->second;
    accessors[2 * sets + 1] = weights->second;
  }
  const auto [entry, added] = joint_arrays_.try_emplace(accessors);
  if (!added) return entry->second;
  std::vector<JointElements> elements;
  const auto at = [&](std::size_t set) { return fmt::format("{}.attributes.JOINTS_{}", place, set); };
  for (std::size_t set = 0; set < sets; ++set) {
    elements.push_back({read_accessor(file_, accessors[2 * set], at(set)),
                        read_accessor(file_, accessors[2 * set + 1], at(set))});
    check_joints(file_, elements.back(), at(set));
    require_room(elements.back().joints.data.size() + float_bytes(elements.back().weights), at(set));
    require_vertices(elements.back().joints.count, vertices, at(set));
  }
  mended_weights_.add(place, mend_weights(elements), vertices);
  for (std::size_t set = 0; set < sets; ++set) {
    auto [numbers, fractions] = to_joint_arrays(std::move(elements[set]));
    entry->second[set] = {add_array(std::move(numbers), at(set)), add_array(std::move(fractions), at(set))};
  }
  return entry->second;
}

void MeshReader::read_joints(const tinygltf::Primitive& source, const std::string& place,
                             Primitive& primitive, std::size_t joint_count, int skin) {
  const std::size_t vertices = scene_.arrays[static_cast<std::size_t>(primitive.attributes[0])].count;
  primitive.joint_sets = joint_sets(source, place, vertices);
  for (std::size_t set = 0; set < primitive.joint_sets.size(); ++set) {
    if (primitive.joint_sets[set].joints < 0) break;
    const std::string at = fmt::format("{}.attributes.JOINTS_{}", place, set);
    require_vertices(scene_.arrays[static_cast<std::size_t>(primitive.joint_sets[set].joints)].count,
                     vertices, at);
    const std::vector<Bounds>& boxes = joint_boxes(primitive.attributes[0], primitive.joint_sets[set], at);
    if (boxes.size() > joint_count)
      throw user_error("{}: {}: JOINTS name joint {}; skins[{}] has {} joints", file_.path, place,
                       boxes.size() - 1, skin, joint_count);
    if (primitive.joint_boxes.size() < boxes.size()) primitive.joint_boxes.resize(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) primitive.joint_boxes[i].add(boxes[i]);
  }
  joint_box_count_ += primitive.joint_boxes.size();
  if (joint_box_count_ > kMaxJointBoxes)
    throw user_error("{}: {}: the scene's primitives hang on more than {} joints", file_.path, place,
                     kMaxJointBoxes);
}

/// What each joint moves, by scanning the vertices once for all primitives that share these arrays.
const std::vector<Bounds>& MeshReader::joint_boxes(int positions, const JointSet& set,
                                                   const std::string& place) {
  const auto [entry, added] = joint_boxes_.try_emplace({positions, set.joints, set.weights});
  std::vector<Bounds>& boxes = entry->second;
  if (!added) return boxes;
  const Array& points = scene_.arrays[static_cast<std::size_t>(positions)];
  const Array& numbers = scene_.arrays[static_cast<std::size_t>(set.joints)];
  const Array& fractions = scene_.arrays[static_cast<std::size_t>(set.weights)];
  jointed_vertices_ += points.count;
  if (jointed_vertices_ > kMaxJointedVertices)
    throw user_error("{}: {}: the scene's skins move more than {} vertices", file_.path, place,
                     kMaxJointedVertices);
  for (std::size_t i = 0; i < std::size_t{4} * points.count; ++i) {
    if (!has_weight(fractions, i)) continue;
    const std::uint32_t joint = joint_at(numbers, i);
    if (boxes.size() <= joint) boxes.resize(joint + 1);
    boxes[joint].add(point_at(points, i / 4));
  }
  return boxes;
}

void MeshReader::read_skinning(int index, std::size_t joints, int skin) {
  const std::vector<std::uint32_t>& numbers = primitives(index);
  const bool first = with_joints_.insert(index).second;
  for (const std::uint32_t number : numbers) {
    const tinygltf::Primitive& source = *sources_[number];
    const auto offset = &source - file_.model.meshes[static_cast<std::size_t>(index)].primitives.data();
    const std::string place = fmt::format("meshes[{}].primitives[{}]", index, offset);
    if (first) read_joints(source, place, scene_.primitives[number], joints, skin);
    const Primitive& primitive = scene_.primitives[number];
    if (primitive.joint_sets[0].joints < 0)
      throw user_error("{}: {}: it is drawn with skins[{}], and has no JOINTS_0 and WEIGHTS_0", file_.path,
                       place, skin);
    if (primitive.joint_boxes.size() > joints) {
      throw user_error("{}: {}: JOINTS name joint {}; skins[{}] has {} joints", file_.path, place,
                       primitive.joint_boxes.size() - 1, skin, joints);
    }
  }
}

}  // namespace quadrille::scenes
