#include "tests/models/memory/dram_checker.h"

#include "tests/models/memory/dram_rules.h"

#include <fmt/format.h>
#include <algorithm>

namespace quadrille::models {

namespace {

constexpr std::size_t kKept = 100;  // violations with their text; a broken model makes millions

DramEvent event_of(DramCommandKind kind) {
  switch (kind) {
    case DramCommandKind::kActivate: return DramEvent::kActivate;
    case DramCommandKind::kPrecharge: return DramEvent::kPrecharge;
    case DramCommandKind::kRead:
    case DramCommandKind::kReadPrecharge: return DramEvent::kRead;
    case DramCommandKind::kWrite:
    case DramCommandKind::kWritePrecharge: return DramEvent::kWrite;
    case DramCommandKind::kRefresh: return DramEvent::kRefresh;
    case DramCommandKind::kRefreshBank: return DramEvent::kRefreshBank;
  }
  return DramEvent::kActivate;
}

const char* kind_name(DramCommandKind kind) {
  switch (kind) {
    case DramCommandKind::kActivate: return "ACT";
    case DramCommandKind::kPrecharge: return "PRE";
    case DramCommandKind::kRead: return "RD";
    case DramCommandKind::kWrite: return "WR";
    case DramCommandKind::kReadPrecharge: return "RDA";
    case DramCommandKind::kWritePrecharge: return "WRA";
    case DramCommandKind::kRefresh: return "REF";
    case DramCommandKind::kRefreshBank: return "REFpb";
  }
  return "?";
}

std::string text_of(const DramCommand& c) {
  return fmt::format("{} at {} (pseudo-channel {}, rank {}, group {}, bank {}, row {}, column {})",
                     kind_name(c.kind), c.cycle, c.pseudo_channel, c.rank, c.bank_group, c.bank, c.row,
                     c.column);
}

constexpr int index_of(DramEvent event) { return static_cast<int>(event); }

bool is_column(DramEvent event) { return event == DramEvent::kRead || event == DramEvent::kWrite; }

bool precharges(const DramCommand& command) {
  return command.kind == DramCommandKind::kReadPrecharge || command.kind == DramCommandKind::kWritePrecharge;
}

}  // namespace

std::string DramViolation::text() const {
  return fmt::format("{}: {} after {}; {} seen, {} required", rule, text_of(command),
                     before ? text_of(*before) : "nothing", distance, required);
}

const std::vector<std::string>& DramChecker::other_rules() {
  static const std::vector<std::string> names{"order",
                                              "address",
                                              "column beyond the page",
                                              "command bus",
                                              "data bus",
                                              "t_faw",
                                              "ACT to an open bank",
                                              "column of a closed bank",
                                              "column of another row",
                                              "refresh of an open bank",
                                              "refresh of a kind that there is not",
                                              "refresh too late"};
  return names;
}

DramChecker::DramChecker(const DramNumbers& numbers) : numbers_(numbers) {
  for (const DramPairRule& rule : dram_pair_rules(numbers))
    rules_to_[static_cast<std::size_t>(index_of(rule.to))].push_back(rule);
  Rank rank;
  rank.groups.resize(static_cast<std::size_t>(numbers.bank_groups));
  rank.banks.resize(static_cast<std::size_t>(numbers.banks));
  settle_deadline(rank);
  Channel channel;
  channel.ranks.assign(static_cast<std::size_t>(numbers.ranks), rank);
  channels_.assign(static_cast<std::size_t>(numbers.pseudo_channels), channel);
  buses_.resize(2 * channels_.size());
  last_.cycle = kNever;
}

void DramChecker::report(const char* rule, const DramCommand* before, const DramCommand& command,
                         std::int64_t distance, std::int64_t required) {
  ++violation_count_;
  if (violations_.size() >= kKept) return;
  violations_.push_back(
      {rule, before != nullptr ? std::optional(*before) : std::nullopt, command, distance, required});
}

void DramChecker::check(const DramCommand& command) {
  ++commands_;
  if (command.cycle < last_.cycle) report("order", &last_, command, command.cycle - last_.cycle, 0);
  last_ = command;
  bool legal = true;
  check_address(command, legal);
  if (!legal) return;  // there is no bank whose state it could touch
  Channel& channel = channels_[command.pseudo_channel];
  Rank& rank = channel.ranks[command.rank];
  Bank& bank = rank.banks[static_cast<std::size_t>(bank_index(command))];
  const DramEvent event = event_of(command.kind);
  check_bus(command);
  check_pairs(command, event);
  check_deadline(command, rank);
  check_state(command, rank, bank);
  if (is_column(event)) check_data(command, channel);
  record(command, event, command.cycle);
  if (precharges(command)) record(command, DramEvent::kPrecharge, precharge_cycle(command, bank));
}

void DramChecker::check_address(const DramCommand& command, bool& legal) {
  const DramNumbers& n = numbers_;
  legal = command.pseudo_channel < n.pseudo_channels && command.rank < n.ranks &&
          command.bank_group < n.bank_groups && command.bank < n.banks_per_group() && command.row >= 0 &&
          command.row < n.rows;
  if (!legal) report("address", nullptr, command, 0, 0);
}

/// Row commands have a bus of their own with separate_buses; each pseudo-channel has its own unless they are
/// shared.
void DramChecker::check_bus(const DramCommand& command) {
  const bool column = is_column(event_of(command.kind));
  const std::size_t owner = numbers_.shared_commands ? 0 : command.pseudo_channel;
  Bus& bus = buses_[2 * owner + (numbers_.separate_buses && column ? 1 : 0)];
  if (command.cycle < bus.free)
    report("command bus", &bus.command, command, command.cycle - bus.command.cycle,
           bus.free - bus.command.cycle);
  const int slots = column                                       ? numbers_.column_slots
                    : command.kind == DramCommandKind::kActivate ? numbers_.act_slots
                                                                 : 1;
  bus.free = command.cycle + slots;
  bus.command = command;
}

void DramChecker::check_pair(const DramPairRule& rule, const DramCommand& command, const Latest& latest) {
  const std::int64_t distance = command.cycle - latest.cycle;
  if (distance < rule.distance) report(rule.name, &latest.command, command, distance, rule.distance);
}

void DramChecker::check_pairs(const DramCommand& command, DramEvent event) {
  const Channel& channel = channels_[command.pseudo_channel];
  const Rank& rank = channel.ranks[command.rank];
  const auto bank = static_cast<std::size_t>(bank_index(command));
  const std::size_t group = command.bank_group;
  const std::size_t own_rank = command.rank;
  for (const DramPairRule& rule : rules_to_[static_cast<std::size_t>(index_of(event))]) {
    const auto from = static_cast<std::size_t>(index_of(rule.from));
    const auto others = [&](const auto& places, std::size_t own) {
      for (std::size_t i = 0; i < places.size(); ++i)
        if (i != own) check_pair(rule, command, places[i].latest[from]);
    };
    switch (rule.scope) {
      case DramScope::kSameBank: check_pair(rule, command, rank.banks[bank].latest[from]); break;
      case DramScope::kSameGroup: check_pair(rule, command, rank.groups[group].latest[from]); break;
      case DramScope::kSameRank: check_pair(rule, command, rank.latest[from]); break;
      case DramScope::kSameChannel: check_pair(rule, command, channel.latest[from]); break;
      case DramScope::kOtherGroup: others(rank.groups, group); break;
      case DramScope::kOtherBank: others(rank.banks, bank); break;
      case DramScope::kOtherRank: others(channel.ranks, own_rank); break;
    }
  }
}

void DramChecker::check_state(const DramCommand& command, Rank& rank, Bank& bank) {
  switch (command.kind) {
    case DramCommandKind::kActivate:
      if (bank.open)
        report("ACT to an open bank", &bank.latest[index_of(DramEvent::kActivate)].command, command, 0, 0);
      count_activation(command, rank);
      bank.open = true;
      bank.row = command.row;
      break;
    case DramCommandKind::kPrecharge: bank.open = false; break;  // of a closed bank it does nothing
    case DramCommandKind::kRead:
    case DramCommandKind::kWrite: check_column(command, bank); break;
    case DramCommandKind::kReadPrecharge:
    case DramCommandKind::kWritePrecharge:
      check_column(command, bank);
      bank.open = false;
      break;
    case DramCommandKind::kRefresh:
    case DramCommandKind::kRefreshBank: count_refresh(command, rank, bank); break;
  }
}

void DramChecker::check_column(const DramCommand& command, const Bank& bank) {
  if (command.column < 0 || command.column >= numbers_.columns())
    report("column beyond the page", nullptr, command, command.column, numbers_.columns());
  const DramCommand* opened = &bank.latest[index_of(DramEvent::kActivate)].command;
  if (!bank.open) report("column of a closed bank", nullptr, command, 0, 0);
  else if (bank.row != command.row) report("column of another row", opened, command, command.row, bank.row);
}

/// Data in the order of the commands, one burst after the other.
void DramChecker::check_data(const DramCommand& command, Channel& channel) {
  const std::int64_t start =
      command.cycle + (event_of(command.kind) == DramEvent::kRead ? numbers_.t_cas : numbers_.t_cwl);
  if (start < channel.data_end)
    report("data bus", &channel.data_command, command, start - channel.data_end, 0);
  channel.data_end = std::max(channel.data_end, start + numbers_.t_burst);
  channel.data_command = command;
}

void DramChecker::count_activation(const DramCommand& command, Rank& rank) {
  DramCommand& fourth = rank.activations[static_cast<std::size_t>(rank.activation_count % 4)];
  const std::int64_t distance = command.cycle - fourth.cycle;
  if (rank.activation_count >= 4 && distance < numbers_.t_faw)
    report("t_faw", &fourth, command, distance, numbers_.t_faw);
  fourth = command;
  ++rank.activation_count;
}

/// A refresh counts for its banks, up to refresh_postpone of them ahead of time.
void DramChecker::count_refresh(const DramCommand& command, Rank& rank, Bank& bank) {
  const bool all = command.kind == DramCommandKind::kRefresh;
  const bool there_is =
      all ? numbers_.refresh != DramRefreshKind::kNone : numbers_.refresh == DramRefreshKind::kPerBank;
  if (!there_is) report("refresh of a kind that there is not", nullptr, command, 0, 0);
  const std::int64_t most = command.cycle / numbers_.t_refi + numbers_.refresh_postpone;
  for (Bank& each : rank.banks) {
    if (!all && &each != &bank) continue;
    if (each.open)
      report("refresh of an open bank", &each.latest[index_of(DramEvent::kActivate)].command, command, 0, 0);
    each.refreshes = std::max(each.refreshes, std::min(each.refreshes + 1, most));
  }
  settle_deadline(rank);
}

/// The last cycle by which the bank that is furthest behind must be refreshed again.
void DramChecker::settle_deadline(Rank& rank) {
  const auto least = std::min_element(rank.banks.begin(), rank.banks.end(),
                                      [](const Bank& a, const Bank& b) { return a.refreshes < b.refreshes; });
  rank.next_deadline =
      (least->refreshes + numbers_.refresh_postpone + 1) * static_cast<std::int64_t>(numbers_.t_refi);
}

void DramChecker::check_deadline(const DramCommand& command, Rank& rank) {
  while (numbers_.refresh != DramRefreshKind::kNone && command.cycle > rank.next_deadline) {
    report("refresh too late", nullptr, command, command.cycle, rank.next_deadline);
    const std::int64_t met = rank.next_deadline / numbers_.t_refi - numbers_.refresh_postpone;
    for (Bank& bank : rank.banks) bank.refreshes = std::max(bank.refreshes, met);  // said once
    settle_deadline(rank);
  }
}

void DramChecker::finish(std::int64_t cycle) {
  DramCommand end{.cycle = cycle};
  for (std::size_t c = 0; c < channels_.size(); ++c)
    for (std::size_t r = 0; r < channels_[c].ranks.size(); ++r) {
      end.pseudo_channel = static_cast<std::uint8_t>(c);
      end.rank = static_cast<std::uint8_t>(r);
      check_deadline(end, channels_[c].ranks[r]);
    }
}

std::int64_t DramChecker::precharge_cycle(const DramCommand& command, const Bank& bank) const {
  const std::int64_t after_row = bank.latest[index_of(DramEvent::kActivate)].cycle + numbers_.t_ras;
  const bool read = command.kind == DramCommandKind::kReadPrecharge;
  return std::max(
      after_row, command.cycle + (read ? numbers_.t_rtp : numbers_.t_cwl + numbers_.t_burst + numbers_.t_wr));
}

/// Keeps the latest event of each kind at every level. A precharge that comes with a read or write is still
/// to come, so the latest is the greatest cycle.
void DramChecker::record(const DramCommand& command, DramEvent event, std::int64_t cycle) {
  Channel& channel = channels_[command.pseudo_channel];
  Rank& rank = channel.ranks[command.rank];
  const auto keep = [&](LatestOf& latest) {
    Latest& slot = latest[static_cast<std::size_t>(index_of(event))];
    if (cycle >= slot.cycle) slot = {cycle, command};
  };
  keep(channel.latest);
  keep(rank.latest);
  keep(rank.groups[command.bank_group].latest);
  keep(rank.banks[static_cast<std::size_t>(bank_index(command))].latest);
}

}  // namespace quadrille::models
