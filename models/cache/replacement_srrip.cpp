/// The line whose next use is predicted farthest away: a new line counts as a distant one until it is used.
/// [P: Jaleel 2010, SRRIP with hit priority and two bits]
#include "models/cache/replacement.h"

#include <algorithm>
#include <bit>
#include <vector>

namespace quadrille::models {
namespace {

constexpr std::uint8_t kNear = 0, kLong = 2, kDistant = 3;

class SrripReplacement final : public Replacement {
 public:
  SrripReplacement(std::uint32_t sets, std::uint32_t ways)
      : ways_(ways), predictions_(std::size_t{sets} * ways, kDistant) {}

  void used(std::uint32_t slot) override { predictions_[slot] = kNear; }
  void placed(std::uint32_t slot) override { predictions_[slot] = kLong; }
  // All grow older together until an open one is distant; the first of those goes.
  [[nodiscard]] std::uint32_t victim(std::uint32_t set, std::uint64_t open) override {
    std::uint8_t* const predictions = predictions_.data() + std::size_t{set} * ways_;
    auto farthest = static_cast<std::uint32_t>(std::countr_zero(open));
    for (; open != 0; open &= open - 1)
      if (const auto way = static_cast<std::uint32_t>(std::countr_zero(open));
          predictions[way] > predictions[farthest])
        farthest = way;
    const int years = kDistant - predictions[farthest];
    for (std::uint32_t way = 0; way < ways_; ++way)
      predictions[way] = static_cast<std::uint8_t>(std::min<int>(kDistant, predictions[way] + years));
    return farthest;
  }
  void forget() override { std::ranges::fill(predictions_, kDistant); }

 private:
  std::uint32_t ways_;
  std::vector<std::uint8_t> predictions_;
};

}  // namespace

constinit const ReplacementPolicy kSrripReplacement{
    "srrip", "the one predicted to be used last: a stream that is read once takes no place from lines in use",
    [](std::uint32_t sets, std::uint32_t ways) -> std::unique_ptr<Replacement> {
      return std::make_unique<SrripReplacement>(sets, ways);
    }};

}  // namespace quadrille::models
