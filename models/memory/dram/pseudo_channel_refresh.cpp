/// A pseudo-channel's refresh: when it is considered, and whom it keeps waiting (pseudo_channel.h).
#include <algorithm>

#include "models/memory/dram/pseudo_channel.h"

namespace quadrille::models {

bool DramController::PseudoChannel::rank_waits(std::uint32_t rank) const {
  const auto of_rank = [&](std::uint32_t bank) { return device_.rank_of(bank) == rank; };
  return std::ranges::any_of(queue_.active_banks(false), of_rank) ||
         std::ranges::any_of(queue_.active_banks(true), of_rank);
}

bool DramController::PseudoChannel::consider_rank_refresh(Action& best, Cycle now, std::uint32_t rank) {
  const bool must = refresh_[rank].must(now);
  must_refresh_[rank] = must;
  any_must_ |= must;
  if (!must && rank_waits(rank)) return true;
  bool closed = true;
  const auto banks = static_cast<std::uint32_t>(params_.timing.banks);
  for (std::uint32_t bank = rank * banks; bank < (rank + 1) * banks; ++bank) {
    if (device_.open_row(bank) == DramDevice::kClosed) continue;
    closed = false;
    if (keeps_row(bank, now)) kept_until_ = std::min(kept_until_, row_kept_until(bank));
    else
      consider(
          best, now,
          {std::max(device_.earliest_precharge(bank), commands_.free(false)), 0, Step::kPrecharge, bank});
  }
  if (closed)
    consider(best, now,
             {std::max(device_.earliest_refresh(rank), commands_.free(false)), 0, Step::kRefresh, rank});
  return false;
}

bool DramController::PseudoChannel::consider_bank_refresh(Action& best, Cycle now, std::uint32_t rank) {
  const std::uint32_t bank = rank * static_cast<std::uint32_t>(params_.timing.banks) + refresh_[rank].bank();
  const bool must = refresh_[rank].must(now);
  must_refresh_[rank] = must;
  any_must_ |= must;
  if (!must && queue_.bank_count(bank) > 0) return true;
  if (keeps_row(bank, now)) {
    kept_until_ = std::min(kept_until_, row_kept_until(bank));
    return false;
  }
  if (device_.open_row(bank) != DramDevice::kClosed)
    consider(best, now,
             {std::max(device_.earliest_precharge(bank), commands_.free(false)), 0, Step::kPrecharge, bank});
  else
    consider(
        best, now,
        {std::max(device_.earliest_refresh_bank(bank), commands_.free(false)), 0, Step::kRefreshBank, bank});
  return false;
}

void DramController::PseudoChannel::consider_refresh(Action& best, Cycle now) {
  if (now < refresh_quiet_until_) return;
  any_must_ = false;
  refresh_quiet_until_ = kNever;
  for (std::uint32_t rank = 0; rank < refresh_.size(); ++rank) {
    const DramRefreshClock& clock = refresh_[rank];
    must_refresh_[rank] = 0;
    if (!clock.on()) continue;
    if (clock.due_at() > now) {
      refresh_quiet_until_ = std::min(refresh_quiet_until_, clock.due_at());
      continue;
    }
    // Postponed while requests wait: it stays so until it must be, or the last one of a bank leaves.
    const bool postponed =
        clock.per_bank() ? consider_bank_refresh(best, now, rank) : consider_rank_refresh(best, now, rank);
    refresh_quiet_until_ = std::min(refresh_quiet_until_, postponed ? clock.must_at() : 0);
  }
}

DramController::Cycle DramController::PseudoChannel::row_kept_until(std::uint32_t bank) const {
  if (fresh_rows_[bank] == 0) return 0;
  return std::max(device_.row_ready(bank, false), device_.row_ready(bank, true)) + params_.timing.t_rc;
}

bool DramController::PseudoChannel::barred(std::uint32_t bank, Cycle now) const {
  const std::uint32_t rank = device_.rank_of(bank);
  if (must_refresh_[rank] == 0 || keeps_row(bank, now)) return false;
  return !refresh_[rank].per_bank() ||
         bank == rank * static_cast<std::uint32_t>(params_.timing.banks) + refresh_[rank].bank();
}

}  // namespace quadrille::models
