/// How far off: an approximate run's figures from the exact ones, and a picture from what it ideally is.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "studies/timed_run.h"

namespace quadrille::studies {

/// Relative errors in percent; infinite where the exact figure is 0 and the other is not.
struct CostError {
  double cycles_percent = 0;
  /// percentage points of utilisation, over all units, without sign
  double busy_mean_points = 0, busy_max_points = 0;
  std::string worst_unit;  ///< of `busy_max_points`; empty when no unit differs
  double memory_percent = 0;
  double client_max_percent = 0;  ///< the largest without its sign
  std::string worst_client;       ///< empty when no client differs
};

[[nodiscard]] double relative_percent(double exact, double other);
/// The same machine's units and clients in both.
[[nodiscard]] CostError cost_error(const MachineCost& exact, const MachineCost& other);

/// Distance of a picture from another, in steps of 1/255 as stored; alpha does not count.
struct ImageError {
  std::uint64_t pixels = 0;
  double rmse = 0;     ///< over red, green and blue of all pixels
  double psnr_db = 0;  ///< infinite for equal pictures
  double within_1_percent = 0, within_2_percent = 0;
  int max = 0;
};

/// Compares the pixels whose `left_out` entry is 0; an empty `left_out` leaves out none.
[[nodiscard]] ImageError image_error(std::span<const std::uint32_t> image,
                                     std::span<const std::uint32_t> ideal,
                                     std::span<const std::uint8_t> left_out = {});

}  // namespace quadrille::studies
