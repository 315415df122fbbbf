/// Counters that are kept by draw because somebody asks for them, beside those that are always kept where
/// draws are (detail.h).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille::pipeline {

/// A counter of a kind of unit.
struct AskedCounter {
  std::string kind, counter;
};

/// Sums over the units of the kind; of a kind that the frame needs none of they are 0.
struct CountersByDraw {
  std::vector<AskedCounter> asked;
  std::vector<std::vector<std::uint64_t>> draws;  ///< by draw in API order, then by counter
  std::vector<std::uint64_t> outside;             ///< what belongs to no draw
  std::uint64_t total = 0;                        ///< of all counters, as the units have counted
};

}  // namespace quadrille::pipeline
