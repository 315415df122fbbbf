/// One pseudo-channel of a controller: its requests, banks, data bus and refresh, and the choice of the next
/// command.
///
/// Each possible command has an earliest cycle. The soonest goes out; among those that can go out now refresh
/// comes first, then activations, then the oldest request's.
#pragma once

#include "models/memory/dram/controller.h"

namespace quadrille::models {

/// When each command bus is free again. Row commands and column commands share one unless the standard gives
/// them a bus each.
class DramCommandBus {
 public:
  explicit DramCommandBus(const DramTiming& t)
      : separate_(t.separate_buses), act_slots_(t.act_slots), column_slots_(t.column_slots) {}
  [[nodiscard]] std::int64_t free(bool column) const { return free_[column && separate_ ? 1 : 0]; }
  void hold_row(std::int64_t at, bool activate) { free_[0] = at + (activate ? act_slots_ : 1); }
  void hold_column(std::int64_t at) { free_[separate_ ? 1 : 0] = at + column_slots_; }

 private:
  bool separate_;
  int act_slots_, column_slots_;
  std::int64_t free_[2] = {0, 0};
};

class DramController::PseudoChannel {
 public:
  PseudoChannel(const DramControllerParams& params, DramCommandBus& commands, std::uint8_t number);

  void take(const DramEntry& entry, Cycle now);
  [[nodiscard]] bool empty() const { return queue_.empty(); }
  /// The first cycle, not before `now`, at which something can be done, with or without requests. Kept until
  /// something changes.
  [[nodiscard]] Cycle next(Cycle now) {
    if (stale_) plan(now);
    return planned_at_;
  }
  /// The command bus was used by another pseudo-channel.
  void replan() { stale_ = true; }
  /// Cycles in which each bank is refreshed once; 0 without refresh.
  [[nodiscard]] Cycle refresh_round() const { return refresh_.front().round(); }
  /// So many more rounds like the latest went by without requests.
  void repeat_refreshes(std::int64_t rounds) {
    for (DramRefreshClock& clock : refresh_) clock.send_rounds(rounds);
    device_.delay_refreshes(rounds * refresh_round());
    refresh_quiet_until_ = 0;
    stale_ = true;
  }
  /// Sends at most one command a bus at `now`.
  void step(Cycle now, std::vector<DramDone>& done, DramCommandCounts& counts,
            const std::function<void(const DramCommand&)>& trace);
  [[nodiscard]] const BusAccount& bus() const { return bus_; }

 private:
  enum class Step : std::uint8_t { kNothing, kActivate, kPrecharge, kColumn, kRefresh, kRefreshBank };
  struct Action {
    Cycle at = kNever;
    std::uint64_t order = ~std::uint64_t{0};  ///< 0: refresh; else the request's
    Step step = Step::kNothing;
    std::uint32_t bank = 0, entry = DramQueue::kNone;  ///< `bank` is the rank of kRefresh
  };
  /// What the scheduler picked for a bank, and what that needs next. Kept until the bank's requests or row
  /// change.
  struct Pick {
    Cycle ready = 0;  ///< as far as the bank itself is concerned
    std::uint64_t order = 0;
    std::uint32_t entry = DramQueue::kNone;
    std::uint32_t rule = 0;  ///< DramDevice::shared_bound
    Step step = Step::kNothing;
    bool stale = true;
  };
  [[nodiscard]] Action choose(Cycle now);
  void plan(Cycle now);
  [[nodiscard]] Cycle earliest(const Pick& pick) const {
    return std::max(
        {pick.ready, device_.shared_bound(pick.rule), commands_.free(pick.step == Step::kColumn)});
  }
  /// True when something that every bank's pick depends on changed.
  bool update_view(Cycle now);
  void update_pick(std::uint32_t bank);
  void choose_pick(Action& best, Cycle now);
  void forget_picks(std::uint32_t bank);
  void consider(Action& best, Cycle now, const Action& action) const;
  void consider_refresh(Action& best, Cycle now);
  // True when it is postponed because requests wait.
  bool consider_rank_refresh(Action& best, Cycle now, std::uint32_t rank);
  bool consider_bank_refresh(Action& best, Cycle now, std::uint32_t rank);
  void consider_idle_rows(Action& best, Cycle now) const;
  [[nodiscard]] bool rank_waits(std::uint32_t rank) const;
  [[nodiscard]] bool barred(std::uint32_t bank, Cycle now) const;
  /// The row was opened and its first burst may still come: a refresh leaves it the time for that, so that
  /// every activation is of use.
  [[nodiscard]] bool keeps_row(std::uint32_t bank, Cycle now) const { return now < row_kept_until(bank); }
  /// 0 for a row that is not kept.
  [[nodiscard]] Cycle row_kept_until(std::uint32_t bank) const;
  void perform(const Action& action, Cycle now, std::vector<DramDone>& done, DramCommandCounts& counts,
               const std::function<void(const DramCommand&)>& trace);
  void chain_bursts(Action action, std::vector<DramDone>& done, DramCommandCounts& counts,
                    const std::function<void(const DramCommand&)>& trace);
  /// True when it was the request's last one. Fills in `command` where there is one.
  bool move_burst(std::uint32_t index, Cycle now, std::vector<DramDone>& done, DramCommand* command);
  [[nodiscard]] DramCommand command(Step step, std::uint32_t bank, Cycle now) const;

  const DramControllerParams& params_;
  DramCommandBus& commands_;
  std::uint8_t number_;
  DramQueue queue_;
  DramDevice device_;
  std::unique_ptr<DramScheduler> scheduler_;
  std::unique_ptr<DramWriteDrain> drain_;
  std::unique_ptr<DramPagePolicy> page_;
  std::vector<DramRefreshClock> refresh_;  ///< by rank
  BusAccount bus_;
  Cycle waiting_since_ = 0;  ///< the queue was empty until then
  std::vector<Cycle> used_;  ///< by bank: its last burst
  DramView view_;
  std::vector<Pick> picks_;  ///< by bank
  /// by rank: its requests wait for a refresh (of the bank in turn)
  std::vector<std::uint8_t> must_refresh_;
  bool any_must_ = false;
  Cycle kept_until_ = kNever;      ///< a row that a refresh waits for is kept until then
  Cycle refresh_quiet_until_ = 0;  ///< until then no refresh concerns what is chosen
  /// until then no request starves that did not; 0 when the queue changed
  Cycle view_holds_until_ = 0;
  std::vector<std::uint8_t> fresh_rows_;  ///< by bank: the row was opened and no burst of it moved yet
  bool stale_ = true;                     ///< what follows must be found again
  Action planned_;
  Cycle planned_at_ = 0;  ///< its cycle, or when to look again if that is earlier
};

}  // namespace quadrille::models
