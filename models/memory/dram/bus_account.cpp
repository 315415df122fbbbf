#include "models/memory/dram/bus_account.h"

#include "models/base/error.h"

#include <algorithm>

namespace quadrille::models {

namespace {
/// Pieces kept at least: more than the writes that a controller and the cache before it can hold make.
constexpr std::size_t kLatePieces = 8192;
}  // namespace

void BusAccount::charge(BusUse use, std::int64_t to) {
  if (to <= charged_) return;
  cycles_[static_cast<std::size_t>(use)] += to - charged_;
  charged_ = to;
  if (!late_.empty() && late_.back().use == use) {
    late_.back().to = to;
    return;
  }
  if (late_.size() == 2 * kLatePieces)
    late_.erase(late_.begin(), late_.begin() + static_cast<std::ptrdiff_t>(kLatePieces));
  late_.push_back({use, to});
}

void BusAccount::burst_after_gap(std::int64_t start, std::int64_t length, BusUse use,
                                 const BurstWaits& waits) {
  QUADRILLE_CHECK(start >= charged_ || cycles_ == Cycles{}, "burst at {} while the bus is held until {}",
                  start, charged_);
  if (start > charged_) {
    charge(BusUse::kIdle, std::min(start, waits.pending));
    charge(BusUse::kRefresh, std::min(start, waits.refreshed));
    charge(BusUse::kTurnaround, std::min(start, waits.turned));
    charge(BusUse::kActivation, std::min(start, waits.activated));
    charge(BusUse::kSpacing, start);
  }
  charge(use, start + length);
}

BusAccount::Cycles BusAccount::until(std::int64_t end) const {
  Cycles cycles = cycles_;
  std::int64_t charged = charged_;
  for (std::size_t i = late_.size(); i-- > 0 && charged > end;) {
    const std::int64_t from = std::max(end, i > 0 ? late_[i - 1].to : 0);
    cycles[static_cast<std::size_t>(late_[i].use)] -= charged - from;
    charged = from;
  }
  QUADRILLE_CHECK(charged <= end, "the frame ended at {}, {} cycles before what is still known of the bus",
                  end, charged - end);
  cycles[static_cast<std::size_t>(BusUse::kIdle)] += end - charged;
  return cycles;
}

}  // namespace quadrille::models
