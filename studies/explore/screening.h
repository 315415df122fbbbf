/// Screening: all machines are drawn fast, with a window, and the best of them exactly. It says whether their
/// order held, and whether one that was not drawn exactly could be better.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "studies/explore/exploration.h"

namespace quadrille::studies::explore {

struct Screening {
  std::int64_t window = 0;   ///< cycles
  std::size_t screened = 0;  ///< machines
  std::size_t failed = 0;    ///< points of theirs that could not be drawn with the window
  std::size_t exactly = 0;   ///< machines that were drawn exactly too
  /// How far the window was off, by objective, of machines that were drawn both ways.
  struct Error {
    double greatest = 0;                ///< part of the exact value
    std::size_t pairs = 0, turned = 0;  ///< of machines; those whose order is another one, by more than noise
  };
  std::vector<Error> errors;
  /// Of the others, those that may be better than what was drawn exactly, or on the front, if the window is
  /// off as much there.
  std::size_t maybe_better = 0;
};

/// Draws all machines of the plan with the sweep's screening window, and then its best exactly: those on the
/// front, then those on the front of the others, and so on. The plan becomes these. Throws `UserError` as
/// `Exploration::run`, and when no machine could be drawn.
[[nodiscard]] Screening screen(const Sweep& sweep, const Space& space, std::span<const LoadedScene> scenes,
                               Results& results, const ExploreSetting& setting, Plan& plan);
[[nodiscard]] std::string screening_table(const Sweep& sweep, const Screening& screening);

}  // namespace quadrille::studies::explore
