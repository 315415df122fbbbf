#include "scenes/gltf/mesh.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>

#include <fmt/format.h>

#include "models/base/error.h"
#include "scenes/gltf/accessor.h"
#include "scenes/gltf/material.h"

namespace quadrille::scenes {
namespace {

constexpr std::uint64_t kMaxGeometryBytes = std::uint64_t{3} << 29;  // 1.5 GiB of decoded streams
// and of these, what a file may have beyond four times its buffers
constexpr std::uint64_t kFreeGeometryBytes = std::uint64_t{1} << 28;
constexpr std::array<const char*, kSemantics> kAttributeNames{"POSITION",   "NORMAL",     "TANGENT",
                                                              "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"};

/// [glTF2.0 #meshes: mode] A loop is a strip that comes back to its first vertex (`close_loop`).
traces::Topology topology(const GltfFile& file, int mode, const std::string& place) {
  switch (mode) {
    case -1:
    case TINYGLTF_MODE_TRIANGLES: return traces::Topology::kTriangleList;
    case TINYGLTF_MODE_TRIANGLE_STRIP: return traces::Topology::kTriangleStrip;
    case TINYGLTF_MODE_TRIANGLE_FAN: return traces::Topology::kTriangleFan;
    case TINYGLTF_MODE_POINTS: return traces::Topology::kPointList;
    case TINYGLTF_MODE_LINE: return traces::Topology::kLineList;
    case TINYGLTF_MODE_LINE_LOOP:
    case TINYGLTF_MODE_LINE_STRIP: return traces::Topology::kLineStrip;
    default: throw user_error("{}: {}: primitive mode {} is not one of glTF's", file.path, place, mode);
  }
}

}  // namespace

const std::vector<std::uint32_t>& MeshReader::primitives(int index) {
  const auto [entry, added] = meshes_.try_emplace(index);
  if (!added) return entry->second;
  const tinygltf::Mesh& mesh = file_.model.meshes[static_cast<std::size_t>(index)];
  for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
    Primitive primitive;
    const std::string place = fmt::format("meshes[{}].primitives[{}]", index, i);
    primitive.name = mesh.name.empty() ? place : fmt::format("{}[{}]", mesh.name, i);
    if (!read_primitive(mesh.primitives[i], place, primitive)) continue;
    entry->second.push_back(static_cast<std::uint32_t>(scene_.primitives.size()));
    scene_.primitives.push_back(std::move(primitive));
    sources_.push_back(&mesh.primitives[i]);
    if (mesh.primitives[i].targets.size() != mesh.primitives[0].targets.size()) {
      throw user_error("{}: {}.targets: {} where the mesh's first primitive has {}", file_.path, place,
                       mesh.primitives[i].targets.size(), mesh.primitives[0].targets.size());
    }
  }
  return entry->second;
}

bool MeshReader::read_primitive(const tinygltf::Primitive& source, const std::string& place,
                                Primitive& primitive) {
  primitive.topology = topology(file_, source.mode, place);
  if (!source.attributes.contains("POSITION")) return false;  // nothing to draw [glTF2.0 #meshes-overview]
  read_attributes(source, place, primitive);
  const int positions = primitive.attributes[0];
  primitive.count = scene_.arrays[static_cast<std::size_t>(positions)].count;
  if (source.indices >= 0) read_indices(source, place, primitive);
  if (source.mode == TINYGLTF_MODE_LINE_LOOP) close_loop(place, primitive);
  primitive.material = material(source.material, place);
  const auto [box, added] = bounds_.try_emplace(positions);
  if (added) box->second = position_bounds(scene_.arrays[static_cast<std::size_t>(positions)]);
  primitive.bounds = box->second;
  read_targets(source, place, primitive);
  return true;
}

