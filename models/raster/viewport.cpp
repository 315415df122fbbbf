#include "models/raster/viewport.h"

#include <cmath>

namespace quadrille::models {
namespace {

constexpr double kGridLimit = static_cast<double>(1 << kPositionBits);
constexpr float kDepthLimit = 1048576.0f;

/// Window coordinate on the sub-pixel grid; false when it is not finite or beyond the grid.
bool snap(float window, int subpixel_bits, std::int32_t& out) {
  const double scaled = static_cast<double>(window) * static_cast<double>(1 << subpixel_bits);
  if (!(std::abs(scaled) < kGridLimit - 1.0)) return false;
  out = static_cast<std::int32_t>(std::lrint(scaled));
  return true;
}

/// First pixel whose centre is at or after `edge`, limited to [0, size].
std::int32_t first_centre(double edge, std::uint32_t size) {
  return static_cast<std::int32_t>(std::clamp(std::ceil(edge - 0.5), 0.0, static_cast<double>(size)));
}

}  // namespace

bool to_window(const glm::vec4& clip, const Viewport& viewport, int subpixel_bits, WindowVertex& out) {
  if (!(clip.w > 0.0f)) return false;
  const float r = 1.0f / clip.w;
  const float half_width = viewport.width * 0.5f, half_height = viewport.height * 0.5f;
  const float x = std::fma(clip.x * r, half_width, viewport.x + half_width);
  const float y = std::fma(clip.y * r, half_height, viewport.y + half_height);
  const float z = std::fma(clip.z * r, viewport.max_depth - viewport.min_depth, viewport.min_depth);
  if (!std::isfinite(r) || std::isnan(z)) return false;
  out.z = std::clamp(z, -kDepthLimit, kDepthLimit);
  out.inv_w = r;
  return snap(x, subpixel_bits, out.x) && snap(y, subpixel_bits, out.y);
}

PixelRect drawable_rect(const Viewport& viewport, const PixelRect& scissor, std::uint32_t target_width,
                        std::uint32_t target_height) {
  const double x0 = viewport.x, x1 = x0 + static_cast<double>(viewport.width);
  const double y0 = viewport.y, y1 = y0 + static_cast<double>(viewport.height);
  if (!std::isfinite(x0 + x1 + y0 + y1)) return {};
  const PixelRect view{
      first_centre(std::min(x0, x1), target_width), first_centre(std::min(y0, y1), target_height),
      first_centre(std::max(x0, x1), target_width), first_centre(std::max(y0, y1), target_height)};
  return intersect(view, scissor);
}

}  // namespace quadrille::models
