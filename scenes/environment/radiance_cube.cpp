#include "scenes/environment/radiance_cube.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/common.hpp>

namespace quadrille::scenes {

glm::dvec3 face_direction(int face, double right, double down) {
  switch (face) {
    case 0: return {1, -down, -right};
    case 1: return {-1, -down, right};
    case 2: return {right, 1, down};
    case 3: return {right, -1, -down};
    case 4: return {right, -down, 1};
    default: return {-right, -down, -1};
  }
}

FacePlace place_on_face(const glm::dvec3& d) {
  const glm::dvec3 a = glm::abs(d);
  if (a.z >= a.x && a.z >= a.y)
    return d.z >= 0 ? FacePlace{4, d.x / a.z, -d.y / a.z} : FacePlace{5, -d.x / a.z, -d.y / a.z};
  if (a.y >= a.x) return d.y >= 0 ? FacePlace{2, d.x / a.y, d.z / a.y} : FacePlace{3, d.x / a.y, -d.z / a.y};
  return d.x >= 0 ? FacePlace{0, -d.z / a.x, -d.y / a.x} : FacePlace{1, d.z / a.x, -d.y / a.x};
}

glm::dvec3 RadianceCube::texel(int face, int column, int row) const {
  const int last = static_cast<int>(size) - 1;
  if (column < 0 || row < 0 || column > last || row > last) {
    const auto middle_of = [&](int i) { return (2.0 * i + 1) / size - 1; };
    const FacePlace other = place_on_face(face_direction(face, middle_of(column), middle_of(row)));
    face = other.face;
    column = std::clamp(static_cast<int>(std::floor((other.right + 1) * 0.5 * size)), 0, last);
    row = std::clamp(static_cast<int>(std::floor((other.down + 1) * 0.5 * size)), 0, last);
  }
  return glm::dvec3(at(face, static_cast<std::uint32_t>(column), static_cast<std::uint32_t>(row)));
}

glm::dvec3 RadianceCube::sample(const glm::dvec3& direction) const {
  const FacePlace place = place_on_face(direction);
  const double x = (place.right + 1) * 0.5 * size - 0.5, y = (place.down + 1) * 0.5 * size - 0.5;
  const double left = std::floor(x), top = std::floor(y);
  const int i = static_cast<int>(left), j = static_cast<int>(top);
  const double fx = x - left, fy = y - top;
  return glm::mix(glm::mix(texel(place.face, i, j), texel(place.face, i + 1, j), fx),
                  glm::mix(texel(place.face, i, j + 1), texel(place.face, i + 1, j + 1), fx), fy);
}

double RadianceCube::weight(std::uint32_t column, std::uint32_t row) const {
  const double x = middle(column), y = middle(row), square = 1 + x * x + y * y;
  return 1 / (square * std::sqrt(square));
}

CubeChain::CubeChain(RadianceCube finest) {
  levels_.push_back(std::move(finest));
  while (levels_.back().size > 1) {
    const RadianceCube& from = levels_.back();
    RadianceCube to(from.size / 2);
    for (int face = 0; face < 6; ++face) {
      for (std::uint32_t row = 0; row < to.size; ++row) {
        for (std::uint32_t column = 0; column < to.size; ++column)
          to.at(face, column, row) =
              0.25F * ((from.at(face, 2 * column, 2 * row) + from.at(face, 2 * column + 1, 2 * row)) +
                       (from.at(face, 2 * column, 2 * row + 1) + from.at(face, 2 * column + 1, 2 * row + 1)));
      }
    }
    levels_.push_back(std::move(to));
  }
}

glm::dvec3 CubeChain::sample(const glm::dvec3& direction, double level) const {
  const double last = static_cast<double>(levels_.size() - 1), held = std::clamp(level, 0.0, last);
  const auto finer = static_cast<std::size_t>(held);
  const glm::dvec3 fine = levels_[finer].sample(direction);
  const double between = held - static_cast<double>(finer);
  return between > 0 ? glm::mix(fine, levels_[finer + 1].sample(direction), between) : fine;
}

}  // namespace quadrille::scenes