void MeshReader::read_attributes(const tinygltf::Primitive& source, const std::string& place,
                                 Primitive& primitive) {
  for (std::size_t i = 0; i < kSemantics; ++i) {
    const auto found = source.attributes.find(kAttributeNames[i]);
    if (found == source.attributes.end()) continue;
    const std::string at = fmt::format("{}.attributes.{}", place, kAttributeNames[i]);
    primitive.attributes[i] = vertex_array(found->second, static_cast<Semantic>(i), at);
    require_vertices(scene_.arrays[static_cast<std::size_t>(primitive.attributes[i])].count,
                     scene_.arrays[static_cast<std::size_t>(primitive.attributes[0])].count, at);
  }
  check_directions(place, primitive);
}

/// Normals that point nowhere give way to those of their faces; a normal map's frame with such tangents, to
/// the one that texture coordinates span: each as where the file has none.
void MeshReader::check_directions(const std::string& place, Primitive& primitive) {
  const std::size_t vertices = scene_.arrays[static_cast<std::size_t>(primitive.attributes[0])].count;
  const auto lacking = [&](Semantic semantic) {
    const auto found = without_direction_.find(primitive.attributes[static_cast<std::size_t>(semantic)]);
    return found == without_direction_.end() ? 0U : found->second;
  };
  mended_normals_.add(place, lacking(Semantic::kNormal), vertices);
  primitive.partial_normals = lacking(Semantic::kNormal) > 0;
  if (lacking(Semantic::kTangent) == 0) return;
  dropped_tangents_.add(place, lacking(Semantic::kTangent), vertices);
  primitive.attributes[static_cast<std::size_t>(Semantic::kTangent)] = -1;
}

void MeshReader::require_vertices(std::size_t count, std::size_t vertices, const std::string& place) const {
  if (count != vertices)
    throw user_error("{}: {}: {} elements where POSITION has {}", file_.path, place, count, vertices);
}

void MeshReader::Mended::add(const std::string& place, std::size_t mended, std::size_t vertices) {
  if (mended == 0) return;
  if (places++ == 0) first_place = place;
  count += mended;
  of += vertices;
}

std::string MeshReader::Mended::text() const {
  return fmt::format("{}{}: {} of {} vertices", first_place,
                     places > 1 ? fmt::format(" and {} more", places - 1) : "", count, of);
}

std::vector<std::string> MeshReader::take_notes() {
  std::vector<std::string> notes;
  const auto take = [&](Mended& mended, const char* what) {
    if (mended.places > 0) notes.push_back(std::exchange(mended, {}).text() + what);
  };
  take(mended_normals_,
       " have a normal without a direction; faces of such vertices are drawn with their own");
  take(dropped_tangents_,
       " have a tangent without a direction; normal maps there follow the texture coordinates");
  take(mended_weights_,
       " have joint weights that do not sum to 1; they are divided by their sum, and without any weight the "
       "first joint moves the vertex");
  return notes;
}

void MeshReader::read_indices(const tinygltf::Primitive& source, const std::string& place,
                              Primitive& primitive) {
  const std::string at = place + ".indices";
  primitive.indices = index_array(source.indices, at);
  primitive.index_type = index_arrays_.at(source.indices).second;
  const std::uint32_t largest = largest_index_.at(primitive.indices);
  if (largest >= primitive.count)
    throw user_error("{}: {}: accessor {}: index {} is beyond {} vertices", file_.path, at, source.indices,
                     largest, primitive.count);
  primitive.count = scene_.arrays[static_cast<std::size_t>(primitive.indices)].count;
}

namespace {

/// 0, 1, 2, ... of 32 bits.
Array counted_indices(std::uint32_t count) {
  Array array{{}, traces::Format::kUndefined, count, std::vector<std::byte>(std::size_t{count} * 4)};
  for (std::uint32_t i = 0; i < count; ++i) std::memcpy(&array.data[std::size_t{i} * 4], &i, 4);
  return array;
}

}  // namespace

