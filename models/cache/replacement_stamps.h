/// Policies that give up the way with the oldest time stamp: of its last use, or of its line's arrival.
#pragma once

#include "models/cache/replacement.h"

#include <algorithm>
#include <bit>
#include <vector>

namespace quadrille::models {

class StampReplacement : public Replacement {
 public:
  StampReplacement(std::uint32_t sets, std::uint32_t ways)
      : ways_(ways), stamps_(std::size_t{sets} * ways, 0) {}
  void placed(std::uint32_t slot) final { stamp(slot); }
  [[nodiscard]] std::uint32_t victim(std::uint32_t set, std::uint64_t open) final {
    const std::uint64_t* stamps = stamps_.data() + std::size_t{set} * ways_;
    auto oldest = static_cast<std::uint32_t>(std::countr_zero(open));
    for (; open != 0; open &= open - 1)
      if (const auto way = static_cast<std::uint32_t>(std::countr_zero(open)); stamps[way] < stamps[oldest])
        oldest = way;
    return oldest;
  }
  void forget() final { std::ranges::fill(stamps_, 0); }

 protected:
  void stamp(std::uint32_t slot) { stamps_[slot] = ++clock_; }

 private:
  std::uint32_t ways_;
  std::vector<std::uint64_t> stamps_;
  std::uint64_t clock_ = 0;
};

}  // namespace quadrille::models
