#include "scenes/gltf/tangents.h"

#include <algorithm>
#include <array>
#include <bit>
#include <compare>
#include <cstring>
#include <map>
#include <set>
#include <utility>

#include <glm/geometric.hpp>

#include "scenes/data/tangent_space.h"
#include "scenes/data/vertex_values.h"

namespace quadrille::scenes {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

constexpr std::size_t at(Semantic semantic) { return static_cast<std::size_t>(semantic); }
std::size_t uv_semantic(const TextureUse& use) {
  return at(use.uv_set == 0 ? Semantic::kUv0 : Semantic::kUv1);
}

bool same_coordinates(const TextureUse& a, const TextureUse& b) {
  return a.uv_set == b.uv_set && a.u_row == b.u_row && a.v_row == b.v_row;
}

bool draws_triangles(const Primitive& primitive) {
  return list_of(primitive.topology) == traces::Topology::kTriangleList;
}

/// The map whose coordinates the tangents follow; null: none is needed, or one would not do.
const TextureUse* normal_map(const SceneData& scene, const Primitive& primitive) {
  const Material& material = scene.materials[static_cast<std::size_t>(primitive.material)];
  const auto& has = primitive.attributes;
  if (material.unlit || !draws_triangles(primitive) || has[at(Semantic::kNormal)] < 0 ||
      has[at(Semantic::kTangent)] >= 0)
    return nullptr;
  const auto sampled = [&](TextureSlot slot) -> const TextureUse* {
    const TextureUse& use = material.texture(slot);
    return use.image >= 0 && has[uv_semantic(use)] >= 0 ? &use : nullptr;
  };
  const TextureUse* base = sampled(TextureSlot::kNormal);
  const TextureUse* coat = material.layers.coats() ? sampled(TextureSlot::kClearcoatNormal) : nullptr;
  if (base == nullptr || coat == nullptr) return base != nullptr ? base : coat;
  return same_coordinates(*base, *coat) ? base : nullptr;
}

/// Calls `visit` with each place of a primitive that names one of the scene's arrays.
template <class Visit>
void for_each_array(Primitive& primitive, const Visit& visit) {
  for (int& array : primitive.attributes) visit(array);
  visit(primitive.indices);
  for (MorphTarget& target : primitive.targets)
    for (int& array : target.deltas) visit(array);
  for (JointSet& set : primitive.joint_sets) {
    visit(set.joints);
    visit(set.weights);
  }
}

/// What decides the tangents of a primitive, and the arrays that splitting it changes.
using Recipe = std::pair<std::vector<int>, std::array<float, 6>>;

Recipe recipe_of(Primitive& primitive, const TextureUse& map) {
  Recipe recipe{{static_cast<int>(primitive.topology), static_cast<int>(primitive.count), map.uv_set},
                {map.u_row.x, map.u_row.y, map.u_row.z, map.v_row.x, map.v_row.y, map.v_row.z}};
  for_each_array(primitive, [&](int array) { recipe.first.push_back(array); });
  return recipe;
}

/// The vertices that triangles name, numbered anew in their order.
struct Referenced {
  std::vector<std::uint32_t> vertices, corners;
};

Referenced referenced(const std::vector<std::uint32_t>& corners, std::uint32_t count) {
  Referenced of;
  std::vector<std::uint32_t> number(count, kNone);
  for (const std::uint32_t v : corners) number[v] = 0;
  for (std::uint32_t v = 0; v < count; ++v) {
    if (number[v] == kNone) continue;
    number[v] = static_cast<std::uint32_t>(of.vertices.size());
    of.vertices.push_back(v);
  }
  of.corners.reserve(corners.size());
  for (const std::uint32_t v : corners) of.corners.push_back(number[v]);
  return of;
}

glm::vec3 xyz(const Array& array, std::uint32_t vertex) {
  const auto values = values_at(array, vertex);
  return {glm::dvec3(values[0], values[1], values[2])};
}

/// The tangents of one primitive by corner: at rest, and moved by each morph target that bends it.
class CornerTangents {
 public:
  CornerTangents(const SceneData& scene, const Primitive& primitive, const TextureUse& map,
                 const Referenced& of)
      : scene_(scene), of_(of) {
    const Array& uvs = array(primitive.attributes[uv_semantic(map)]);
    mesh_.corners = of.corners;
    for (const std::uint32_t v : of.vertices) {
      mesh_.positions.push_back(xyz(array(primitive.attributes[at(Semantic::kPosition)]), v));
      mesh_.normals.push_back(xyz(array(primitive.attributes[at(Semantic::kNormal)]), v));
      const auto uv = values_at(uvs, v);
      const glm::vec3 point(glm::dvec3(uv[0], uv[1], 1));
      mesh_.uvs.push_back(map.transformed ? glm::vec2(glm::dot(map.u_row, point), glm::dot(map.v_row, point))
                                          : glm::vec2(point));
    }
  }

