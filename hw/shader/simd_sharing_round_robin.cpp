/// All clauses get the same share; what one cannot use goes to the others.
#include "hw/shader/simd_sharing.h"

#include <algorithm>
#include <vector>

namespace quadrille::hw {

namespace {

class RoundRobinSharing final : public SimdSharing {
 public:
  void share(std::span<SimdClause> clauses) override {
    // The even share is the level that fills the SIMD: those that can use less than it leave the rest to the
    // others.
    double all = 0;
    for (const SimdClause& clause : clauses) all += clause.share;
    const double level = all > 1 ? level_of(clauses) : 1;
    for (SimdClause& clause : clauses) clause.speed = std::min(clause.share, level) / clause.share;
  }

 private:
  double level_of(std::span<const SimdClause> clauses) {
    shares_.clear();
    for (const SimdClause& clause : clauses) shares_.push_back(clause.share);
    std::sort(shares_.begin(), shares_.end());
    double free = 1, level = 1;
    for (std::size_t i = 0; i < shares_.size(); ++i) {
      level = free / static_cast<double>(shares_.size() - i);
      if (shares_[i] >= level) break;
      free -= shares_[i];
    }
    return level;
  }

  std::vector<double> shares_;  ///< scratch
};

}  // namespace

constinit const SimdSharingPolicy kRoundRobinSharing{
    "round_robin", "all warps in turn: each waits for its own results while the others issue",
    []() -> std::unique_ptr<SimdSharing> { return std::make_unique<RoundRobinSharing>(); }};

}  // namespace quadrille::hw
