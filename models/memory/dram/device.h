/// The banks of one pseudo-channel: which rows are open, and the earliest cycle at which each next command
/// keeps the standard's rules.
///
/// A caller asks for the earliest cycle of a command, picks one at or after it and issues it; commands come
/// in order of time. Rules between commands (their names are those of the parameters in timing.h):
///   same bank  ACT -> RD/WR t_rcd, t_rcd_wr; ACT -> PRE t_ras; ACT -> ACT t_rc; PRE -> ACT t_rp;
///              RD -> PRE t_rtp; end of write data -> PRE t_wr
///   same rank  ACT -> ACT t_rrd_l (same group) or t_rrd_s, four within t_faw; RD -> RD, WR -> WR t_ccd_l or
///              t_ccd_s; end of write data -> RD t_wtr_l or t_wtr_s
///   data bus   one burst at a time; t_rtw idle from read to write data, t_rtrs between ranks
///   refresh    all banks of the rank (or the bank) closed and t_rp past; then t_rfc (t_rfc_pb) until the
///              next ACT there, t_rrefd until one elsewhere
/// As public simulators, examples and data sheets have them: [Ramulator 2, DRAMsim3, gem5 LPDDR5, gem5 HBM2,
/// AMD LPDDR5, DRAMSys, Micron GDDR6].
#pragma once

#include "models/memory/dram/timing.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace quadrille::models {

class DramDevice {
 public:
  using Cycle = std::int64_t;
  static constexpr std::int32_t kClosed = -1;

  explicit DramDevice(const DramTiming& timing);

  [[nodiscard]] std::int32_t open_row(std::uint32_t bank) const { return banks_[bank].row; }
  [[nodiscard]] Cycle earliest_activate(std::uint32_t bank) const {
    return std::max(bank_activate(bank), shared_bound(activate_rule(group_of(bank))));
  }
  [[nodiscard]] Cycle earliest_precharge(std::uint32_t bank) const { return banks_[bank].precharge; }
  [[nodiscard]] Cycle earliest_column(std::uint32_t bank, bool write) const {
    return std::max(row_ready(bank, write), shared_bound(column_rule(group_of(bank), write)));
  }
  // The same in two parts, of which the later counts: what the bank allows, and what it shares with others by
  // a rule: the columns and activates of a group, each bound by its rank too. The rule of no group bounds
  // nothing.
  [[nodiscard]] Cycle bank_activate(std::uint32_t bank) const { return banks_[bank].activate; }
  [[nodiscard]] Cycle shared_bound(std::uint32_t rule) const { return bounds_[rule]; }
  [[nodiscard]] const Cycle* shared_bounds() const { return bounds_.data(); }
  [[nodiscard]] static std::uint32_t column_rule(std::uint32_t group, bool write) {
    return kGroupRules * group + (write ? 1 : 0);
  }
  [[nodiscard]] static std::uint32_t activate_rule(std::uint32_t group) { return kGroupRules * group + 2; }
  [[nodiscard]] std::uint32_t no_rule() const { return kGroupRules * groups(); }
  /// Of all ranks.
  [[nodiscard]] std::uint32_t groups() const { return static_cast<std::uint32_t>(groups_.size()); }
  /// The rank's banks are closed.
  [[nodiscard]] Cycle earliest_refresh(std::uint32_t rank) const;
  [[nodiscard]] Cycle earliest_refresh_bank(std::uint32_t bank) const;
  /// When the latest refresh of one bank is over, and the next may begin.
  [[nodiscard]] Cycle refresh_turn(std::uint32_t rank) const { return ranks_[rank].refresh_bank; }

  void activate(std::uint32_t bank, std::int32_t row, Cycle at);
  void precharge(std::uint32_t bank, Cycle at);
  /// A burst of the open row; with `precharge_after` the bank closes itself as soon as it may.
  void column(std::uint32_t bank, bool write, bool precharge_after, Cycle at);
  void refresh(std::uint32_t rank, Cycle at);
  void refresh_bank(std::uint32_t bank, Cycle at);

  /// Rounds of the same refreshes went on for `cycles` more, without any other command: they ended so much
  /// later.
  void delay_refreshes(Cycle cycles);

  /// First cycle of the data of a column command at `at`.
  [[nodiscard]] Cycle data_start(bool write, Cycle at) const { return at + (write ? t_.t_cwl : t_.t_cas); }
  /// First column command that the row's activation allowed.
  [[nodiscard]] Cycle row_ready(std::uint32_t bank, bool write) const {
    return write ? banks_[bank].row_write : banks_[bank].row_read;
  }
  /// First column command that a change of the bus's direction or rank since the last burst allows; 0 without
  /// a change.
  [[nodiscard]] Cycle turned(std::uint32_t bank, bool write) const;
  /// End of the latest refresh that kept the bank closed.
  [[nodiscard]] Cycle refreshed(std::uint32_t bank) const { return banks_[bank].refreshed; }
  [[nodiscard]] std::uint32_t rank_of(std::uint32_t bank) const { return banks_[bank].rank; }
  /// Over all ranks: rank * groups + group.
  [[nodiscard]] std::uint32_t group_of(std::uint32_t bank) const { return banks_[bank].group; }

 private:
  struct Bank {
    std::int32_t row = kClosed;
    Cycle activate = 0, precharge = 0;
    Cycle row_read = 0, row_write = 0;
    Cycle refreshed = 0;
    std::uint32_t group = 0, rank = 0;  ///< over all ranks; of the pseudo-channel
  };
  struct Group {
    std::uint32_t rank = 0;
    Cycle activate = 0;  ///< t_rrd_l
  };
  struct Rank {
    Cycle activate = 0;             ///< t_rrd_s, t_rrefd
    std::array<Cycle, 4> window{};  ///< the last four ACTs plus t_faw
    std::size_t oldest = 0;
    Cycle refresh_bank = 0;  ///< a refresh of one bank ends before the next begins
  };

  static constexpr std::uint32_t kGroupRules = 3;
  enum Relation : std::uint8_t { kSameGroup, kSameRank, kOtherRank, kRelations };
  /// Cycles from a column command to the first one of `write` that it allows.
  [[nodiscard]] Cycle column_gap(bool wrote, bool write, Relation to) const;
  [[nodiscard]] Relation relation(std::uint32_t group, std::uint32_t rank, std::uint32_t other_group) const {
    return group == other_group ? kSameGroup : groups_[other_group].rank == rank ? kSameRank : kOtherRank;
  }
  void bound_activates(std::uint32_t rank);

  DramTiming t_;
  std::vector<Bank> banks_;
  std::vector<Group> groups_;
  std::vector<Rank> ranks_;
  std::vector<Cycle> bounds_;  ///< by rule; filled up to whole vectors
  /// column_gap() of reads and of writes to each rule, one row of rules for each group that the burst is of
  std::array<std::vector<Cycle>, 2> gaps_;
  // The data bus.
  bool used_ = false, wrote_ = false;
  std::uint32_t last_rank_ = 0;
  std::uint32_t last_group_ = 0;
  Cycle last_command_ = 0;
};

}  // namespace quadrille::models
