/// Random choices for the mutators: the same for the same seed, everywhere.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

namespace quadrille::fuzz {

class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  /// 0..count-1; 0 for count 0.
  std::size_t below(std::size_t count) { return count == 0 ? 0 : engine_() % count; }
  /// True one time in `count`.
  bool one_in(std::size_t count) { return below(count) == 0; }
  template <class Range>
  const auto& pick(const Range& range) {
    return range[below(std::size(range))];
  }

 private:
  std::mt19937 engine_;
};

}  // namespace quadrille::fuzz
