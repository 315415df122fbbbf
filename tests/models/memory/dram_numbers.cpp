#include "tests/models/memory/dram_numbers.h"

#include <stdexcept>

namespace quadrille::models {

namespace {

/// The least number of cycles that lasts so long.
constexpr int at_least(std::int64_t picoseconds, int clock_mhz) {
  return static_cast<int>((picoseconds * clock_mhz + 999'999) / 1'000'000);
}

/// The greatest number of cycles that lasts no longer.
constexpr int at_most(std::int64_t picoseconds, int clock_mhz) {
  return static_cast<int>(picoseconds * clock_mhz / 1'000'000);
}

DramNumbers ddr4() {
  constexpr int kClock = 1600;
  const auto ps = [](std::int64_t time) { return at_least(time, kClock); };
  DramNumbers n{
      .clock_mhz = kClock, .pseudo_channels = 1, .ranks = 2, .bank_groups = 4, .banks = 16, .rows = 1 << 16};
  n.row_bytes = 1024 * 8;  // columns of a 64-bit channel
  n.burst_bytes = 8 * 8;
  n.t_burst = 8 / 2;
  n.t_rcd = n.t_rcd_wr = n.t_rp = ps(13'750);  // bin AA
  n.t_ras = ps(32'000);
  n.t_rc = n.t_ras + n.t_rp;
  n.t_cas = 22;
  n.t_cwl = 16;
  n.t_ccd_s = 4;
  n.t_ccd_l = ps(5'000);
  n.t_rrd_s = 4;
  n.t_rrd_l = ps(4'900);
  n.t_faw = ps(21'000);
  n.t_wr = ps(15'000);
  n.t_wtr_s = ps(2'500);
  n.t_wtr_l = ps(7'500);
  n.t_rtp = ps(7'500);
  n.t_rtw = 2;
  n.t_rtrs = 2;
  n.t_refi = at_most(7'800'000, kClock);
  n.t_rfc = ps(350'000);
  n.t_rfc_pb = n.t_rrefd = n.t_refb_refb = 0;
  n.refresh = DramRefreshKind::kAllBank;
  return n;
}

DramNumbers lpddr5() {
  constexpr int kClock = 800;
  const auto ps = [](std::int64_t time) { return at_least(time, kClock); };
  DramNumbers n{
      .clock_mhz = kClock, .pseudo_channels = 2, .ranks = 1, .bank_groups = 4, .banks = 16, .rows = 1 << 15};
  n.row_bytes = 1024 * 2;
  n.burst_bytes = 16 * 2;
  n.t_burst = 16 / 8;
  n.t_rcd = n.t_rcd_wr = n.t_rp = ps(18'000);
  n.t_ras = ps(42'000);
  n.t_rc = ps(60'000);
  n.t_cas = 17;
  n.t_cwl = 9;
  n.t_ccd_s = 2;
  n.t_ccd_l = 4;
  n.t_rrd_s = n.t_rrd_l = ps(5'000);
  n.t_faw = ps(20'000);
  n.t_wr = ps(34'000);
  n.t_wtr_s = ps(6'250);
  // from the end of the four cycles that a burst of one group spans
  n.t_wtr_l = n.t_ccd_l + ps(12'000) - n.t_burst;
  n.t_rtp = ps(7'500);
  n.t_rtw = 2;
  n.t_refi = at_most(3'906'000, kClock);
  n.t_rfc = ps(210'000);
  n.t_rfc_pb = ps(120'000);
  n.t_rrefd = ps(7'500);
  n.t_refb_refb = ps(90'000);  // tpbR2pbR
  n.refresh = DramRefreshKind::kPerBank;
  n.act_slots = 2;  // ACTIVATE-1, ACTIVATE-2
  return n;
}

DramNumbers gddr6() {
  constexpr int kClock = 1000;
  const auto ps = [](std::int64_t time) { return at_least(time, kClock); };
  DramNumbers n{.clock_mhz = kClock, .pseudo_channels = 2, .ranks = 1, .bank_groups = 4, .banks = 16};
  n.rows = 2 << 14;  // twice the 14 row bits of the 8 Gb device
  n.row_bytes = 2048;
  n.burst_bytes = 256 / 8;
  n.t_burst = 16 / 8;
  n.t_rcd = ps(15'000);
  n.t_rcd_wr = ps(9'000);
  n.t_rp = ps(15'000);
  n.t_ras = ps(30'000);
  n.t_rc = ps(45'000);
  n.t_cas = ps(24 * 570);
  n.t_cwl = 5;
  n.t_ccd_s = 2;
  n.t_ccd_l = ps(4 * 570);
  n.t_rrd_s = n.t_rrd_l = ps(4'000);
  n.t_faw = ps(16'000);
  n.t_wr = ps(15'000);
  n.t_wtr_s = ps(5'000);
  n.t_wtr_l = ps(6'000);
  n.t_rtp = 4;
  n.t_rtw = ps(4 * 570);
  n.t_refi = at_most(1'900'000, kClock);
  n.t_rfc = ps(120'000);
  n.t_rfc_pb = ps(60'000);
  n.t_rrefd = ps(8'000);
  n.t_refb_refb = n.t_rrefd;
  n.refresh = DramRefreshKind::kPerBank;
  return n;
}

DramNumbers hbm2() {
  DramNumbers n{.clock_mhz = 1000, .pseudo_channels = 2, .ranks = 1, .bank_groups = 4, .banks = 16};
  n.row_bytes = 1024;
  n.rows = (256 << 20) / (n.banks * n.row_bytes);
  n.burst_bytes = 4 * 8;
  n.t_burst = 4 / 2;
  n.t_rcd = 12;
  n.t_rcd_wr = 6;
  n.t_rp = 14;
  n.t_ras = 28;
  n.t_rc = 42;
  n.t_cas = 17 + 1;
  n.t_cwl = 7;
  n.t_ccd_s = 2;
  n.t_ccd_l = 3;
  n.t_rrd_s = 4;
  n.t_rrd_l = 6;
  n.t_faw = 16;
  n.t_wr = 14;
  n.t_wtr_s = 4;
  n.t_wtr_l = 9;
  n.t_rtp = 5;
  n.t_rtw = 18 - (n.t_cas + n.t_burst - n.t_cwl);
  n.t_refi = 3900;
  n.t_rfc = 220;
  n.t_rfc_pb = 96;
  n.t_rrefd = 8;
  n.t_refb_refb = n.t_rrefd;
  n.refresh = DramRefreshKind::kPerBank;
  n.separate_buses = n.shared_commands = true;
  n.act_slots = 2;
  return n;
}

}  // namespace

DramNumbers dram_numbers(const std::string& standard) {
  if (standard == "ddr4") return ddr4();
  if (standard == "lpddr5") return lpddr5();
  if (standard == "gddr6") return gddr6();
  if (standard == "hbm2") return hbm2();
  throw std::invalid_argument("no DRAM standard '" + standard + "'; there are ddr4, lpddr5, gddr6 and hbm2");
}

const std::vector<std::string>& dram_standards() {
  static const std::vector<std::string> standards{"ddr4", "lpddr5", "gddr6", "hbm2"};
  return standards;
}

const std::vector<DramNumberName>& dram_number_names() {
  using N = DramNumbers;
  static const std::vector<DramNumberName> names{
      {"clock_mhz", &N::clock_mhz}, {"pseudo_channels", &N::pseudo_channels},
      {"ranks", &N::ranks},         {"bank_groups", &N::bank_groups},
      {"banks", &N::banks},         {"rows", &N::rows},
      {"row_bytes", &N::row_bytes}, {"burst_bytes", &N::burst_bytes},
      {"t_burst", &N::t_burst},     {"t_rcd", &N::t_rcd},
      {"t_rcd_wr", &N::t_rcd_wr},   {"t_rp", &N::t_rp},
      {"t_ras", &N::t_ras},         {"t_rc", &N::t_rc},
      {"t_cas", &N::t_cas},         {"t_cwl", &N::t_cwl},
      {"t_ccd_s", &N::t_ccd_s},     {"t_ccd_l", &N::t_ccd_l},
      {"t_rrd_s", &N::t_rrd_s},     {"t_rrd_l", &N::t_rrd_l},
      {"t_faw", &N::t_faw},         {"t_wr", &N::t_wr},
      {"t_wtr_s", &N::t_wtr_s},     {"t_wtr_l", &N::t_wtr_l},
      {"t_rtp", &N::t_rtp},         {"t_rtw", &N::t_rtw},
      {"t_rtrs", &N::t_rtrs},       {"t_refi", &N::t_refi},
      {"t_rfc", &N::t_rfc},         {"t_rfc_pb", &N::t_rfc_pb},
      {"t_rrefd", &N::t_rrefd},     {"refresh_postpone", &N::refresh_postpone},
      {"act_slots", &N::act_slots}, {"column_slots", &N::column_slots},
  };
  return names;
}

}  // namespace quadrille::models
