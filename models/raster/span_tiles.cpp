#include "models/raster/span_tiles.h"

#include "models/raster/fine.h"

#include <algorithm>
#include <span>

namespace quadrille::models {

SpanTiles::SpanTiles(const PixelRect& bounds, int samples, bool whole_pixels)
    : left_(bounds.x0 >> 3), samples_(static_cast<std::size_t>(samples)), whole_pixels_(whole_pixels) {
  if (!bounds.empty()) tiles_.resize(static_cast<std::size_t>(((bounds.x1 - 1) >> 3) - left_ + 1));
}

void SpanTiles::add(const SampleRow& span) {
  if (span.empty()) return;
  tile_y_ = span.y >> 3;
  const std::int32_t from = span.x0 >> 3, to = (span.x1 - 1) >> 3;
  first_ = std::min(first_, from);
  last_ = std::max(last_, to);
  for (std::int32_t x = from; x <= to; ++x)
    tiles_[static_cast<std::size_t>(x - left_)][static_cast<std::size_t>(span.sample)] |=
        rect_coverage({span.x0, span.y, span.x1, span.y + 1}, x, tile_y_);
}

bool SpanTiles::take(Tile& tile) {
  for (; first_ <= last_; ++first_) {
    TileCoverage& held = tiles_[static_cast<std::size_t>(first_ - left_)];
    if (whole_pixels_) held.fill(held[0]);
    const auto samples = std::span(held).first(samples_);
    if (std::ranges::all_of(samples, [](std::uint64_t mask) { return mask == 0; })) continue;
    tile.tile_x = first_++;
    tile.tile_y = tile_y_;
    tile.full = std::ranges::all_of(samples, [](std::uint64_t mask) { return ~mask == 0; });
    tile.coverage = held;
    held.fill(0);
    return true;
  }
  first_ = INT32_MAX;
  last_ = -1;
  return false;
}

}  // namespace quadrille::models
