/// Measures that several cases share: how often pixels were covered, and how far the picture's inner pixels
/// are from a reference.
#pragma once

#include "studies/stability/observed.h"

#include <cstdint>
#include <map>
#include <random>

namespace quadrille::studies::stability {

/// Pixels of the drawn area by how often they were covered: red of a target that counts.
[[nodiscard]] std::map<std::uint32_t, std::uint64_t> coverage_counts(const Observed& observed);
/// Those that were not covered exactly once.
[[nodiscard]] std::uint64_t not_once(const Observed& observed);

/// Compares pixels whose eight neighbours show the same triangle (or background) in the reference, so that an
/// edge a little off is not counted.
struct InnerDifference {
  std::uint64_t pixels = 0, covered = 0;
  std::uint64_t coverage = 0;  ///< covered in one, background in the other
  int worst = 0;               ///< largest difference of a channel, of 255, where both are covered
  std::uint64_t over_two = 0;  ///< pixels covered in both with a channel more than 2 off
};
/// The target is cleared to alpha 0 and every draw writes alpha 1.
[[nodiscard]] InnerDifference inner_difference(const Observed& observed,
                                               const models::reference::Result& reference);
/// Pixels covered in one and not in the other, edges and all.
[[nodiscard]] std::uint64_t coverage_difference(const Observed& observed,
                                                const models::reference::Result& reference);

/// Chance that is the same on every computer: a fixed generator, and fractions made of its bits.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : engine_(seed) {}
  /// Uniform in [low, high).
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace quadrille::studies::stability
