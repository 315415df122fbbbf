/// What a kind of DRAM is: its geometry and its least times, in cycles of its command clock. Names are those
/// of the JEDEC standards, which define them; the values of each kind are in configs/memory/.
#pragma once

#include <cstdint>
#include <initializer_list>

namespace quadrille::models {

enum class DramRefresh { kNone, kAllBank, kPerBank };

struct DramTiming {
  int pseudo_channels = 1;                     ///< independent data buses behind one controller
  int ranks = 1, bank_groups = 4, banks = 16;  ///< banks of a rank, in all its groups
  int rows = 16384, row_bytes = 2048;          ///< of a bank
  /// bytes of a column command, and how long they hold the data bus
  int burst_bytes = 32, t_burst = 2;
  int t_rcd = 14, t_rcd_wr = 14, t_rp = 14, t_ras = 28, t_rc = 42;
  int t_cas = 14, t_cwl = 6;
  int t_ccd_s = 2, t_ccd_l = 2, t_rrd_s = 4, t_rrd_l = 4, t_faw = 16;
  int t_wr = 15, t_wtr_s = 5, t_wtr_l = 5, t_rtp = 2, t_rtw = 2, t_rtrs = 2;
  DramRefresh refresh = DramRefresh::kNone;
  int t_refi = 3900, t_rfc = 260, t_rfc_pb = 130, t_rrefd = 8, refresh_postpone = 8;
  bool separate_buses = false, shared_commands = false;
  int act_slots = 1, column_slots = 1;

  [[nodiscard]] int all_banks() const { return ranks * banks; }
  [[nodiscard]] int group_banks() const { return banks / bank_groups; }
  /// No command bounds another one for more cycles than this. A refresh does, where it is longer.
  [[nodiscard]] std::int64_t longest() const {
    std::int64_t sum = t_burst;
    for (const int time :
         {t_rcd,   t_rcd_wr, t_rp, t_ras,   t_rc,    t_cas, t_cwl, t_ccd_s, t_ccd_l,   t_rrd_s,
          t_rrd_l, t_faw,    t_wr, t_wtr_s, t_wtr_l, t_rtp, t_rtw, t_rtrs,  act_slots, column_slots})
      sum += time;
    return sum;
  }
  [[nodiscard]] int row_bursts() const { return row_bytes / burst_bytes; }
};

}  // namespace quadrille::models
