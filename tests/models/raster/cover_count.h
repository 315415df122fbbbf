/// How often each pixel of a square is covered by a set of triangles, through set-up, walk and coverage.
#pragma once

#include "models/raster/coarse.h"
#include "models/raster/fine.h"
#include "tests/models/raster/brute_force.h"

#include <bit>
#include <vector>

namespace quadrille::models {

class CoverCount {
 public:
  CoverCount(int size, int subpixel_bits)
      : size_(size),
        bits_(subpixel_bits),
        count_(static_cast<std::size_t>(size) * static_cast<std::size_t>(size)) {}

  void add(const WindowVertex& a, const WindowVertex& b, const WindowVertex& c) {
    TriangleSetup t;
    if (setup_in_square({a, b, c}, size_, bits_, t) != SetupOutcome::kKept) return;
    TileWalk walk(t);
    for (TileHit hit; walk.next(hit);) {
      for (std::uint64_t mask = tile_coverage(t, hit.tile_x, hit.tile_y); mask != 0; mask &= mask - 1) {
        const int entry = std::countr_zero(mask);
        ++count_[index(8 * hit.tile_x + entry_x(entry), 8 * hit.tile_y + entry_y(entry))];
      }
    }
  }
  [[nodiscard]] int at(int x, int y) const { return count_[index(x, y)]; }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const { return static_cast<std::size_t>(y * size_ + x); }
  int size_, bits_;
  std::vector<int> count_;
};

}  // namespace quadrille::models