  std::vector<glm::vec4> at_rest() { return tangents_of(mesh_); }

  std::vector<glm::vec4> moved(const MorphTarget& target) {
    TangentMesh mesh = mesh_;
    move(mesh.positions, target.deltas[at(Semantic::kPosition)]);
    move(mesh.normals, target.deltas[at(Semantic::kNormal)]);
    return tangents_of(mesh);
  }

 private:
  const Array& array(int number) const { return scene_.arrays[static_cast<std::size_t>(number)]; }
  void move(std::vector<glm::vec3>& values, int delta) const {
    for (std::size_t i = 0; delta >= 0 && i < values.size(); ++i)
      values[i] += xyz(array(delta), of_.vertices[i]);
  }

  const SceneData& scene_;
  const Referenced& of_;
  TangentMesh mesh_;
};

/// Corners of a vertex that share all tangents share a vertex of the new numbering.
struct Split {
  std::vector<std::uint32_t> vertices;   ///< new to old
  std::vector<std::uint32_t> corners;    ///< new
  std::vector<std::uint32_t> corner_of;  ///< by new vertex: one of its corners
};

std::strong_ordering in_order(const glm::vec4& a, const glm::vec4& b) {
  using Bits = std::array<std::uint32_t, 4>;
  return std::bit_cast<Bits>(a) <=> std::bit_cast<Bits>(b);
}

Split split_by(const std::vector<std::vector<glm::vec4>>& tangents, const Referenced& of) {
  const auto compare = [&](std::uint32_t a, std::uint32_t b) {
    for (const auto& set : tangents) {
      if (const auto order = in_order(set[a], set[b]); order != std::strong_ordering::equal) return order;
    }
    return std::strong_ordering::equal;
  };
  std::vector<std::uint32_t> begin(of.vertices.size() + 1, 0), sorted(of.corners.size());
  for (const std::uint32_t v : of.corners) ++begin[v + 1];
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<std::uint32_t> place(begin.begin(), begin.end() - 1);
  for (std::uint32_t c = 0; c < of.corners.size(); ++c) sorted[place[of.corners[c]]++] = c;
  Split split;
  split.corners.resize(of.corners.size());
  for (std::size_t v = 0; v < of.vertices.size(); ++v) {
    const auto first = sorted.begin() + begin[v], last = sorted.begin() + begin[v + 1];
    std::sort(first, last, [&](std::uint32_t a, std::uint32_t b) {
      const auto order = compare(a, b);
      return order == std::strong_ordering::equal ? a < b : order == std::strong_ordering::less;
    });
    for (auto c = first; c != last; ++c) {
      if (c == first || compare(*c, *(c - 1)) != std::strong_ordering::equal) {
        split.vertices.push_back(of.vertices[v]);
        split.corner_of.push_back(*c);
      }
      split.corners[*c] = static_cast<std::uint32_t>(split.vertices.size() - 1);
    }
  }
  return split;
}

Array taken(const Array& from, const std::vector<std::uint32_t>& vertices) {
  const std::size_t bytes = from.data.size() / std::max<std::size_t>(1, from.count);
  Array to{from.name, from.format, static_cast<std::uint32_t>(vertices.size()),
           std::vector<std::byte>(vertices.size() * bytes)};
  for (std::size_t i = 0; i < vertices.size(); ++i)
    std::memcpy(&to.data[i * bytes], &from.data[vertices[i] * bytes], bytes);
  return to;
}

template <class T>
std::vector<std::byte> packed_as(const std::vector<std::uint32_t>& values) {
  std::vector<std::byte> data(values.size() * sizeof(T));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = static_cast<T>(values[i]);
    std::memcpy(&data[i * sizeof(T)], &value, sizeof(T));
  }
  return data;
}

