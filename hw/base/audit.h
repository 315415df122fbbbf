/// Laws of conservation: two counts of the same thing, taken from different events, mostly by different
/// units.
///
/// Each unit adds what it counted to the sides that concern it (`Unit::audit`). Summed over a machine both
/// sides have to be equal.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <vector>

namespace quadrille::hw {

/// A law is known by its address.
struct Law {
  std::string_view text;
  std::string_view left, right;  ///< which counters
};

class Audit {
 public:
  struct Sides {
    const Law* law = nullptr;
    std::uint64_t left = 0, right = 0;
  };
  void left(const Law& law, std::uint64_t counted) { sides(law).left += counted; }
  void right(const Law& law, std::uint64_t counted) { sides(law).right += counted; }
  /// Both sides at once, of a law within one unit.
  void both(const Law& law, std::uint64_t left_counted, std::uint64_t right_counted) {
    left(law, left_counted);
    right(law, right_counted);
  }
  /// In the order in which they were named first.
  [[nodiscard]] const std::vector<Sides>& all() const { return all_; }

 private:
  Sides& sides(const Law& law) {
    const auto known = std::ranges::find(all_, &law, &Sides::law);
    if (known != all_.end()) return *known;
    all_.push_back({&law});
    return all_.back();
  }
  std::vector<Sides> all_;
};

}  // namespace quadrille::hw
