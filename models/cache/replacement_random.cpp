/// Any line, by a shift register: the same numbers in every run.
#include "models/cache/replacement.h"

#include <bit>

namespace quadrille::models {
namespace {

constexpr std::uint32_t kSeed = 0x2545f491;

class RandomReplacement final : public Replacement {
 public:
  void used(std::uint32_t /*slot*/) override {}
  void placed(std::uint32_t /*slot*/) override {}
  [[nodiscard]] std::uint32_t victim(std::uint32_t /*set*/, std::uint64_t open) override {
    for (auto skipped = next() % static_cast<std::uint32_t>(std::popcount(open)); skipped > 0; --skipped)
      open &= open - 1;
    return static_cast<std::uint32_t>(std::countr_zero(open));
  }
  void forget() override {}

 private:
  /// [P: Marsaglia 2003, xorshift]
  std::uint32_t next() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 17;
    state_ ^= state_ << 5;
    return state_;
  }
  std::uint32_t state_ = kSeed;
};

}  // namespace

constinit const ReplacementPolicy kRandomReplacement{
    "random", "any line: one shift register for all sets, and no pattern of use is always wrong",
    [](std::uint32_t, std::uint32_t) -> std::unique_ptr<Replacement> {
      return std::make_unique<RandomReplacement>();
    }};

}  // namespace quadrille::models
