/// The ellipses of a group of eight lanes as the texture unit takes them: tap by tap, a 2x2 of each lane that
/// has so many.
#pragma once

#include "models/texture/ellipse_texels.h"
#include "models/texture/lanes.h"

#include <immintrin.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace quadrille::models {

class EllipseTaps {
 public:
  /// By tap and corner.
  using Weights = std::array<std::array<GroupFloats, 4>, kMaxEllipseFootprints>;

  /// Weights go there; those of lanes that lack a tap are 0.
  explicit EllipseTaps(Weights& weight) : weight_(weight) {}

  void add(std::size_t lane, std::span<const EllipseFootprint> footprints) {
    for (; count_ < footprints.size(); ++count_) clear(count_);
    for (std::size_t tap = 0; tap < footprints.size(); ++tap) {
      column_[tap][lane] = footprints[tap].column;
      row_[tap][lane] = footprints[tap].row;
      lanes_[tap] |= 1u << lane;
      for (std::size_t corner = 0; corner < 4; ++corner)
        weight_[tap][corner][lane] = footprints[tap].weight[corner];
    }
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  /// Of lanes that lack the tap, 0.
  [[nodiscard]] __m256i column(std::size_t tap) const { return load_lanes(column_[tap].data()); }
  [[nodiscard]] __m256i row(std::size_t tap) const { return load_lanes(row_[tap].data()); }
  [[nodiscard]] std::uint32_t lanes(std::size_t tap) const { return lanes_[tap]; }

 private:
  using Places = std::array<std::array<std::int32_t, 8>, kMaxEllipseFootprints>;

  void clear(std::size_t tap) {
    column_[tap].fill(0);
    row_[tap].fill(0);
    lanes_[tap] = 0;
    for (GroupFloats& corner : weight_[tap]) corner.fill(0.0f);
  }

  Weights& weight_;
  std::size_t count_ = 0;
  // Only what `clear` was called for is set.
  alignas(32) Places column_, row_;
  std::array<std::uint32_t, kMaxEllipseFootprints> lanes_;
};

}  // namespace quadrille::models
