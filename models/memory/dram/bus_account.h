/// Where the cycles of a DRAM data bus go: each is charged once, when the burst after it is known.
///
/// A gap before a burst is gone through from its start: first the bus idles until a request was there and its
/// data could have come from an open row; then what lasted longest is charged, in the order refresh,
/// turn-around, activation; what is left is spacing (t_ccd_l between bursts of a bank group, the command bus,
/// and what the policy held back).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille::models {

enum class BusUse : std::uint8_t { kRead, kWrite, kRefresh, kTurnaround, kActivation, kSpacing, kIdle };
inline constexpr std::size_t kBusUses = 7;

/// What a burst waited for, each as the first cycle of data that it would have allowed by itself.
struct BurstWaits {
  std::int64_t pending = 0;    ///< a request was there
  std::int64_t refreshed = 0;  ///< the bank was free of refresh
  std::int64_t turned = 0;     ///< the bus was free to change direction or rank
  std::int64_t activated = 0;  ///< the row was open
};

class BusAccount {
 public:
  using Cycles = std::array<std::int64_t, kBusUses>;

  /// A burst holds the bus during [start, start + length). In order of time.
  void burst(std::int64_t start, std::int64_t length, bool write, const BurstWaits& waits) {
    const BusUse use = write ? BusUse::kWrite : BusUse::kRead;
    if (start != charged_ || late_.empty() || late_.back().use != use)
      return burst_after_gap(start, length, use, waits);
    cycles_[static_cast<std::size_t>(use)] += length;
    late_.back().to = charged_ = start + length;
  }
  /// Every cycle before it is charged: a burst that begins there waited for nothing.
  [[nodiscard]] std::int64_t charged() const { return charged_; }
  /// Cycles of a use so far.
  [[nodiscard]] std::int64_t charged(BusUse use) const { return cycles_[static_cast<std::size_t>(use)]; }
  /// The cycles of [0, end): what was charged before it, and idleness behind the last burst. A burst that
  /// outlives `end` counts up to there.
  [[nodiscard]] Cycles until(std::int64_t end) const;

 private:
  struct Piece {
    BusUse use;
    std::int64_t to;  ///< from the end of the piece before
  };
  void burst_after_gap(std::int64_t start, std::int64_t length, BusUse use, const BurstWaits& waits);
  void charge(BusUse use, std::int64_t to);

  Cycles cycles_{};
  std::int64_t charged_ = 0;  ///< every cycle before it is charged
  std::vector<Piece> late_;   ///< the newest charges, for a frame that ends while the last writes still move
};

}  // namespace quadrille::models
