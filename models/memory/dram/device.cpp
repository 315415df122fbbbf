#include "models/memory/dram/device.h"

#include "models/base/error.h"

#include <immintrin.h>

#include <algorithm>

namespace quadrille::models {

namespace {
constexpr std::size_t kLanes = 4;  // of 64 bits in a vector register

void raise(DramDevice::Cycle& bound, DramDevice::Cycle to) { bound = std::max(bound, to); }
}  // namespace

DramDevice::DramDevice(const DramTiming& timing)
    : t_(timing),
      banks_(static_cast<std::size_t>(timing.all_banks())),
      groups_(static_cast<std::size_t>(timing.ranks * timing.bank_groups)),
      ranks_(static_cast<std::size_t>(timing.ranks)),
      bounds_((kGroupRules * groups_.size() + 1 + kLanes - 1) / kLanes * kLanes, 0) {
  QUADRILLE_CHECK(timing.banks > 0 && timing.bank_groups > 0 && timing.banks % timing.bank_groups == 0 &&
                      timing.ranks > 0 && timing.t_burst > 0,
                  "{} ranks of {} banks in {} groups, burst of {}", timing.ranks, timing.banks,
                  timing.bank_groups, timing.t_burst);
  for (std::uint32_t g = 0; g < groups_.size(); ++g)
    groups_[g].rank = g / static_cast<std::uint32_t>(timing.bank_groups);
  for (std::uint32_t b = 0; b < banks_.size(); ++b) {
    banks_[b].group = b / static_cast<std::uint32_t>(timing.group_banks());
    banks_[b].rank = b / static_cast<std::uint32_t>(timing.banks);
  }
  for (const bool wrote : {false, true}) {
    gaps_[wrote].assign(groups_.size() * bounds_.size(), -(Cycle{1} << 40));
    for (std::uint32_t from = 0; from < groups_.size(); ++from) {
      for (std::uint32_t to = 0; to < groups_.size(); ++to) {
        const Relation is = relation(from, groups_[from].rank, to);
        for (const bool write : {false, true})
          gaps_[wrote][from * bounds_.size() + column_rule(to, write)] = column_gap(wrote, write, is);
      }
    }
  }
}

DramDevice::Cycle DramDevice::column_gap(bool wrote, bool write, Relation to) const {
  const Cycle data_end = data_start(wrote, 0) + t_.t_burst;
  if (to == kOtherRank) {
    const int idle = write && !wrote ? std::max(t_.t_rtrs, t_.t_rtw) : t_.t_rtrs;
    return data_end + idle - data_start(write, 0);
  }
  if (write == wrote) return std::max(to == kSameGroup ? t_.t_ccd_l : t_.t_ccd_s, t_.t_burst);
  if (wrote) return data_end + (to == kSameGroup ? t_.t_wtr_l : t_.t_wtr_s);
  return data_end + t_.t_rtw - t_.t_cwl;
}

DramDevice::Cycle DramDevice::turned(std::uint32_t bank, bool write) const {
  if (!used_ || (write == wrote_ && rank_of(bank) == last_rank_)) return 0;
  return last_command_ + gaps_[wrote_][last_group_ * bounds_.size() + column_rule(group_of(bank), write)];
}

DramDevice::Cycle DramDevice::earliest_refresh(std::uint32_t rank) const {
  Cycle at = ranks_[rank].activate;
  const auto first = static_cast<std::size_t>(rank) * static_cast<std::size_t>(t_.banks);
  for (std::size_t b = first; b < first + static_cast<std::size_t>(t_.banks); ++b)
    raise(at, banks_[b].activate);
  return at;
}

DramDevice::Cycle DramDevice::earliest_refresh_bank(std::uint32_t bank) const {
  const Rank& rank = ranks_[rank_of(bank)];
  return std::max(
      {banks_[bank].activate, groups_[group_of(bank)].activate, rank.activate, rank.refresh_bank});
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
  bound_activates(b.rank);
}

void DramDevice::bound_activates(std::uint32_t rank) {
  const Cycle bound = std::max(ranks_[rank].activate, ranks_[rank].window[ranks_[rank].oldest]);
  const auto groups = static_cast<std::uint32_t>(t_.bank_groups);
  for (std::uint32_t group = rank * groups; group < (rank + 1) * groups; ++group)
    bounds_[activate_rule(group)] = std::max(groups_[group].activate, bound);
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
  const Cycle* gaps = gaps_[write].data() + b.group * bounds_.size();
  const __m256i now = _mm256_set1_epi64x(at);
  for (std::size_t rule = 0; rule < bounds_.size(); rule += kLanes) {
    auto* const bounds = reinterpret_cast<__m256i*>(&bounds_[rule]);
    const __m256i held = _mm256_loadu_si256(bounds);
    const __m256i to =
        _mm256_add_epi64(now, _mm256_loadu_si256(reinterpret_cast<const __m256i*>(gaps + rule)));
    _mm256_storeu_si256(bounds, _mm256_blendv_epi8(held, to, _mm256_cmpgt_epi64(to, held)));
  }
  raise(b.precharge, write ? data_start(true, at) + t_.t_burst + t_.t_wr : at + t_.t_rtp);
  if (precharge_after) precharge(bank, b.precharge);
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
  bound_activates(rank_of(bank));
}

// What columns and activations allow is long past, and stays so.
void DramDevice::delay_refreshes(Cycle cycles) {
  for (Bank& bank : banks_) {
    bank.activate += cycles;
    bank.refreshed += cycles;
  }
  for (Rank& rank : ranks_) {
    rank.activate += cycles;
    rank.refresh_bank += cycles;
  }
  for (std::uint32_t rank = 0; rank < ranks_.size(); ++rank) bound_activates(rank);
}

}  // namespace quadrille::models
