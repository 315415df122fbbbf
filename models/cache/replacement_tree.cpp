/// Nearly the least recently used line: a binary tree over the ways, each node of which points to the half
/// that was used longer ago.
#include "models/cache/replacement.h"

#include <algorithm>
#include <bit>
#include <vector>

namespace quadrille::models {
namespace {

class TreeReplacement final : public Replacement {
 public:
  TreeReplacement(std::uint32_t sets, std::uint32_t ways)
      : ways_(ways), leaves_(std::bit_ceil(ways)), nodes_(sets, 0) {}

  void used(std::uint32_t slot) override { point_away(slot / ways_, slot % ways_); }
  void placed(std::uint32_t slot) override { point_away(slot / ways_, slot % ways_); }
  // A half without an open way is passed over.
  [[nodiscard]] std::uint32_t victim(std::uint32_t set, std::uint64_t open) override {
    std::uint32_t node = 1, first = 0;
    for (std::uint32_t half = leaves_ / 2; half > 0; half /= 2) {
      const std::uint64_t left = ways_mask(half) << first, right = left << half;
      bool upper = (nodes_[set] >> node & 1) != 0;
      if ((open & (upper ? right : left)) == 0) upper = !upper;
      first += upper ? half : 0;
      node = 2 * node + (upper ? 1 : 0);
    }
    return first;
  }
  void forget() override { std::ranges::fill(nodes_, 0); }

 private:
  /// `half` is at most 32.
  static std::uint64_t ways_mask(std::uint32_t half) { return (std::uint64_t{1} << half) - 1; }
  void point_away(std::uint32_t set, std::uint32_t way) {
    std::uint32_t node = 1;
    for (std::uint32_t half = leaves_ / 2; half > 0; half /= 2) {
      const bool upper = (way & half) != 0;
      const std::uint64_t bit = std::uint64_t{1} << node;
      nodes_[set] = upper ? nodes_[set] & ~bit : nodes_[set] | bit;
      node = 2 * node + (upper ? 1 : 0);
    }
  }

  std::uint32_t ways_, leaves_;       ///< leaves: ways, up to a power of two
  std::vector<std::uint64_t> nodes_;  ///< by set: bit n of node n, the root is node 1; 1: the upper half
};

}  // namespace

constinit const ReplacementPolicy kTreeReplacement{
    "tree", "nearly the one that was used longest ago (tree-PLRU): a bit less than one a way",
    [](std::uint32_t sets, std::uint32_t ways) -> std::unique_ptr<Replacement> {
      return std::make_unique<TreeReplacement>(sets, ways);
    }};

}  // namespace quadrille::models
