/// The painter's algorithm: every primitive of the frame from back to front, without a depth buffer. [P:
/// Newell 1972]
///
/// Centres are sorted by their distance along the view direction. That is right where no two triangles
/// overlap in depth in the wrong way, as on a convex object, and wrong where they do: a cycle has no order.
/// What follows each other of one draw is drawn by one command.
#include <algorithm>
#include <cstring>

#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>

#include "models/base/error.h"
#include "scenes/record/depth_range.h"
#include "scenes/record/host_pose.h"
#include "scenes/record/recorder.h"
#include "traces/trace_file.h"

namespace quadrille::scenes {
namespace {

constexpr std::size_t kMaxPieces = std::size_t{1} << 26;  // 1 GiB of them

glm::dvec4 place_of(const Array& positions, std::uint32_t vertex) {
  const auto v = values_at(positions, vertex);
  return {v[0], v[1], v[2], 1};
}

}  // namespace

const Corners& Recorder::corners(std::uint32_t primitive) {
  const auto [entry, added] = corners_.try_emplace(primitive);
  if (added) entry->second = corners_of(scene_, scene_.primitives[primitive]);
  return entry->second;
}

const Array& Recorder::host_positions(const Instance& instance) {
  const Primitive& primitive = scene_.primitives[instance.primitive];
  const Array& still = scene_.arrays[static_cast<std::size_t>(primitive.attributes[0])];
  if (instance.pose < 0) return still;
  const auto [entry, added] = host_positions_.try_emplace({instance.primitive, instance.pose});
  if (added) {
    const Pose& pose = scene_.poses[static_cast<std::size_t>(instance.pose)];
    auto posed = pose_on_host(scene_, primitive, pose, !pose.joints.empty());
    if (posed[0]) entry->second = std::move(*posed[0]);
    else entry->second = still;
  }
  return entry->second;
}

DepthRange Recorder::find_depth_range() {
  DepthRangeFinder finder;
  for (const Instance& instance : placed_.at.instances) {
    if (scene_.primitives[instance.primitive].attributes[0] < 0) continue;
    const Corners& c = corners(instance.primitive);
    const Array& positions = host_positions(instance);
    for_each_copy(instance, [&](const glm::mat4& world) {
      const glm::dmat4 to_clip = glm::dmat4(view_.view_projection) * glm::dmat4(world);
      for (std::size_t first = 0; first < c.vertices.size(); first += c.per_piece) {
        DepthRangeFinder::Triangle triangle;
        for (std::size_t i = 0; i < 3; ++i)
          triangle[i] = to_clip * place_of(positions, c.vertices[first + std::min(i, c.per_piece - 1)]);
        finder.add(triangle);
      }
    });
  }
  return finder.range().value_or(DepthRange{});
}

std::vector<Recorder::Canvas> Recorder::canvases() {
  std::vector<Canvas> all;
  for (const Instance& instance : placed_.at.instances) {
    if (scene_.primitives[instance.primitive].attributes[0] < 0) continue;
    Geometry g = geometry(instance);
    g.listed = true;
    const auto shared = std::make_shared<const States>(states(instance, std::move(g)));
    for_each_copy(instance, [&](const glm::mat4& world) {
      all.push_back({&instance, world, &corners(instance.primitive), &host_positions(instance), shared});
    });
  }
  return all;
}

std::vector<Recorder::Piece> Recorder::pieces_from_back(const std::vector<Canvas>& canvases) const {
  std::size_t count = 0;
  for (const Canvas& canvas : canvases) count += canvas.corners->pieces();
  if (count > kMaxPieces)
    throw user_error(
        "{}: {} points, lines and triangles to sort; at most {} are drawn in the painter's order",
        scene_.name, count, kMaxPieces);
  std::vector<Piece> pieces;
  pieces.reserve(count);
  const glm::dvec3 eye(view_.eye), toward(view_.toward_viewer);
  for (std::size_t k = 0; k < canvases.size(); ++k) {
    const Canvas& canvas = canvases[k];
    const glm::dmat4 world(canvas.world);
    const std::size_t per = canvas.corners->per_piece;
    for (std::size_t first = 0; first < canvas.corners->vertices.size(); first += per) {
      glm::dvec4 sum(0);
      for (std::size_t i = 0; i < per; ++i)
        sum += place_of(*canvas.positions, canvas.corners->vertices[first + i]);
      const glm::dvec3 center(world * (sum / static_cast<double>(per)));
      pieces.push_back(
          {glm::dot(eye - center, toward), static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(first)});
    }
  }
  std::ranges::stable_sort(pieces, std::ranges::greater{}, &Piece::distance);
  return pieces;
}

void Recorder::record_as_painter() {
  painter_indices_ = static_cast<traces::Index>(stream_.buffers.size());
  stream_.buffers.push_back({"painter's order", {}});
  const std::vector<Canvas> all = canvases();
  std::vector<std::uint32_t> indices;
  const std::vector<Piece> pieces = pieces_from_back(all);
  for (std::size_t i = 0; i < pieces.size();) {
    const Canvas& canvas = all[pieces[i].canvas];
    const auto first = static_cast<std::uint32_t>(indices.size());
    std::size_t end = i;
    for (; end < pieces.size() && pieces[end].canvas == pieces[i].canvas; ++end) {
      const auto corner = canvas.corners->vertices.begin() + pieces[end].first_corner;
      indices.insert(indices.end(), corner, corner + static_cast<std::ptrdiff_t>(canvas.corners->per_piece));
    }
    record_run(canvas, first, static_cast<std::uint32_t>(indices.size()) - first);
    i = end;
  }
  std::vector<std::byte>& data = stream_.buffers[painter_indices_].data;
  data.resize(indices.size() * sizeof(std::uint32_t));
  if (!indices.empty()) std::memcpy(data.data(), indices.data(), data.size());
}

void Recorder::record_run(const Canvas& canvas, std::uint32_t first, std::uint32_t count) {
  bind(scene_.primitives[canvas.instance->primitive], *canvas.states);
  push_constants(canvas.world, canvas.states->geometry.mirrored);
  stream_.commands.emplace_back(traces::Draw{true, count, first, 0, 1, 0, canvas.instance->label});
  ++draws_;
  triangles_ += count / static_cast<std::uint32_t>(canvas.corners->per_piece);
}

}  // namespace quadrille::scenes
