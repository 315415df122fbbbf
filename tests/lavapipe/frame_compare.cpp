/// The criteria: ties first, then shape, then colour.
#include "tests/lavapipe/frame_compare.h"

#include <bit>
#include <cmath>

#include "models/base/error.h"

namespace quadrille::lavapipe {
namespace {

namespace reference = models::reference;

void require_same_size(const Rendered& a, const Rendered& b) {
  if (a.width != b.width || a.height != b.height)
    throw user_error("images of different size cannot be compared: {}x{} and {}x{}", a.width, a.height,
                     b.width, b.height);
}

/// Is the pixel a depth tie? Only where both show a triangle, and not the same.
bool is_depth_tie(const FramePair& a, const FramePair& b, std::size_t pixel) {
  const std::uint32_t id_a = a.triangles.color[pixel], id_b = b.triangles.color[pixel];
  if (id_a == id_b || id_a == 0 || id_b == 0 || a.triangles.depth.empty() || b.triangles.depth.empty())
    return false;
  return ulps_apart(a.triangles.depth[pixel], b.triangles.depth[pixel]) <= kTieUlps;
}

/// Maps floats to integers so that neighbours differ by one.
std::int64_t ordered(float value) {
  const auto bits = std::bit_cast<std::int32_t>(value);
  return bits >= 0 ? bits : -static_cast<std::int64_t>(bits & 0x7fffffff);
}

std::vector<std::uint64_t> triangle_ids(const Rendered& image) {
  return {image.color.begin(), image.color.end()};
}

reference::ImageView view(const Rendered& image) { return {image.width, image.height, image.color}; }

}  // namespace

std::uint32_t ulps_apart(float a, float b) {
  if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<std::uint32_t>::max();
  return static_cast<std::uint32_t>(std::abs(ordered(a) - ordered(b)));
}

std::vector<std::uint8_t> unexplained_pixels(const FramePair& a, const FramePair& b) {
  require_same_size(a.triangles, b.triangles);
  std::vector<std::uint8_t> marks(a.triangles.color.size());
  for (std::size_t i = 0; i < marks.size(); ++i)
    marks[i] = a.triangles.color[i] != b.triangles.color[i] && !is_depth_tie(a, b, i) ? 1 : 0;
  return marks;
}

Comparison compare_frames(const FramePair& ours, const FramePair& theirs,
                          std::span<const std::uint8_t> alpha_ties, const Limits& limits) {
  require_same_size(ours.color, theirs.color);
  require_same_size(ours.triangles, theirs.triangles);
  require_same_size(ours.color, ours.triangles);
  Comparison result;
  std::vector<std::uint8_t> excused(ours.color.color.size(), 0);
  const std::vector<std::uint8_t> unexplained = unexplained_pixels(ours, theirs);
  for (std::size_t i = 0; i < excused.size(); ++i) {
    const bool depth_tie = is_depth_tie(ours, theirs, i);
    const bool alpha_tie = unexplained[i] != 0 && !alpha_ties.empty() && alpha_ties[i] != 0;
    result.depth_ties += depth_tie ? 1 : 0;
    result.alpha_ties += alpha_tie ? 1 : 0;
    excused[i] = depth_tie || alpha_tie ? 1 : 0;
  }
  result.shape =
      reference::compare_triangles(triangle_ids(ours.triangles), triangle_ids(theirs.triangles), 0, excused);
  result.color = reference::compare_images(view(ours.color), view(theirs.color), excused);
  result.coverage_ok = result.shape.coverage_fraction() <= limits.coverage_fraction;
  result.triangles_ok = result.shape.triangle_fraction() <= limits.triangle_fraction;
  result.color_ok = result.color.fraction_within(limits.within_lsb) >= limits.within_fraction;
  result.blocks_ok = result.color.bad_blocks <= limits.bad_blocks;
  return result;
}

}  // namespace quadrille::lavapipe
