#include "scenes/data/tangent_space.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <glm/ext/vector_double2.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>

#include "models/base/error.h"

namespace quadrille::scenes {
namespace {

using Corner = std::uint32_t;  ///< 3 * triangle + which; also the edge from it to the triangle's next corner
constexpr std::uint32_t kNone = ~std::uint32_t{0};
/// around a vertex; with more, edges are sorted
constexpr std::size_t kFewCorners = 24;
/// areas and lengths up to here count as none [P: Mikkelsen 2008]
constexpr double kNothing = std::numeric_limits<float>::min();

Corner next(Corner c) { return c % 3 == 2 ? c - 2 : c + 1; }
Corner previous(Corner c) { return c % 3 == 0 ? c + 2 : c - 1; }

/// Zero stays zero; also what is too large or no number.
glm::dvec3 unit(const glm::dvec3& v) {
  const double length = std::sqrt(glm::dot(v, v));
  return length > 0 && length < std::numeric_limits<double>::infinity() ? v / length : glm::dvec3(0);
}

glm::dvec3 in_plane(const glm::dvec3& v, const glm::dvec3& normal) {
  return unit(v - normal * glm::dot(normal, v));
}

/// Radians between unit vectors of this dot product, to 2e-8. [P: Abramowitz and Stegun 1964, 4.4.46]
double angle_of(double cosine) {
  constexpr std::array<double, 8> kTerms{1.5707963050, -0.2145988016, 0.0889789874, -0.0501743046,
                                         0.0308918810, -0.0170881256, 0.0066700901, -0.0012624911};
  const double x = std::min(std::fabs(cosine), 1.0);
  double sum = 0;
  for (std::size_t i = kTerms.size(); i-- > 0;) sum = sum * x + kTerms[i];
  const double angle = std::sqrt(1 - x) * sum;
  return cosine < 0 ? 3.141592653589793 - angle : angle;
}

glm::vec4 without_coordinates(const glm::dvec3& normal) {
  glm::dvec3 tangent = in_plane({1, 0, 0}, normal);
  if (tangent == glm::dvec3(0)) tangent = in_plane({0, 1, 0}, normal);
  return {glm::vec3(tangent), 1};
}

/// A vertex's values as bits; zeros of either sign are equal.
using Key = std::array<std::uint32_t, 8>;

Key key_of(const TangentMesh& mesh, std::uint32_t vertex) {
  const glm::vec3 &p = mesh.positions[vertex], &n = mesh.normals[vertex];
  const glm::vec2& uv = mesh.uvs[vertex];
  Key key{};
  const std::array<float, 8> values{p.x, p.y, p.z, n.x, n.y, n.z, uv.x, uv.y};
  for (std::size_t i = 0; i < values.size(); ++i) key[i] = std::bit_cast<std::uint32_t>(values[i] + 0.0F);
  return key;
}

std::uint64_t hash_of(const Key& key) {
  std::uint64_t hash = 0;
  for (const std::uint32_t word : key) {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15U;
    hash ^= hash >> 29;
  }
  return hash;
}

/// By vertex: the first one of the same values.
std::vector<std::uint32_t> welded(const TangentMesh& mesh) {
  const auto count = static_cast<std::uint32_t>(mesh.positions.size());
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order(count);
  for (std::uint32_t v = 0; v < count; ++v) order[v] = {hash_of(key_of(mesh, v)), v};
  std::ranges::sort(order);
  std::vector<std::uint32_t> first(count);
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    while (end < count && order[end].first == order[begin].first) ++end;
    if (end - begin > 1) {
      std::ranges::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(begin),
                               order.begin() + static_cast<std::ptrdiff_t>(end), {},
                               [&](const auto& entry) { return key_of(mesh, entry.second); });
    }
    for (std::size_t i = begin; i < end; ++i) {
      const bool same = i > begin && key_of(mesh, order[i].second) == key_of(mesh, order[i - 1].second);
      first[order[i].second] = same ? first[order[i - 1].second] : order[i].second;
    }
  }
  return first;
}

class TangentSpace {
 public:
  explicit TangentSpace(const TangentMesh& mesh) : mesh_(mesh), corners_(mesh.corners.size()) {}

  std::vector<glm::vec4> run() {
    const std::vector<std::uint32_t> first = welded(mesh_);
    vertices_.resize(corners_);
    for (Corner c = 0; c < corners_; ++c) vertices_[c] = first[mesh_.corners[c]];
    measure_triangles();
    sort_by_vertex();
    join_edges();
    form_groups();
    return tangents();
  }

