/// Which dirty lines leave the L2 cache with a dirty victim, one file a policy (write_back_*.cpp).
#pragma once

#include "models/base/policy.h"
#include "models/memory/interleave.h"

#include <cstdint>

namespace quadrille::hw {

class WriteBack {
 public:
  virtual ~WriteBack() = default;
  /// Lines first..last-1 of those of the victim's slice, by their numbers within it, leave with it if they
  /// are held and dirty.
  struct Lines {
    std::uint32_t first = 0, last = 0;
  };
  [[nodiscard]] virtual Lines with(std::uint32_t victim, const models::Interleave& slices) const = 0;
};

struct WriteBackSetup {
  std::uint32_t block_lines = 1;  ///< `row`
};
using WriteBackPolicy = Policy<WriteBack, const WriteBackSetup&>;
/// What `l2.write_back` chooses from.
[[nodiscard]] PolicyList<WriteBackPolicy>& write_back_policies();
extern const WriteBackPolicy kVictimWriteBack, kRowWriteBack;

}  // namespace quadrille::hw
