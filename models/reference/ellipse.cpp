#include "models/reference/ellipse.h"

#include <algorithm>
#include <cmath>

namespace quadrille::models::reference {
namespace {

constexpr double kWidest = 2.0;          // texels of the level; a wider ellipse belongs to a coarser one
constexpr double kEdge = 1024.0 / 1023;  // the last of 1023 steps of the weight is as long as the others

}  // namespace

EllipseAxes ellipse_axes(const Change& along_x, const Change& along_y) {
  const double xx = along_x[0] * along_x[0] + along_x[1] * along_x[1],
               yy = along_y[0] * along_y[0] + along_y[1] * along_y[1],
               xy = along_x[0] * along_y[0] + along_x[1] * along_y[1];
  // The changes along two directions of the screen at right angles, which are at right angles on the texture.
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy), cosine = std::cos(angle), sine = std::sin(angle);
  const Change axis{cosine * along_x[0] + sine * along_y[0], cosine * along_x[1] + sine * along_y[1]};
  EllipseAxes axes;
  axes.longer = std::hypot(axis[0], axis[1]);
  if (axes.longer == 0) return axes;
  axes.direction = {axis[0] / axes.longer, axis[1] / axes.longer};
  axes.shorter = std::abs(along_x[0] * along_y[1] - along_x[1] * along_y[0]) / axes.longer;
  return axes;
}

EllipseAxes filtered_ellipse(EllipseAxes axes, double most) {
  const double wide = std::max(axes.shorter, axes.longer / most);
  const double scale = wide > kWidest ? kWidest / wide : 1.0;
  axes.longer = std::hypot(axes.longer * scale, 1.0);
  axes.shorter = std::max(std::hypot(axes.shorter * scale, 1.0), axes.longer / most);
  return axes;
}

double ellipse_weight(const EllipseAxes& axes, double u, double v) {
  const double along = (u * axes.direction[0] + v * axes.direction[1]) / axes.longer,
               across = (v * axes.direction[0] - u * axes.direction[1]) / axes.shorter;
  const double r2 = along * along + across * across;
  return r2 < kEdge ? std::exp(-2 * r2) : 0.0;
}

}  // namespace quadrille::models::reference