 private:
  struct Triangle {
    glm::dvec3 along{0};     ///< in which u grows, unit length
    bool whole = false;      ///< its corners are in three places
    bool any = true;         ///< no winding of its own
    bool same_side = false;  ///< the coordinates wind as the corners do
  };

  [[nodiscard]] glm::dvec3 position(Corner c) const { return {mesh_.positions[vertices_[c]]}; }
  [[nodiscard]] glm::dvec3 normal(Corner c) const { return unit({mesh_.normals[vertices_[c]]}); }

  void measure_triangles() {
    triangles_.resize(corners_ / 3);
    for (std::size_t t = 0; t < triangles_.size(); ++t) measure(triangles_[t], static_cast<Corner>(3 * t));
  }

  /// The gradient of u over the triangle, which is the direction across the edges of constant u. The sign of
  /// the area turns it where the coordinates are mirrored.
  void measure(Triangle& triangle, Corner c) const {
    const glm::dvec3 a = position(c), ab = position(c + 1) - a, ac = position(c + 2) - a;
    triangle.whole = ab != glm::dvec3(0) && ac != glm::dvec3(0) && ab != ac;
    const glm::dvec2 at(mesh_.uvs[vertices_[c]]);
    const glm::dvec2 u = glm::dvec2(mesh_.uvs[vertices_[c + 1]]) - at,
                     w = glm::dvec2(mesh_.uvs[vertices_[c + 2]]) - at;
    const double area = u.x * w.y - u.y * w.x;
    if (!(std::fabs(area) > kNothing)) return;
    triangle.same_side = area > 0;
    const glm::dvec3 along = unit(w.y * ab - u.y * ac), across = unit(u.x * ac - w.x * ab);
    triangle.along = triangle.same_side ? along : -along;
    triangle.any = along == glm::dvec3(0) || across == glm::dvec3(0);
  }

  /// The corners of whole triangles, by vertex and then in the triangles' order.
  void sort_by_vertex() {
    begin_.assign(mesh_.positions.size() + 1, 0);
    for (Corner c = 0; c < corners_; ++c)
      if (triangles_[c / 3].whole) ++begin_[vertices_[c] + 1];
    for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    sorted_.resize(begin_.back());
    std::vector<std::uint32_t> at(begin_.begin(), begin_.end() - 1);
    for (Corner c = 0; c < corners_; ++c)
      if (triangles_[c / 3].whole) sorted_[at[vertices_[c]]++] = c;
  }

  /// An edge meets the first one the other way that is left over; each pair is found at its lesser vertex.
  void join_edges() {
    twin_.assign(corners_, kNone);
    for (std::uint32_t v = 0; v + 1 < begin_.size(); ++v) {
      if (begin_[v + 1] - begin_[v] <= kFewCorners) join_few(v);
      else join_many(v);
    }
  }

  void join_few(std::uint32_t v) {
    for (std::uint32_t i = begin_[v]; i < begin_[v + 1]; ++i) {
      const Corner out = sorted_[i];
      const std::uint32_t other = vertices_[next(out)];
      if (other < v) continue;
      for (std::uint32_t j = begin_[v]; j < begin_[v + 1]; ++j) {
        const Corner in = previous(sorted_[j]);
        if (vertices_[in] != other || twin_[in] != kNone) continue;
        twin_[in] = out;
        twin_[out] = in;
        break;
      }
    }
  }

  void join_many(std::uint32_t v) {
    std::vector<std::pair<std::uint32_t, Corner>> out, in;
    for (std::uint32_t i = begin_[v]; i < begin_[v + 1]; ++i) {
      out.emplace_back(vertices_[next(sorted_[i])], sorted_[i]);
      in.emplace_back(vertices_[previous(sorted_[i])], previous(sorted_[i]));
    }
    std::ranges::sort(out);
    std::ranges::sort(in);
    for (std::size_t i = 0, j = 0; i < out.size() && j < in.size();) {
      if (out[i].first != in[j].first || out[i].first < v) {
        ++(out[i].first <= in[j].first ? i : j);
        continue;
      }
      twin_[in[j].second] = out[i].second;
      twin_[out[i++].second] = in[j++].second;
    }
  }

  void form_groups() {
    group_.assign(corners_, kNone);
    for (Corner c = 0; c < corners_; ++c) {
      const Triangle& triangle = triangles_[c / 3];
      if (!triangle.whole || triangle.any || group_[c] != kNone) continue;
      group_[c] = static_cast<std::uint32_t>(same_side_.size());
      same_side_.push_back(triangle.same_side);
      spread(c);
    }
  }

