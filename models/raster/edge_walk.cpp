#include "models/raster/edge_walk.h"

#include <algorithm>

namespace quadrille::models {
namespace {

/// number = quotient * divisor + remainder, 0 <= remainder < divisor.
struct Division {
  std::int64_t quotient, remainder;
  Division(std::int64_t number, std::int64_t divisor)
      : quotient(number / divisor), remainder(number % divisor) {
    if (remainder >= 0) return;
    --quotient;
    remainder += divisor;
  }
};

/// First row of which a sample `sample_y` below the centre is not above a height, within `low` and `high`.
std::int32_t first_row_from(std::int64_t height, std::int64_t sample_y, int bits, std::int32_t low,
                            std::int32_t high) {
  const std::int64_t one = std::int64_t{1} << bits;
  const std::int64_t row = (height - sample_y - one / 2 + one - 1) >> bits;
  return static_cast<std::int32_t>(std::clamp<std::int64_t>(row, low, high));
}

}  // namespace

void SampleRowWalk::Side::shorten(std::int32_t& first, std::int32_t& end) const {
  if (count == 0) return;
  std::int32_t top = edges[0].first, bottom = edges[0].end;
  for (std::size_t i = 1; i < count; ++i) {
    top = std::min(top, edges[i].first);
    bottom = std::max(bottom, edges[i].end);
  }
  first = std::max(first, top);
  end = std::min(end, bottom);
}

/// The one place that divides; further rows add. [P: Bresenham 1965]
std::int32_t SampleRowWalk::Side::begin(std::int32_t y, std::int32_t end_row) {
  for (std::size_t i = 0; i < count; ++i) {
    const Edge& edge = edges[i];
    if (y < edge.first || y >= edge.end) continue;
    full = edge.slope;
    const Division at_row(edge.at_zero + edge.per_row * y, full), a_row(edge.per_row, full);
    limit = at_row.quotient;
    remainder = at_row.remainder;
    step = a_row.quotient;
    step_remainder = a_row.remainder;
    return std::min(edge.end, end_row);
  }
  return end_row;
}

SampleRowWalk::SampleRowWalk(const TriangleSetup& triangle, const GridPoint& offset, int subpixel_bits)
    : bounds_(triangle.bounds), first_(bounds_.y0), end_(bounds_.y1) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(triangle.edge_count); ++i) {
    const EdgeFunction edge = at_sample(triangle.edges[i], offset, subpixel_bits);
    if (edge.a == 0) add_level(edge);
    else add_edge(edge, offset.y, subpixel_bits);
  }
  left_.shorten(first_, end_);
  right_.shorten(first_, end_);
}

/// A sample is inside while at_zero + per_row * y >= slope * -x on the left, and >= slope * x on the right.
void SampleRowWalk::add_edge(const EdgeFunction& edge, std::int64_t sample_y, int subpixel_bits) {
  const auto row_of = [&](std::int64_t height) {
    return first_row_from(height, sample_y, subpixel_bits, bounds_.y0, bounds_.y1);
  };
  Side& side = edge.a > 0 ? left_ : right_;
  side.add({edge.origin, edge.a > 0 ? edge.a : -edge.a, edge.b, row_of(edge.top), row_of(edge.bottom)});
}

/// A level edge has no place in a row: it is above rows, or below them.
void SampleRowWalk::add_level(const EdgeFunction& edge) {
  const auto row = [&](std::int64_t y) {
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(y, bounds_.y0, bounds_.y1));
  };
  if (edge.b > 0) first_ = std::max(first_, row(-Division(edge.origin, edge.b).quotient));
  else end_ = std::min(end_, row(Division(edge.origin, -edge.b).quotient + 1));
}

SampleRow SampleRowWalk::row(std::int32_t y) {
  SampleRow row{y, 0, bounds_.x0, bounds_.x1, !begun_ || y == part_end_};
  if (row.begins_part) {
    begun_ = true;
    part_end_ = std::min(left_.begin(y, end_), right_.begin(y, end_));
  } else {
    left_.advance();
    right_.advance();
  }
  if (left_.count > 0)
    row.x0 = static_cast<std::int32_t>(std::clamp<std::int64_t>(-left_.limit, bounds_.x0, bounds_.x1));
  if (right_.count > 0)
    row.x1 = static_cast<std::int32_t>(std::clamp<std::int64_t>(right_.limit + 1, bounds_.x0, bounds_.x1));
  return row;
}

EdgeWalk::EdgeWalk(const TriangleSetup& triangle, const SampleGrid& samples)
    : count_(triangle.whole_pixels ? 1 : samples.count), y_(triangle.bounds.y1), end_(triangle.bounds.y0) {
  for (std::size_t s = 0; s < static_cast<std::size_t>(count_); ++s) {
    const GridPoint offset = triangle.whole_pixels ? GridPoint{} : samples.offset[s];
    walks_[s] = SampleRowWalk(triangle, offset, samples.subpixel_bits);
    if (walks_[s].first_row() >= walks_[s].end_row()) continue;
    y_ = std::min(y_, walks_[s].first_row());
    end_ = std::max(end_, walks_[s].end_row());
  }
}

bool EdgeWalk::next(SampleRow& row) {
  for (; y_ < end_; ++y_, sample_ = 0) {
    while (sample_ < count_) {
      const int sample = sample_++;
      SampleRowWalk& walk = walks_[static_cast<std::size_t>(sample)];
      if (y_ < walk.first_row() || y_ >= walk.end_row()) continue;
      row = walk.row(y_);
      row.sample = sample;
      return true;
    }
  }
  return false;
}

}  // namespace quadrille::models
