/// Crossings as fractions, and what they add up to along a row.
#include "tests/models/raster/coverage_oracle.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace quadrille::models {
namespace {

constexpr int kSize = CoverageWindow::kSize;

/// Numerator and denominator; the denominator is positive.
struct Fraction {
  std::int64_t over = 0, under = 1;
  [[nodiscard]] std::int64_t ceiling() const { return over / under + (over % under > 0 ? 1 : 0); }
  [[nodiscard]] bool whole() const { return over % under == 0; }
};

struct Location {
  double x, y;
};
constexpr std::array<Location, 1> kOne{{{0.5, 0.5}}};
constexpr std::array<Location, 2> kTwo{{{0.75, 0.75}, {0.25, 0.25}}};
constexpr std::array<Location, 4> kFour{{{0.375, 0.125}, {0.875, 0.375}, {0.125, 0.625}, {0.625, 0.875}}};
constexpr std::array<Location, 8> kEight{{{0.5625, 0.3125},
                                          {0.4375, 0.6875},
                                          {0.8125, 0.5625},
                                          {0.3125, 0.1875},
                                          {0.1875, 0.8125},
                                          {0.0625, 0.4375},
                                          {0.6875, 0.9375},
                                          {0.9375, 0.0625}}};

std::span<const Location> locations(int samples) {
  if (samples == 1) return kOne;
  if (samples == 2) return kTwo;
  if (samples == 4) return kFour;
  return kEight;
}

/// The first row of samples at height y or below it; `offset` is the height of the samples of row 0.
std::int64_t first_row_at(std::int64_t y, std::int64_t offset, int bits) {
  return Fraction{y - offset, std::int64_t{1} << bits}.ceiling();
}

}  // namespace

OraclePoint oracle_sample(const CoverageWindow& window, int sample) {
  const Location& at = locations(window.samples)[static_cast<std::size_t>(sample)];
  const auto on_grid = [&](double pixels) {
    return static_cast<std::int64_t>(std::ldexp(pixels, window.subpixel_bits));
  };
  return {on_grid(at.x), on_grid(at.y)};
}

CoverageOracle::CoverageOracle(const CoverageWindow& window)
    : window_(window), steps_(static_cast<std::size_t>(window.samples * kSize), Row{}) {
  for (int s = 0; s < window.samples; ++s) sample_[static_cast<std::size_t>(s)] = oracle_sample(window, s);
  first_row_.fill(kSize);
}

void CoverageOracle::add_edge(const OraclePoint& a, const OraclePoint& b, int times) {
  const bool down = a.y < b.y;
  const OraclePoint &upper = down ? a : b, &lower = down ? b : a;
  const std::int64_t height = lower.y - upper.y;  // 0: it crosses no row
  const int bits = window_.subpixel_bits;
  for (std::size_t s = 0; s < static_cast<std::size_t>(window_.samples); ++s) {
    const std::int64_t first = std::max<std::int64_t>(first_row_at(upper.y, sample_[s].y, bits), window_.y0);
    const std::int64_t end =
        std::min<std::int64_t>(first_row_at(lower.y, sample_[s].y, bits), window_.y0 + kSize);
    for (std::int64_t y = first; y < end; ++y) {
      const std::int64_t below = (y << bits) + sample_[s].y - upper.y;
      // The crossing, from sample s of the window's first pixel, in pixels. |over| < 2^62.
      const std::int64_t left = (std::int64_t{window_.x0} << bits) + sample_[s].x;
      const Fraction crossing{(upper.x - left) * height + below * (lower.x - upper.x), height << bits};
      const std::int64_t column = crossing.ceiling();
      if (crossing.whole() && column >= 0 && column < kSize) ++ties_;
      const int row = static_cast<int>(y - window_.y0);
      first_row_[s] = std::min(first_row_[s], row);
      end_row_[s] = std::max(end_row_[s], row + 1);
      Row& steps = steps_[s * kSize + static_cast<std::size_t>(row)];
      const auto at = static_cast<std::size_t>(std::clamp<std::int64_t>(column, 0, kSize));
      steps[at] = static_cast<std::int16_t>(steps[at] + (down ? -times : times));
    }
  }
}

void CoverageOracle::covered(WindowMasks& masks) const {
  for (int s = 0; s < window_.samples; ++s) {
    const auto sample = static_cast<std::size_t>(s);
    masks[sample].fill(0);
    for (int y = first_row_[sample]; y < end_row_[sample]; ++y) {
      int sum = 0;
      std::uint64_t mask = 0;
      for (std::size_t x = 0; x < kSize; ++x) {
        sum += steps_of(s, y)[x];
        mask |= std::uint64_t{sum != 0} << x;
      }
      masks[sample][static_cast<std::size_t>(y)] = mask;
    }
  }
}

void CoverageOracle::clear() {
  for (std::size_t s = 0; s < static_cast<std::size_t>(window_.samples); ++s)
    for (int y = first_row_[s]; y < end_row_[s]; ++y) steps_[s * kSize + static_cast<std::size_t>(y)].fill(0);
  first_row_.fill(kSize);
  end_row_.fill(0);
}

}  // namespace quadrille::models