  /// From triangle to triangle around the vertex, first across the edge that leaves it.
  void spread(Corner from) {
    const std::uint32_t group = group_[from];
    std::vector<Corner>& open = open_;
    const auto push_neighbours = [&](Corner c) {
      if (const Corner left = twin_[previous(c)]; left != kNone) open.push_back(left);
      if (const Corner right = twin_[c]; right != kNone) open.push_back(next(right));
    };
    push_neighbours(from);
    while (!open.empty()) {
      const Corner c = open.back();
      open.pop_back();
      if (group_[c] != kNone || !joins(triangles_[c / 3], c, same_side_[group])) continue;
      group_[c] = group;
      push_neighbours(c);
    }
  }

  /// A triangle without a winding takes that of the first group which reaches any of its corners.
  bool joins(Triangle& triangle, Corner c, bool same_side) const {
    const Corner first = c - c % 3;
    const bool alone = group_[first] == kNone && group_[first + 1] == kNone && group_[first + 2] == kNone;
    if (triangle.any && alone) triangle.same_side = same_side;
    return triangle.same_side == same_side;
  }

  /// What a corner adds to its group: the direction in the plane of the normal, as long as the angle there.
  [[nodiscard]] glm::dvec3 share(Corner c) const {
    const glm::dvec3 n = normal(c), at = position(c);
    const glm::dvec3 back = in_plane(position(previous(c)) - at, n), on = in_plane(position(next(c)) - at, n);
    return angle_of(glm::dot(back, on)) * in_plane(triangles_[c / 3].along, n);
  }

  std::vector<glm::vec4> tangents() {
    std::vector<glm::vec4> result(corners_);
    for (std::uint32_t v = 0; v + 1 < begin_.size(); ++v) sum_around(v, result);
    for (Corner c = 0; c < corners_; ++c) {
      const std::uint32_t v = vertices_[c];
      if (triangles_[c / 3].whole) continue;
      result[c] = begin_[v] < begin_[v + 1] ? result[sorted_[begin_[v]]] : without_coordinates(normal(c));
    }
    return result;
  }

  /// The shares of a group in the order of their values, so that the triangles' order is of no account.
  void sum_around(std::uint32_t v, std::vector<glm::vec4>& result) {
    shares_.clear();
    for (std::uint32_t i = begin_[v]; i < begin_[v + 1]; ++i) {
      const Corner c = sorted_[i];
      const glm::dvec3 s = triangles_[c / 3].any ? glm::dvec3(0) : share(c);
      shares_.push_back({group_[c], {s.x, s.y, s.z}, c});
    }
    std::sort(shares_.begin(), shares_.end());
    for (std::size_t begin = 0, end = 0; begin < shares_.size(); begin = end) {
      glm::dvec3 sum(0);
      for (; end < shares_.size() && shares_[end].group == shares_[begin].group; ++end)
        sum += glm::dvec3(shares_[end].value[0], shares_[end].value[1], shares_[end].value[2]);
      const glm::vec4 tangent = tangent_of(shares_[begin].group, unit(sum), shares_[begin].corner);
      for (std::size_t i = begin; i < end; ++i) result[shares_[i].corner] = tangent;
    }
  }

  [[nodiscard]] glm::vec4 tangent_of(std::uint32_t group, const glm::dvec3& direction, Corner c) const {
    glm::vec4 tangent = direction == glm::dvec3(0) ? without_coordinates(normal(c))
                                                   : glm::vec4(glm::vec3(direction) + 0.0F, 1);
    if (group != kNone) tangent.w = same_side_[group] ? -1.0F : 1.0F;
    return tangent;
  }

  struct Share {
    std::uint32_t group = kNone;
    std::array<double, 3> value{};
    Corner corner = 0;
    bool operator<(const Share& other) const {
      return std::tie(group, value, corner) < std::tie(other.group, other.value, other.corner);
    }
  };

  const TangentMesh& mesh_;
  std::size_t corners_;
  std::vector<std::uint32_t> vertices_;  ///< by corner, welded
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> begin_;  ///< by vertex: where its corners begin in `sorted_`
  std::vector<Corner> sorted_;
  std::vector<Corner> twin_;          ///< by corner: the edge on the other side of that which leaves it
  std::vector<std::uint32_t> group_;  ///< by corner
  std::vector<bool> same_side_;       ///< by group
  std::vector<Corner> open_;
  std::vector<Share> shares_;
};

}  // namespace

std::vector<glm::vec4> tangents_of(const TangentMesh& mesh) {
  QUADRILLE_CHECK(mesh.corners.size() < kNone, "corners have numbers of 32 bits");
  return TangentSpace(mesh).run();
}

}  // namespace quadrille::scenes
