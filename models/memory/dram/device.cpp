#include "models/memory/dram/device.h"

#include "models/base/error.h"

#include <algorithm>

namespace quadrille::models {

namespace {
void raise(DramDevice::Cycle& bound, DramDevice::Cycle to) { bound = std::max(bound, to); }
}  // namespace

DramDevice::DramDevice(const DramTiming& timing)
    : t_(timing),
      banks_(static_cast<std::size_t>(timing.all_banks())),
      groups_(static_cast<std::size_t>(timing.ranks * timing.bank_groups)),
      ranks_(static_cast<std::size_t>(timing.ranks)) {
  QUADRILLE_CHECK(
      timing.banks > 0 && timing.bank_groups > 0 && timing.banks % timing.bank_groups == 0 && timing.ranks > 0 && timing.t_burst > 0,
      "{} ranks of {} banks in {} groups, burst of {}", timing.ranks, timing.banks, timing.bank_groups, timing.t_burst);
  for (std::uint32_t g = 0; g < groups_.size(); ++g) groups_[g].rank = g / static_cast<std::uint32_t>(timing.bank_groups);
  for (std::uint32_t b = 0; b < banks_.size(); ++b) {
    banks_[b].group = b / static_cast<std::uint32_t>(timing.group_banks());
    banks_[b].rank = b / static_cast<std::uint32_t>(timing.banks);
  }
}

DramDevice::Cycle DramDevice::turned(std::uint32_t bank, bool write) const {
  if (!used_) return 0;
  const std::uint32_t rank = rank_of(bank);
  if (write == wrote_ && rank == last_rank_) return 0;
  return after_burst(rank, group_of(bank), write);
}

DramDevice::Cycle DramDevice::after_burst(std::uint32_t rank, std::uint32_t group, bool write) const {
  if (rank == last_rank_) {
    if (write == wrote_) return last_command_ + std::max(group == last_group_ ? t_.t_ccd_l : t_.t_ccd_s, t_.t_burst);
    if (wrote_) return data_end_ + (group == last_group_ ? t_.t_wtr_l : t_.t_wtr_s);
    return data_end_ + t_.t_rtw - t_.t_cwl;
  }
  const int idle = write && !wrote_ ? std::max(t_.t_rtrs, t_.t_rtw) : t_.t_rtrs;
  return data_end_ + idle - (write ? t_.t_cwl : t_.t_cas);
}

DramDevice::Cycle DramDevice::earliest_refresh(std::uint32_t rank) const {
  Cycle at = ranks_[rank].activate;
  const auto first = static_cast<std::size_t>(rank) * static_cast<std::size_t>(t_.banks);
  for (std::size_t b = first; b < first + static_cast<std::size_t>(t_.banks); ++b) raise(at, banks_[b].activate);
  return at;
}

DramDevice::Cycle DramDevice::earliest_refresh_bank(std::uint32_t bank) const {
  const Rank& rank = ranks_[rank_of(bank)];
  return std::max({banks_[bank].activate, groups_[group_of(bank)].activate, rank.activate, rank.refresh_bank});
}

void DramDevice::activate(std::uint32_t bank, std::int32_t row, Cycle at) {
  Bank& b = banks_[bank];
  b.row = row;
  b.row_read = at + t_.t_rcd;
  b.row_write = at + t_.t_rcd_wr;
  raise(b.precharge, at + t_.t_ras);
  raise(b.activate, at + t_.t_rc);
  raise(groups_[group_of(bank)].activate, at + t_.t_rrd_l);
  Rank& rank = ranks_[rank_of(bank)];
  raise(rank.activate, at + t_.t_rrd_s);
  rank.window[rank.oldest] = at + t_.t_faw;
  rank.oldest = (rank.oldest + 1) % rank.window.size();
}

void DramDevice::precharge(std::uint32_t bank, Cycle at) {
  banks_[bank].row = kClosed;
  raise(banks_[bank].activate, at + t_.t_rp);
}

void DramDevice::column(std::uint32_t bank, bool write, bool precharge_after, Cycle at) {
  Bank& b = banks_[bank];
  used_ = true;
  wrote_ = write;
  last_rank_ = b.rank;
  last_group_ = b.group;
  last_command_ = at;
  data_end_ = data_start(write, at) + t_.t_burst;
  const auto groups = static_cast<std::uint32_t>(t_.bank_groups);
  const std::uint32_t first = b.rank * groups, neighbour = groups > 1 ? (b.group == first ? first + 1 : first) : b.group;
  for (const bool kind : {false, true}) {
    const Cycle elsewhere = after_burst(b.rank, neighbour, kind);
    for (std::uint32_t group = first; group < first + groups; ++group) raise(groups_[group].column[kind], elsewhere);
    raise(groups_[b.group].column[kind], after_burst(b.rank, b.group, kind));
  }
  if (t_.ranks > 1) bound_other_ranks(b.rank);
  raise(b.precharge, write ? data_end_ + t_.t_wr : at + t_.t_rtp);
  if (precharge_after) precharge(bank, b.precharge);
}

void DramDevice::bound_other_ranks(std::uint32_t rank) {
  const auto groups = static_cast<std::uint32_t>(t_.bank_groups);
  for (std::uint32_t group = 0; group < groups_.size(); ++group) {
    if (group / groups == rank) continue;
    for (const bool kind : {false, true}) raise(groups_[group].column[kind], after_burst(group / groups, group, kind));
  }
}

void DramDevice::refresh(std::uint32_t rank, Cycle at) {
  const auto first = static_cast<std::size_t>(rank) * static_cast<std::size_t>(t_.banks);
  for (std::size_t b = first; b < first + static_cast<std::size_t>(t_.banks); ++b) {
    raise(banks_[b].activate, at + t_.t_rfc);
    banks_[b].refreshed = at + t_.t_rfc;
  }
}

void DramDevice::refresh_bank(std::uint32_t bank, Cycle at) {
  raise(banks_[bank].activate, at + t_.t_rfc_pb);
  banks_[bank].refreshed = at + t_.t_rfc_pb;
  Rank& rank = ranks_[rank_of(bank)];
  raise(rank.activate, at + t_.t_rrefd);
  raise(rank.refresh_bank, at + t_.t_rfc_pb);
}

}  // namespace quadrille::models
