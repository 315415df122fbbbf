/// The numbers that the checker of DRAM commands goes by: its own table, typed in from the sources and kept
/// apart from the data files that the machine reads (configs/memory), so that a slip in one shows against the
/// other. Times are written as the source has them, in picoseconds or in cycles.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille::models {

enum class DramRefreshKind { kNone, kAllBank, kPerBank };

/// One standard at one speed. Times in cycles of the command clock; the names are those of the data files.
struct DramNumbers {
  int clock_mhz = 1000;
  int pseudo_channels = 1, ranks = 1, bank_groups = 1, banks = 1, rows = 1, row_bytes = 1, burst_bytes = 1;
  int t_burst = 1;
  int t_rcd = 1, t_rcd_wr = 1, t_rp = 1, t_ras = 1, t_rc = 1, t_cas = 1, t_cwl = 1;
  int t_ccd_s = 1, t_ccd_l = 1, t_rrd_s = 1, t_rrd_l = 1, t_faw = 1;
  int t_wr = 1, t_wtr_s = 1, t_wtr_l = 1, t_rtp = 1, t_rtw = 0, t_rtrs = 0;
  int t_refi = 1, t_rfc = 1, t_rfc_pb = 1, t_rrefd = 1;
  /// refresh of one bank to that of another bank; not in the data files, where the model's own rule is at
  /// least as strict
  int t_refb_refb = 1;
  DramRefreshKind refresh = DramRefreshKind::kNone;
  int refresh_postpone = 8;
  bool separate_buses = false, shared_commands = false;
  int act_slots = 1, column_slots = 1;

  int banks_per_group() const { return banks / bank_groups; }
  int columns() const { return row_bytes / burst_bytes; }
};

/// "ddr4", "lpddr5", "gddr6" or "hbm2"; throws std::invalid_argument for another.
DramNumbers dram_numbers(const std::string& standard);

const std::vector<std::string>& dram_standards();

/// A whole number of the table by the name that the data files give it.
struct DramNumberName {
  const char* name;
  int DramNumbers::*member;
};
const std::vector<DramNumberName>& dram_number_names();

}  // namespace quadrille::models
