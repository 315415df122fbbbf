/// How each kind of mesh is drawn by lot, and how it is laid over the window.
#include "tests/models/raster/coverage_meshes.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace quadrille::models {
namespace {

using Place = glm::dvec2;

double between(RandomSource& random, double low, double high) {
  return low + (high - low) * std::ldexp(static_cast<double>(random.bits()), -32);
}

/// Positions in pixels from an origin of the mesh's own, before the mesh is laid over the window.
struct Shape {
  std::vector<Place> at;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A centre, and a ring of corners around it in order of their directions.
Shape fan(RandomSource& random, double across) {
  const auto corners = static_cast<std::size_t>(random.integer(4, 40));
  std::vector<double> directions(corners);
  // One in each equal part of the circle, so that no two are half a circle apart.
  for (std::size_t i = 0; i < corners; ++i)
    directions[i] = (static_cast<double>(i) + between(random, 0, 0.99)) / static_cast<double>(corners);
  Shape shape;
  shape.at.emplace_back(0, 0);
  for (const double part : directions) {
    const double angle = 2 * std::numbers::pi * part, radius = across * between(random, 0.1, 0.5);
    shape.at.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  const auto ring = static_cast<std::uint32_t>(corners);
  for (std::uint32_t i = 0; i < ring; ++i) shape.triangles.push_back({0, 1 + i, 1 + (i + 1) % ring});
  return shape;
}

/// Two rows of corners, `thick` apart or less, with triangles to and fro between them.
Shape strip(RandomSource& random, double across, double thick) {
  const int columns = random.integer(2, 20);
  const double step = across / columns;
  Shape shape;
  for (int i = 0; i <= columns; ++i) {
    const double x = step * (i + between(random, -0.4, 0.4));
    shape.at.emplace_back(x, -thick * between(random, 0.1, 0.5));
    shape.at.emplace_back(step * (i + between(random, -0.4, 0.4)), thick * between(random, 0.1, 0.5));
  }
  for (std::uint32_t i = 0; i + 2 < shape.at.size(); ++i) {
    if (i % 2 == 0) shape.triangles.push_back({i, i + 2, i + 1});
    else shape.triangles.push_back({i, i + 1, i + 2});
  }
  return shape;
}

/// Cells whose corners are moved a little, each cut along one of its diagonals.
Shape grid(RandomSource& random, double across) {
  const auto cells = static_cast<std::uint32_t>(random.integer(1, 5));
  Shape shape;
  for (std::uint32_t y = 0; y <= cells; ++y)
    for (std::uint32_t x = 0; x <= cells; ++x)
      shape.at.emplace_back(across / cells * (x + between(random, -0.2, 0.2)),
                            across / cells * (y + between(random, -0.2, 0.2)));
  for (std::uint32_t y = 0; y < cells; ++y)
    for (std::uint32_t x = 0; x < cells; ++x) {
      const std::uint32_t a = y * (cells + 1) + x, b = a + 1, c = a + cells + 1, d = c + 1;
      const bool falls = random.integer(0, 1) != 0;
      shape.triangles.push_back({a, b, falls ? d : c});
      shape.triangles.push_back(falls ? std::array{a, d, c} : std::array{b, d, c});
    }
  return shape;
}

/// A far corner, and corners on a line that lie `thick` apart.
Shape sliver_fan(RandomSource& random, double across, double thick) {
  const int corners = random.integer(4, 40);
  Shape shape;
  shape.at.emplace_back(across, across * between(random, -0.5, 0.5));
  double y = 0;
  for (int i = 0; i < corners; ++i, y -= thick * between(random, 0.5, 1)) shape.at.emplace_back(0, y);
  for (std::uint32_t i = 1; i + 1 < shape.at.size(); ++i) shape.triangles.push_back({0, i, i + 1});
  return shape;
}

Shape shape_of(RandomSource& random, MeshKind kind, double across) {
  const double thick = std::exp2(random.integer(-16, 0));
  switch (kind) {
    case MeshKind::kFan: return fan(random, across);
    case MeshKind::kStrip: return strip(random, across, across * between(random, 0.05, 0.5));
    case MeshKind::kGrid: return grid(random, across * std::numbers::sqrt2 / 2);
    case MeshKind::kSliverFan: return sliver_fan(random, across, thick);
    case MeshKind::kSliverStrip: return strip(random, across, thick);
  }
  return {};
}

/// Turns by a random angle; a third of the meshes stay level, with horizontal and vertical edges.
void turn(RandomSource& random, Shape& shape) {
  const double angle = random.integer(0, 2) == 0 ? 0 : between(random, 0, 2 * std::numbers::pi);
  const double c = std::cos(angle), s = std::sin(angle);
  for (Place& p : shape.at) p = {c * p.x - s * p.y, s * p.x + c * p.y};
}

/// A corner, or a point on an edge or inside of a triangle.
Place point_of(RandomSource& random, const Shape& shape) {
  const auto last = static_cast<std::int32_t>(shape.triangles.size()) - 1;
  const auto& t = shape.triangles[static_cast<std::size_t>(random.integer(0, last))];
  const int corners = random.integer(1, 3);
  double first = corners == 1 ? 1 : between(random, 0, 1), second = corners == 2 ? 1 - first : 0;
  if (corners == 3) second = between(random, 0, 1 - first);
  return first * shape.at[t[0]] + second * shape.at[t[1]] + (1 - first - second) * shape.at[t[2]];
}

/// A random sample of the window, in pixels.
Place sample_near(RandomSource& random, const CoverageWindow& window, const Place& pixel) {
  const OraclePoint sample = oracle_sample(window, random.integer(0, window.samples - 1));
  return glm::floor(pixel) + Place(std::ldexp(static_cast<double>(sample.x), -window.subpixel_bits),
                                   std::ldexp(static_cast<double>(sample.y), -window.subpixel_bits));
}

}  // namespace

CoverageWindow random_window(RandomSource& random) {
  CoverageWindow window;
  const std::int32_t last = random.integer(0, 1) == 0 ? 128 : 16384 - CoverageWindow::kSize;
  window.x0 = random.integer(0, last);
  window.y0 = random.integer(0, last);
  window.subpixel_bits = random.integer(4, 12);
  window.samples = 1 << random.integer(0, 3);
  return window;
}

CoverageMesh random_mesh(RandomSource& random, const CoverageWindow& window) {
  CoverageMesh mesh;
  mesh.kind = static_cast<MeshKind>(random.integer(0, static_cast<int>(kMeshKindNames.size()) - 1));
  Shape shape = shape_of(random, mesh.kind, std::pow(10.0, between(random, -3, 5)));
  turn(random, shape);
  const Place corner(window.x0, window.y0);
  Place anchor =
      corner + Place(between(random, 0, CoverageWindow::kSize), between(random, 0, CoverageWindow::kSize));
  if (random.integer(0, 1) == 0) anchor = sample_near(random, window, anchor);
  const Place moved = anchor - point_of(random, shape);
  const bool onto_samples = random.integer(0, 2) == 0;
  for (Place& p : shape.at) {
    p += moved;
    if (onto_samples && random.integer(0, 1) == 0) p = sample_near(random, window, p);
    mesh.at.emplace_back(p);
  }
  mesh.triangles = std::move(shape.triangles);
  return mesh;
}

}  // namespace quadrille::models
