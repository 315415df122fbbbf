/// What a case of the catalogue found: a measured value beside its bound, and whether it holds.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::studies::stability {

struct Finding {
  std::string what, measured, bound;  ///< as printed; an empty bound means that the value is reported only
  bool holds = true;
};

/// Collects the findings of a case.
class Findings {
 public:
  /// Two counts that must be equal.
  void equal(std::string_view what, std::uint64_t measured, std::uint64_t wanted);
  /// A value that must not be above, or below, its bound; a NaN holds to none.
  void at_most(std::string_view what, double measured, double bound, std::string_view unit = "");
  void at_least(std::string_view what, double measured, double bound, std::string_view unit = "");
  /// A text that must be the expected one.
  void is(std::string_view what, std::string_view measured, std::string_view wanted);
  /// Measured and reported; nothing is asked of it.
  void note(std::string_view what, std::string measured);
  /// Anything else.
  void add(Finding finding) { all_.push_back(std::move(finding)); }

  [[nodiscard]] const std::vector<Finding>& all() const { return all_; }
  [[nodiscard]] bool hold() const;

 private:
  std::vector<Finding> all_;
};

}  // namespace quadrille::studies::stability
