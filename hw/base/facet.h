/// What a unit shows of itself in its row of the table: counts, shares, means and rates, made of its
/// counters.
#pragma once

#include "hw/base/counter.h"

#include <concepts>
#include <string_view>

namespace quadrille::hw {

/// Rows of several units add up `value` and `whole`.
struct Facet {
  enum class Kind : std::uint8_t {
    kCount,  ///< value
    kShare,  ///< value / whole, in per cent
    kMean,   ///< value / whole
    kRate    ///< value a cycle and unit, and its share of the peak
  };
  std::string_view label;
  Kind kind = Kind::kCount;
  double value = 0;
  double whole = 0;  ///< kShare, kMean
  double peak = 0;   ///< kRate: a cycle and unit
};

inline double number(const Counter& counter) { return static_cast<double>(counter.value()); }
inline double number(std::integral auto n) { return static_cast<double>(n); }

Facet count(std::string_view label, const auto& value) { return {label, Facet::Kind::kCount, number(value)}; }
Facet share(std::string_view label, const auto& value, const auto& of) {
  return {label, Facet::Kind::kShare, number(value), number(of)};
}
Facet mean(std::string_view label, const auto& value, const auto& of) {
  return {label, Facet::Kind::kMean, number(value), number(of)};
}
inline Facet rate(std::string_view label, const Counter& value, double peak) {
  return {label, Facet::Kind::kRate, number(value), 0, peak};
}

}  // namespace quadrille::hw
