/// Which line of a full set a cache gives up, one file a policy (replacement_*.cpp).
#pragma once

#include "models/base/policy.h"

#include <cstdint>

namespace quadrille::models {

/// The memory of all sets of a cache: told what happens to their ways, asked for a victim. Slot set x ways +
/// way is a way of a set; there are 64 ways at most.
class Replacement {
 public:
  virtual ~Replacement() = default;
  /// The line in this slot was found by a look-up.
  virtual void used(std::uint32_t slot) = 0;
  /// A line was given this slot.
  virtual void placed(std::uint32_t slot) = 0;
  /// The way to give up of those whose bit is set in `open`; there is one at least, and all ways hold lines.
  [[nodiscard]] virtual std::uint32_t victim(std::uint32_t set, std::uint64_t open) = 0;
  /// All sets are empty again.
  virtual void forget() = 0;
};

/// For so many sets of so many ways.
using ReplacementPolicy = Policy<Replacement, std::uint32_t, std::uint32_t>;
/// What `texture.replacement` and `l2.replacement` choose from.
[[nodiscard]] PolicyList<ReplacementPolicy>& replacement_policies();
extern const ReplacementPolicy kLruReplacement, kFifoReplacement, kTreeReplacement, kRandomReplacement,
    kSrripReplacement;

}  // namespace quadrille::models
