/// The clause that came first takes what it can use, then the next.
#include "hw/shader/simd_sharing.h"

#include <algorithm>

namespace quadrille::hw {

namespace {

class OldestSharing final : public SimdSharing {
 public:
  void share(std::span<SimdClause> clauses) override {
    double free = 1;
    for (SimdClause& clause : clauses) {
      clause.speed = std::min(clause.share, free) / clause.share;
      free -= clause.speed * clause.share;
      if (free < kSimdRounding) free = 0;
    }
  }
};

}  // namespace

constinit const SimdSharingPolicy kOldestSharing{
    "oldest", "the warp that came first issues all it can, then the next: warps end one after the other",
    []() -> std::unique_ptr<SimdSharing> { return std::make_unique<OldestSharing>(); }};

}  // namespace quadrille::hw
