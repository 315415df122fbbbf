#include "studies/experiments/measured_meshes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace quadrille::studies::experiments {
namespace {

constexpr double kFragments = 1 << 17;   ///< of all triangles of a frame, about
constexpr int kMostTriangles = 1 << 15;  ///< of a frame
constexpr float kLayerDistance = 0.05F;

/// Fractions that are the same on every host.
class Draws {
 public:
  double next() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state_ >> 40) / (1 << 24);
  }

 private:
  std::uint64_t state_ = 1;
};

}  // namespace

TriangleMesh same_triangle(std::uint32_t width, std::uint32_t height, std::uint32_t times) {
  // The centres of the two neighbouring pixels lie on the long edge, which is neither a top nor a left one.
  TriangleMesh mesh{width, height, {{0, 0}, {2 * kGrid, 0}, {0, 2 * kGrid}}, {}};
  mesh.triangles.assign(times, {0, 1, 2});
  return mesh;
}

TriangleMesh repeated(TriangleMesh mesh, std::uint32_t times) {
  const std::vector<std::array<std::uint32_t, 3>> once = mesh.triangles;
  for (std::uint32_t i = 1; i < times; ++i)
    mesh.triangles.insert(mesh.triangles.end(), once.begin(), once.end());
  return mesh;
}

TriangleMesh moved_right(TriangleMesh mesh, std::uint32_t pixels) {
  for (WindowCorner& c : mesh.corners) c.x += static_cast<std::int32_t>(pixels) * kGrid;
  return mesh;
}

TriangleMesh scattered(std::uint32_t width, std::uint32_t height, double area) {
  TriangleMesh mesh{width, height, {}, {}};
  Draws draws;
  const double radius = std::sqrt(4 * area / (3 * std::sqrt(3.0)));  // of the circle through its corners
  const int count = static_cast<int>(std::min<double>(kMostTriangles, kFragments / area));
  for (int i = 0; i < count; ++i) {
    const double turn = draws.next() * 2 * std::numbers::pi;
    const double x = radius + draws.next() * (width - 2 * radius),
                 y = radius + draws.next() * (height - 2 * radius);
    const auto first = static_cast<std::uint32_t>(mesh.corners.size());
    for (int c = 0; c < 3; ++c) {
      const double angle = turn + c * 2 * std::numbers::pi / 3;
      mesh.corners.push_back(
          {static_cast<std::int32_t>(std::lround(kGrid * (x + radius * std::cos(angle)))),
           static_cast<std::int32_t>(std::lround(kGrid * (y + radius * std::sin(angle))))});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

TriangleMesh layers(std::uint32_t width, std::uint32_t height, std::uint32_t count, bool front_first) {
  TriangleMesh mesh{width, height, {}, {}};
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t place = front_first ? i : count - 1 - i;
    mesh.rectangle(0, 0, static_cast<std::int32_t>(width), static_cast<std::int32_t>(height),
                   kLayerDistance * static_cast<float>(place + 1));
  }
  return mesh;
}

TriangleMesh through_near_plane(std::uint32_t width, std::uint32_t height, std::uint32_t behind) {
  const TriangleMesh shared = tiled_frame(width, height, 8, 8);
  TriangleMesh mesh{width, height, {}, {}};
  for (const auto& triangle : shared.triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.corners.size());
    for (std::uint32_t i = 0; i < 3; ++i) {
      const WindowCorner& corner = shared.corners[triangle[i]];
      mesh.corners.push_back({corner.x, corner.y, i < behind ? -0.5F : 0.5F});
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

}  // namespace quadrille::studies::experiments
