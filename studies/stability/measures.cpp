#include "studies/stability/measures.h"

#include <algorithm>
#include <cstdlib>

namespace quadrille::studies::stability {

namespace ref = models::reference;

namespace {

bool is_inner(const ref::Result& r, std::uint32_t x, std::uint32_t y) {
  if (x == 0 || y == 0 || x + 1 >= r.width || y + 1 >= r.height) return false;
  const std::uint64_t id = r.triangle_id[std::size_t{y} * r.width + x];
  for (std::uint32_t v = y - 1; v <= y + 1; ++v) {
    for (std::uint32_t u = x - 1; u <= x + 1; ++u) {
      if (r.triangle_id[std::size_t{v} * r.width + u] != id) return false;
    }
  }
  return true;
}

int channel_distance(std::uint32_t a, std::uint32_t b) {
  int worst = 0;
  for (int c = 0; c < 32; c += 8)
    worst =
        std::max(worst, std::abs(static_cast<int>((a >> c) & 0xffu) - static_cast<int>((b >> c) & 0xffu)));
  return worst;
}

}  // namespace

std::map<std::uint32_t, std::uint64_t> coverage_counts(const Observed& o) {
  std::map<std::uint32_t, std::uint64_t> counts;
  const DrawnArea area = drawn_area(o.stream);
  for (std::uint32_t y = area.top; y < area.bottom; ++y) {
    for (std::uint32_t x = area.left; x < area.right; ++x) ++counts[o.channel(x, y, 0)];
  }
  return counts;
}

std::uint64_t not_once(const Observed& o) {
  std::uint64_t sum = 0;
  for (const auto& [count, pixels] : coverage_counts(o)) sum += count == 1 ? 0 : pixels;
  return sum;
}

InnerDifference inner_difference(const Observed& o, const ref::Result& r) {
  InnerDifference d;
  for (std::uint32_t y = 0; y < r.height; ++y) {
    for (std::uint32_t x = 0; x < r.width; ++x) {
      if (!is_inner(r, x, y)) continue;
      ++d.pixels;
      const std::size_t i = std::size_t{y} * r.width + x;
      const bool machine = (o.pixel(x, y) >> 24) != 0, reference = r.triangle_id[i] != ref::kNoTriangle;
      d.coverage += machine != reference ? 1 : 0;
      if (!machine || !reference) continue;
      ++d.covered;
      const int distance = channel_distance(o.pixel(x, y), r.color[i]);
      d.worst = std::max(d.worst, distance);
      d.over_two += distance > 2 ? 1 : 0;
    }
  }
  return d;
}

std::uint64_t coverage_difference(const Observed& o, const ref::Result& r) {
  std::uint64_t count = 0;
  for (std::uint32_t y = 0; y < r.height; ++y) {
    for (std::uint32_t x = 0; x < r.width; ++x)
      count +=
          ((o.pixel(x, y) >> 24) != 0) != (r.triangle_id[std::size_t{y} * r.width + x] != ref::kNoTriangle)
              ? 1
              : 0;
  }
  return count;
}

}  // namespace quadrille::studies::stability