/// Of the type that the primitive had, or the least above it that holds them.
void set_indices(Primitive& primitive, Array& array, const Split& split) {
  const std::size_t vertices = split.vertices.size();
  const bool had = primitive.indices >= 0;
  using traces::IndexType;
  const IndexType least = vertices < 0xff     ? IndexType::kUint8
                          : vertices < 0xffff ? IndexType::kUint16
                                              : IndexType::kUint32;
  primitive.index_type = std::max(least, had ? primitive.index_type : IndexType::kUint16);
  array.count = primitive.count = static_cast<std::uint32_t>(split.corners.size());
  switch (primitive.index_type) {
    case IndexType::kUint8: array.data = packed_as<std::uint8_t>(split.corners); break;
    case IndexType::kUint16: array.data = packed_as<std::uint16_t>(split.corners); break;
    case IndexType::kUint32: array.data = packed_as<std::uint32_t>(split.corners); break;
  }
}

class Adder {
 public:
  explicit Adder(SceneData& scene) : scene_(scene), users_(scene.arrays.size(), 0) {
    for (Primitive& primitive : scene.primitives) {
      std::set<int> arrays;
      for_each_array(primitive, [&](int array) { arrays.insert(array); });
      for (const int array : arrays)
        if (array >= 0) ++users_[static_cast<std::size_t>(array)];
    }
  }

  std::size_t run() {
    std::map<Recipe, std::vector<Primitive*>> alike;
    for (Primitive& primitive : scene_.primitives) {
      if (const TextureUse* map = normal_map(scene_, primitive))
        alike[recipe_of(primitive, *map)].push_back(&primitive);
    }
    for (const auto& [recipe, primitives] : alike) {
      Primitive& first = *primitives.front();
      sharers_ = static_cast<std::uint32_t>(primitives.size());
      add(first, *normal_map(scene_, first));
      for (std::size_t i = 1; i < primitives.size(); ++i) take_over(*primitives[i], first);
    }
    return left_;
  }

 private:
  static void take_over(Primitive& primitive, const Primitive& made) {
    primitive.topology = made.topology;
    primitive.attributes = made.attributes;
    primitive.indices = made.indices;
    primitive.index_type = made.index_type;
    primitive.count = made.count;
    primitive.restarts = made.restarts;
    for (std::size_t t = 0; t < primitive.targets.size(); ++t)
      primitive.targets[t].deltas = made.targets[t].deltas;
    primitive.joint_sets = made.joint_sets;
  }

  void add(Primitive& primitive, const TextureUse& map) {
    const std::size_t triangles =
        primitive.topology == traces::Topology::kTriangleList ? primitive.count / 3 : primitive.count;
    if (triangles > kMostOfPrimitive || !take(triangles)) {
      left_ += sharers_;
      return;
    }
    const std::uint32_t count = array(primitive.attributes[0]).count;
    const Referenced of = referenced(corners_of(scene_, primitive).vertices, count);
    if (of.corners.empty()) return;
    std::vector<std::size_t> bent = bent_targets(primitive);
    if (!take(triangles * bent.size())) {
      left_ += sharers_;
      bent.clear();
    }
    CornerTangents corners(scene_, primitive, map, of);
    std::vector<std::vector<glm::vec4>> tangents{corners.at_rest()};
    for (const std::size_t t : bent) tangents.push_back(corners.moved(primitive.targets[t]));
    const Split split = split_by(tangents, of);
    const bool sparse = 2 * of.vertices.size() <= count;
    const bool anew = sparse || split.vertices.size() > of.vertices.size();
    if (anew) renumber(primitive, split);
    const auto stream = [&](std::size_t set) {
      return tangent_stream(tangents, set, split, anew ? 0 : count);
    };
    primitive.attributes[at(Semantic::kTangent)] = append(stream(0));
    for (std::size_t i = 0; i < bent.size(); ++i)
      primitive.targets[bent[i]].deltas[at(Semantic::kTangent)] = append(stream(i + 1));
  }