/// The indices of a loop (or its vertices, counted), and the first once more.
void MeshReader::close_loop(const std::string& place, Primitive& primitive) {
  if (primitive.count < 2) return;
  if (primitive.indices < 0) {
    require_room(std::uint64_t{primitive.count} * 4, place);
    primitive.index_type = traces::IndexType::kUint32;
  }
  Array closed = primitive.indices < 0 ? counted_indices(primitive.count)
                                       : scene_.arrays[static_cast<std::size_t>(primitive.indices)];
  const std::size_t bytes = closed.data.size() / closed.count;
  closed.data.reserve(closed.data.size() + bytes);
  std::copy_n(closed.data.begin(), bytes, std::back_inserter(closed.data));
  ++closed.count;
  primitive.count = closed.count;
  primitive.indices = add_array(std::move(closed), place + ".indices");
}

int MeshReader::add_array(Array array, const std::string& place) {
  array.name = place;
  require_room(array.data.size(), place);
  total_bytes_ += array.data.size();
  scene_.arrays.push_back(std::move(array));
  return static_cast<int>(scene_.arrays.size() - 1);
}

void MeshReader::require_room(std::uint64_t bytes, const std::string& place) const {
  std::uint64_t limit = kFreeGeometryBytes;
  for (const tinygltf::Buffer& buffer : file_.model.buffers) limit += 4 * std::uint64_t{buffer.data.size()};
  limit = std::min(limit, kMaxGeometryBytes);
  if (total_bytes_ + bytes > limit)
    throw user_error("{}: {}: the scene's geometry takes more than {} bytes", file_.path, place, limit);
}

int MeshReader::vertex_array(int accessor, Semantic semantic, const std::string& place) {
  const auto found = vertex_arrays_.find({accessor, semantic});
  if (found != vertex_arrays_.end()) return found->second;
  Elements elements = read_accessor(file_, accessor, place);
  require_room(vertex_array_bytes(elements, semantic), place);
  std::uint32_t lacking = 0;
  const int array = add_array(
      to_vertex_array(file_, elements, semantic, fmt::format("{}: accessor {}", place, accessor), &lacking),
      place);
  if (lacking > 0) without_direction_[array] = lacking;
  return vertex_arrays_[{accessor, semantic}] = array;
}

int MeshReader::index_array(int accessor, const std::string& place) {
  const auto found = index_arrays_.find(accessor);
  if (found != index_arrays_.end()) return found->second.first;
  Elements elements = read_accessor(file_, accessor, place);
  const bool is_unsigned = elements.component == Component::kUint8 ||
                           elements.component == Component::kUint16 ||
                           elements.component == Component::kUint32;
  if (elements.components != 1 || !is_unsigned)
    throw user_error("{}: {}: accessor {}: indices are unsigned scalars", file_.path, place, accessor);
  const std::size_t size = component_bytes(elements.component);
  std::uint32_t largest = 0;
  for (std::size_t i = 0; i < elements.count; ++i) {
    std::uint32_t value = 0;
    std::memcpy(&value, &elements.data[i * size], size);
    largest = std::max(largest, value);
  }
  const traces::IndexType type = size == 1   ? traces::IndexType::kUint8
                                 : size == 2 ? traces::IndexType::kUint16
                                             : traces::IndexType::kUint32;
  const int array =
      add_array({{}, traces::Format::kUndefined, elements.count, std::move(elements.data)}, place);
  largest_index_[array] = largest;
  index_arrays_[accessor] = {array, type};
  return array;
}

int MeshReader::material(int index, const std::string& place) {
  if (index < -1 || index >= static_cast<int>(file_.model.materials.size())) {
    throw user_error("{}: {}.material: material {} does not exist (the file has {})", file_.path, place,
                     index, file_.model.materials.size());
  }
  const auto [entry, added] = materials_.try_emplace(index, static_cast<int>(scene_.materials.size()));
  if (added)
    scene_.materials.push_back(index < 0 ? Material{}
                                         : read_material(file_, static_cast<std::size_t>(index)));
  return entry->second;
}

Bounds MeshReader::position_bounds(const Array& positions) const {
  Bounds box;
  for (std::size_t i = 0; i < positions.count; ++i) {
    glm::vec3 point;
    std::memcpy(&point, &positions.data[i * sizeof(point)], sizeof(point));
    box.add(point);
  }
  return box;
}

}  // namespace quadrille::scenes
