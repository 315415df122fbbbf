#include "models/raster/coarse.h"

#include <algorithm>
#include <cstdint>

namespace quadrille::models {
namespace {

constexpr std::int64_t floor_div(std::int64_t a, std::int64_t positive) {
  return a >= 0 ? a / positive : -((-a + positive - 1) / positive);
}

/// What the best and the worst sample of a pixel add to its centre.
void add_samples(const EdgeFunction& edge, const SampleGrid& samples, std::int64_t& best,
                 std::int64_t& worst) {
  std::int64_t most = INT64_MIN, least = INT64_MAX;
  for (int s = 0; s < samples.count; ++s) {
    const std::int64_t more =
        at_sample(edge, samples.offset[static_cast<std::size_t>(s)], samples.subpixel_bits).origin -
        edge.origin;
    most = std::max(most, more);
    least = std::min(least, more);
  }
  best += most;
  worst += least;
}

}  // namespace

TileWalk::TileWalk(const TriangleSetup& triangle, const SampleGrid& samples)
    : edge_count_(static_cast<std::size_t>(triangle.edge_count)) {
  for (std::size_t i = 0; i < edge_count_; ++i) {
    const EdgeFunction& e = triangle.edges[i];
    edges_[i] = {e.origin, e.a * kTileSize, e.b * kTileSize};
    best_[i] = (kTileSize - 1) * (std::max<std::int64_t>(e.a, 0) + std::max<std::int64_t>(e.b, 0));
    worst_[i] = (kTileSize - 1) * (std::min<std::int64_t>(e.a, 0) + std::min<std::int64_t>(e.b, 0));
    if (samples.count > 1 && !triangle.whole_pixels) add_samples(e, samples, best_[i], worst_[i]);
  }
  const PixelRect& r = triangle.bounds;
  if (r.empty()) return;
  first_x_ = r.x0 >> 3;
  last_x_ = (r.x1 - 1) >> 3;
  last_y_ = (r.y1 - 1) >> 3;
  full_x0_ = (r.x0 + 7) >> 3;
  full_x1_ = r.x1 >> 3;
  full_y0_ = (r.y0 + 7) >> 3;
  full_y1_ = r.y1 >> 3;
  y_ = (r.y0 >> 3);
  enter_row();
}

void TileWalk::enter_row() {
  std::int64_t low = first_x_, high = last_x_;
  for (std::size_t i = 0; i < edge_count_; ++i) {
    const EdgeFunction& e = edges_[i];
    const std::int64_t at_zero = e.at(0, y_) + best_[i];  // best value of tile x is at_zero + a * x
    if (e.a == 0) {
      if (at_zero < 0) high = low - 1;
    } else if (low == high) {
      if (at_zero + e.a * low < 0) high = low - 1;
    } else if (e.a > 0) {
      low = std::max(low, -floor_div(at_zero, e.a));  // ceil(-at_zero / a)
    } else {
      high = std::min(high, floor_div(at_zero, -e.a));
    }
    if (low > high) break;
  }
  if (low > high) {
    x_ = 0;
    row_last_x_ = -1;
    ++tests_;
    return;
  }
  x_ = static_cast<std::int32_t>(low);
  row_last_x_ = static_cast<std::int32_t>(high);
  tests_ += (x_ > first_x_ ? 1u : 0u) + (row_last_x_ < last_x_ ? 1u : 0u);
}

bool TileWalk::next(TileHit& hit) {
  while (x_ > row_last_x_) {
    if (y_ >= last_y_) return false;
    ++y_;
    enter_row();
  }
  ++tests_;
  hit.tile_x = x_++;
  hit.tile_y = y_;
  hit.fully_covered =
      hit.tile_x >= full_x0_ && hit.tile_x < full_x1_ && hit.tile_y >= full_y0_ && hit.tile_y < full_y1_;
  for (std::size_t i = 0; i < edge_count_ && hit.fully_covered; ++i) {
    hit.fully_covered = edges_[i].at(hit.tile_x, hit.tile_y) + worst_[i] >= 0;
  }
  return true;
}

}  // namespace quadrille::models