  /// Is there room for so many more?
  bool take(std::size_t triangles) {
    if (triangles > kMostTangentTriangles - taken_) return false;
    taken_ += triangles;
    return true;
  }

  /// Targets that move positions or normals.
  static std::vector<std::size_t> bent_targets(const Primitive& primitive) {
    std::vector<std::size_t> bent;
    for (std::size_t t = 0; t < primitive.targets.size(); ++t) {
      const auto& deltas = primitive.targets[t].deltas;
      if (deltas[at(Semantic::kPosition)] >= 0 || deltas[at(Semantic::kNormal)] >= 0) bent.push_back(t);
    }
    return bent;
  }

  /// Set 0: the tangents; others: what a target adds to them. `count`: of the vertices as they were, to which
  /// the stream belongs; 0: it belongs to those of the split.
  static Array tangent_stream(const std::vector<std::vector<glm::vec4>>& tangents, std::size_t set,
                              const Split& split, std::uint32_t count) {
    const std::size_t bytes = set == 0 ? sizeof(glm::vec4) : sizeof(glm::vec3);
    const auto vertices = count > 0 ? count : static_cast<std::uint32_t>(split.vertices.size());
    Array stream{set == 0 ? "TANGENT" : "morph target",
                 set == 0 ? traces::Format::kR32G32B32A32Float : traces::Format::kR32G32B32Float, vertices,
                 std::vector<std::byte>(vertices * bytes)};
    for (std::size_t i = 0; i < split.vertices.size(); ++i) {
      const std::uint32_t corner = split.corner_of[i];
      glm::vec4 value = tangents[set][corner];
      if (set > 0) value -= tangents[0][corner];
      std::memcpy(&stream.data[(count > 0 ? split.vertices[i] : i) * bytes], &value, bytes);
    }
    return stream;
  }

  /// Every stream has the vertices of the split, and indices name them as a list of triangles.
  void renumber(Primitive& primitive, const Split& split) {
    Array indices{"indices", traces::Format::kUndefined, 0, {}};
    if (primitive.indices >= 0) indices.name = array(primitive.indices).name;
    set_indices(primitive, indices, split);
    std::map<int, int> changed;
    for_each_array(primitive, [&](int& number) {
      if (number < 0 || &number == &primitive.indices) return;
      const auto [entry, added] = changed.try_emplace(number, 0);
      if (added) entry->second = replace(number, taken(array(number), split.vertices));
      number = entry->second;
    });
    primitive.indices =
        primitive.indices >= 0 ? replace(primitive.indices, std::move(indices)) : append(std::move(indices));
    primitive.topology = traces::Topology::kTriangleList;
    primitive.restarts = false;
  }

  const Array& array(int number) const { return scene_.arrays[static_cast<std::size_t>(number)]; }

  /// In the old one's place, unless others than the primitives at hand have it.
  int replace(int old, Array array) {
    std::uint32_t& users = users_[static_cast<std::size_t>(old)];
    if (users > sharers_) {
      users -= sharers_;
      return append(std::move(array));
    }
    scene_.arrays[static_cast<std::size_t>(old)] = std::move(array);
    return old;
  }

  int append(Array array) {
    scene_.arrays.push_back(std::move(array));
    users_.push_back(sharers_);
    return static_cast<int>(scene_.arrays.size() - 1);
  }

  SceneData& scene_;
  std::vector<std::uint32_t> users_;  ///< by array: primitives that name it
  std::uint32_t sharers_ = 1;         ///< primitives that get what is made at the moment
  std::size_t taken_ = 0;             ///< triangles
  std::size_t left_ = 0;              ///< primitives
};

}  // namespace

std::size_t add_tangents(SceneData& scene) {
  const bool wanted = std::ranges::any_of(
      scene.primitives, [&](const Primitive& primitive) { return normal_map(scene, primitive) != nullptr; });
  return wanted ? Adder(scene).run() : 0;
}

}  // namespace quadrille::scenes
