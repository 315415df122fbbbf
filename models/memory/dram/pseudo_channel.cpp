#include "models/memory/dram/pseudo_channel.h"

#include "models/memory/device_memory.h"

#include <algorithm>
#include <bit>

namespace quadrille::models {

DramController::PseudoChannel::PseudoChannel(const DramControllerParams& params, DramCommandBus& commands,
                                             std::uint8_t number)
    : params_(params),
      commands_(commands),
      number_(number),
      queue_(static_cast<std::size_t>(params.timing.all_banks())),
      device_(params.timing),
      scheduler_(params.scheduler->make({params.in_order_ahead})),
      drain_(params.write_drain->make({std::max(1, params.write_high / params.timing.pseudo_channels),
                                       params.write_low / params.timing.pseudo_channels})),
      page_(params.page->make({params.page_idle})),
      refresh_(static_cast<std::size_t>(params.timing.ranks), DramRefreshClock(params.timing)),
      used_(static_cast<std::size_t>(params.timing.all_banks()), 0),
      view_{queue_, device_},
      picks_(static_cast<std::size_t>(params.timing.all_banks())),
      must_refresh_(static_cast<std::size_t>(params.timing.ranks), 0),
      fresh_rows_(static_cast<std::size_t>(params.timing.all_banks()), 0) {}

void DramController::PseudoChannel::take(const DramEntry& entry, Cycle now) {
  if (queue_.empty()) waiting_since_ = now;
  queue_.add(entry);
  view_holds_until_ = 0;
  forget_picks(entry.at.bank);
  // What was planned stands unless the request changes the rules, or can be served sooner.
  if (stale_ || planned_.order == 0 || scheduler_->looks_beyond_bank() || update_view(now)) {
    stale_ = true;
    return;
  }
  update_pick(entry.at.bank);
  const Pick& pick = picks_[entry.at.bank];
  stale_ = pick.step != Step::kNothing && earliest(pick) <= planned_.at;
}

void DramController::PseudoChannel::consider(Action& best, Cycle now, const Action& action) const {
  const Cycle at = std::max(now, action.at);
  if (at > best.at || (at == best.at && action.order >= best.order)) return;
  best = action;
  best.at = at;
}

void DramController::PseudoChannel::forget_picks(std::uint32_t bank) {
  picks_[bank].stale = true;
  if (!scheduler_->looks_beyond_bank()) return;
  for (Pick& pick : picks_) pick.stale = true;
}

void DramController::PseudoChannel::update_pick(std::uint32_t bank) {
  Pick& pick = picks_[bank];
  pick = {kNever, ~std::uint64_t{0}, scheduler_->pick(view_, bank), device_.no_rule(), Step::kNothing, false};
  if (pick.entry == DramQueue::kNone) return;
  const DramEntry& entry = queue_[pick.entry];
  const std::int32_t open = device_.open_row(bank);
  if (open == entry.at.row) {
    if (!scheduler_->moves(view_, pick.entry)) return;
    pick.step = Step::kColumn;
    pick.rule = DramDevice::column_rule(device_.group_of(bank), entry.write);
    pick.ready = device_.row_ready(bank, entry.write);
  } else if (open == DramDevice::kClosed) {
    pick.step = Step::kActivate;
    pick.rule = DramDevice::activate_rule(device_.group_of(bank));
    pick.ready = device_.bank_activate(bank);
  } else {
    pick.step = Step::kPrecharge;
    pick.ready = device_.earliest_precharge(bank);
  }
  // An ACT goes first: the window of four ACTs does not wait, while a burst leaves room for other commands.
  pick.order = entry.seq + 1 + (pick.step == Step::kActivate ? 0 : std::uint64_t{1} << 62);
}

bool DramController::PseudoChannel::update_view(Cycle now) {
  drain_->update(queue_);
  // Before a refresh that must be, a row that was just opened gets its burst whatever the drain does.
  DramView view{queue_, device_, drain_->reads() || any_must_, drain_->writes() || any_must_};
  Cycle holds_until = kNever;
  for (const bool write : {false, true}) {
    const std::uint32_t oldest = queue_.oldest(write);
    if (oldest == DramQueue::kNone) continue;
    const Cycle starves_at = queue_[oldest].arrived + params_.age_cap + 1;
    if (now >= starves_at) view.starving[write] = oldest;
    else holds_until = std::min(holds_until, starves_at);
  }
  view_holds_until_ = any_must_ ? 0 : holds_until;
  const bool same =
      view.reads == view_.reads && view.writes == view_.writes && view.starving == view_.starving;
  view_.reads = view.reads;
  view_.writes = view.writes;
  view_.starving = view.starving;
  if (same) return false;
  for (Pick& pick : picks_) pick.stale = true;
  return true;
}

void DramController::PseudoChannel::consider_idle_rows(Action& best, Cycle now) const {
  for (std::uint32_t bank = 0; bank < used_.size(); ++bank) {
    if (device_.open_row(bank) == DramDevice::kClosed || queue_.bank_count(bank) > 0) continue;
    const Cycle at =
        std::max({device_.earliest_precharge(bank), page_->closes_at(used_[bank]), commands_.free(false)});
    consider(best, now, {at, ~std::uint64_t{0} - 1, Step::kPrecharge, bank});
  }
}

DramController::PseudoChannel::Action DramController::PseudoChannel::choose(Cycle now) {
  Action best;
  consider_refresh(best, now);
  if (page_->times()) consider_idle_rows(best, now);
  if (queue_.empty()) return best;
  if (any_must_ || now >= view_holds_until_) (void)update_view(now);
  choose_pick(best, now);
  return best;
}

// This loop takes a good part of the simulation's time.
void DramController::PseudoChannel::choose_pick(Action& best, Cycle now) {
  const Cycle* shared = device_.shared_bounds();
  const Cycle row_bus = std::max(now, commands_.free(false)),
              column_bus = std::max(now, commands_.free(true));
  Cycle best_at = best.at;
  std::uint64_t best_order = best.order;
  std::uint32_t chosen = DramQueue::kNone;
  for (const bool write : {false, true}) {
    if (!(write ? view_.writes : view_.reads)) continue;
    for (const std::uint32_t bank : queue_.active_banks(write)) {
      if (picks_[bank].stale) update_pick(bank);
      const Pick& pick = picks_[bank];
      const Cycle own = std::max(pick.ready, shared[pick.rule]);
      const Cycle at = std::max(own, pick.step == Step::kColumn ? column_bus : row_bus);
      if (at > best_at || (at == best_at && pick.order >= best_order) || (any_must_ && barred(bank, now)))
        continue;
      best_at = at;
      best_order = pick.order;
      chosen = bank;
    }
  }
  if (chosen == DramQueue::kNone) return;
  const Pick& pick = picks_[chosen];
  best = {best_at, best_order, pick.step, chosen, pick.entry};
}

void DramController::PseudoChannel::plan(Cycle now) {
  kept_until_ = kNever;
  planned_ = choose(now);
  stale_ = false;
  // Where all wait for a refresh, and that for a row that is kept, nothing else says when to look again.
  Cycle at = planned_.step == Step::kNothing ? kept_until_ : planned_.at;
  for (const DramRefreshClock& clock : refresh_) {
    if (!clock.on()) continue;
    // Without requests a refresh goes out when it is due, with them when it must.
    if (clock.due_at() > now) at = std::min(at, clock.due_at());
    else if (clock.must_at() > now) at = std::min(at, clock.must_at());
  }
  planned_at_ = at;
}

DramCommand DramController::PseudoChannel::command(Step step, std::uint32_t bank, Cycle now) const {
  const auto group_banks = static_cast<std::uint32_t>(params_.timing.group_banks());
  const auto groups = static_cast<std::uint32_t>(params_.timing.bank_groups);
  DramCommand c;
  c.cycle = now;
  c.pseudo_channel = number_;
  if (step == Step::kRefresh) {
    c.kind = DramCommandKind::kRefresh;
    c.rank = static_cast<std::uint8_t>(bank);
    return c;
  }
  c.kind = step == Step::kActivate      ? DramCommandKind::kActivate
           : step == Step::kRefreshBank ? DramCommandKind::kRefreshBank
                                        : DramCommandKind::kPrecharge;
  c.rank = static_cast<std::uint8_t>(device_.rank_of(bank));
  c.bank_group = static_cast<std::uint16_t>(device_.group_of(bank) % groups);
  c.bank = static_cast<std::uint16_t>(bank % group_banks);
  return c;
}

bool DramController::PseudoChannel::move_burst(std::uint32_t index, Cycle now, std::vector<DramDone>& done,
                                               DramCommand* command) {
  DramEntry& entry = queue_[index];
  const std::uint32_t bank = entry.at.bank;
  const int burst = std::countr_zero(entry.bursts);
  entry.bursts &= entry.bursts - 1;
  const bool last = entry.bursts == 0;
  const bool closes = page_->closes_with(queue_, index, last);
  if (command != nullptr) {
    command->row = entry.at.row;
    command->column = static_cast<std::int32_t>(entry.at.column) * static_cast<int>(kLineBytes) /
                          params_.timing.burst_bytes +
                      burst;
    command->kind = entry.write ? (closes ? DramCommandKind::kWritePrecharge : DramCommandKind::kWrite)
                                : (closes ? DramCommandKind::kReadPrecharge : DramCommandKind::kRead);
  }
  const auto data = [&](Cycle at) { return device_.data_start(entry.write, at); };
  BurstWaits waits;
  if (data(now) > bus_.charged())
    waits = {data(waiting_since_), data(device_.refreshed(bank)), data(device_.turned(bank, entry.write)),
             data(device_.row_ready(bank, entry.write))};
  bus_.burst(data(now), params_.timing.t_burst, entry.write, waits);
  const Cycle end = data(now) + params_.timing.t_burst;
  device_.column(bank, entry.write, closes, now);
  used_[bank] = now;
  fresh_rows_[bank] = 0;
  commands_.hold_column(now);
  if (!last) return false;
  const DramRowOutcome row = entry.closed_other ? DramRowOutcome::kConflict
                             : entry.opened     ? DramRowOutcome::kMiss
                                                : DramRowOutcome::kHit;
  done.push_back({entry.id, entry.write, row, entry.arrived, end});
  queue_.remove(index);
  view_holds_until_ = 0;
  if (queue_.bank_count(bank) == 0) refresh_quiet_until_ = 0;
  return true;
}

void DramController::PseudoChannel::perform(const Action& action, Cycle now, std::vector<DramDone>& done,
                                            DramCommandCounts& counts,
                                            const std::function<void(const DramCommand&)>& trace) {
  DramCommand sent;
  if (trace) sent = command(action.step, action.bank, now);
  bool changes_picks = action.step != Step::kRefresh;
  switch (action.step) {
    case Step::kNothing: return;
    case Step::kColumn: {
      ++(queue_[action.entry].write ? counts.writes : counts.reads);
      changes_picks = move_burst(action.entry, now, done, trace ? &sent : nullptr);
      break;
    }
    case Step::kActivate:
      sent.row = queue_[action.entry].at.row;
      queue_[action.entry].opened = true;
      fresh_rows_[action.bank] = 1;
      device_.activate(action.bank, sent.row, now);
      commands_.hold_row(now, true);
      ++counts.activates;
      break;
    case Step::kPrecharge:
      if (action.entry != DramQueue::kNone) queue_[action.entry].closed_other = true;
      device_.precharge(action.bank, now);
      fresh_rows_[action.bank] = 0;
      commands_.hold_row(now, false);
      ++counts.precharges;
      break;
    case Step::kRefresh:
    case Step::kRefreshBank:
      if (action.step == Step::kRefresh) {
        device_.refresh(action.bank, now);
        for (Pick& pick : picks_) pick.stale = true;
      } else {
        device_.refresh_bank(action.bank, now);
      }
      refresh_[action.step == Step::kRefresh ? action.bank : device_.rank_of(action.bank)].send();
      refresh_quiet_until_ = 0;
      commands_.hold_row(now, false);
      ++counts.refreshes;
      break;
  }
  if (changes_picks) forget_picks(action.bank);
  if (trace) trace(sent);
}

// When nothing else waits, the bursts of a request follow its first one without being chosen again.
void DramController::PseudoChannel::chain_bursts(Action action, std::vector<DramDone>& done,
                                                 DramCommandCounts& counts,
                                                 const std::function<void(const DramCommand&)>& trace) {
  // there, others could send before them
  if (params_.timing.shared_commands || params_.timing.separate_buses) return;
  const std::size_t before = done.size();
  while (queue_.count(false) + queue_.count(true) == 1 && done.size() == before && !any_must_) {
    update_pick(action.bank);
    action.at = earliest(picks_[action.bank]);
    perform(action, action.at, done, counts, trace);
  }
}

void DramController::PseudoChannel::step(Cycle now, std::vector<DramDone>& done, DramCommandCounts& counts,
                                         const std::function<void(const DramCommand&)>& trace) {
  // Two buses take a command each.
  for (int bus = 0; bus < 2; ++bus) {
    if (stale_ || planned_.at != now) plan(now);
    if (planned_.at > now) return;
    const Action action = planned_;
    stale_ = true;
    const std::size_t before = done.size();
    perform(action, now, done, counts, trace);
    if (action.step == Step::kColumn && done.size() == before) chain_bursts(action, done, counts, trace);
    if (!params_.timing.separate_buses) return;
  }
}

}  // namespace quadrille::models
