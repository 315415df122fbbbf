#include "tests/models/memory/dram_checker_cases.h"

namespace quadrille::models::dram_cases {
namespace {

/// The number raised to 20.
std::function<void(DramNumbers&)> twenty(int DramNumbers::*member) {
  return [member](DramNumbers& n) { n.*member = 20; };
}

using N = DramNumbers;

const std::vector<ExactCase>& bank_cases() {
  static const std::vector<ExactCase> cases{
      {"t_rcd: ACT to RD", twenty(&N::t_rcd), {at(0, Kind::kActivate), at(20, Kind::kRead)}},
      {"t_rcd: ACT to RD", twenty(&N::t_rcd), {at(0, Kind::kActivate), at(20, Kind::kReadPrecharge)}},
      {"t_rcd_wr: ACT to WR", twenty(&N::t_rcd_wr), {at(0, Kind::kActivate), at(20, Kind::kWrite)}},
      {"t_rcd_wr: ACT to WR", twenty(&N::t_rcd_wr), {at(0, Kind::kActivate), at(20, Kind::kWritePrecharge)}},
      {"t_ras: ACT to PRE", twenty(&N::t_ras), {at(0, Kind::kActivate), at(20, Kind::kPrecharge)}},
      {"t_rc: ACT to ACT",
       twenty(&N::t_rc),
       {at(0, Kind::kActivate), at(5, Kind::kPrecharge), at(20, Kind::kActivate)}},
      {"t_rp: PRE to ACT",
       twenty(&N::t_rp),
       {at(0, Kind::kActivate), at(5, Kind::kPrecharge), at(25, Kind::kActivate)}},
      {"t_rtp: RD to PRE",
       twenty(&N::t_rtp),
       {at(0, Kind::kActivate), at(3, Kind::kRead), at(23, Kind::kPrecharge)}},
      // The last data of the write end 5 cycles after it.
      {"t_wr: WR to PRE",
       twenty(&N::t_wr),
       {at(0, Kind::kActivate), at(3, Kind::kWrite), at(28, Kind::kPrecharge)}},
      // With a precharge of its own: the read's begins t_rtp after it, or t_ras after the activation, and
      // takes t_rp.
      {"t_rp: PRE to ACT",
       twenty(&N::t_rtp),
       {at(0, Kind::kActivate), at(3, Kind::kReadPrecharge), at(24, Kind::kActivate)}},
      {"t_rp: PRE to ACT",
       twenty(&N::t_ras),
       {at(0, Kind::kActivate), at(3, Kind::kReadPrecharge), at(21, Kind::kActivate)}},
      {"t_rp: PRE to ACT",
       twenty(&N::t_rp),
       {at(0, Kind::kActivate), at(3, Kind::kReadPrecharge), at(24, Kind::kActivate)}},
      {"t_rp: PRE to ACT",
       twenty(&N::t_wr),
       {at(0, Kind::kActivate), at(3, Kind::kWritePrecharge), at(29, Kind::kActivate)}},
      {"t_rp: PRE to ACT",
       twenty(&N::t_ras),
       {at(0, Kind::kActivate), at(3, Kind::kWritePrecharge), at(21, Kind::kActivate)}},
  };
  return cases;
}

const std::vector<ExactCase>& rank_cases() {
  static const std::vector<ExactCase> cases{
      {"t_rrd_l: ACT to ACT in the group",
       twenty(&N::t_rrd_l),
       {at(0, Kind::kActivate), at(20, Kind::kActivate, kBeside)}},
      {"t_rrd_s: ACT to ACT of another group",
       twenty(&N::t_rrd_s),
       {at(0, Kind::kActivate), at(20, Kind::kActivate, kGroup)}},
      {"t_faw",
       twenty(&N::t_faw),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kBeside), at(2, Kind::kActivate, kGroup),
        at(3, Kind::kActivate, kGroupBeside), at(4, Kind::kPrecharge), at(20, Kind::kActivate)}},
      {"t_ccd_l: RD to RD in the group",
       twenty(&N::t_ccd_l),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kBeside), at(5, Kind::kRead),
        at(25, Kind::kRead, kBeside)}},
      {"t_ccd_l: RD to RD in the group",
       twenty(&N::t_ccd_l),
       {at(0, Kind::kActivate), at(5, Kind::kRead), at(25, Kind::kRead)}},
      {"t_ccd_s: RD to RD of another group",
       twenty(&N::t_ccd_s),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kGroup), at(5, Kind::kRead),
        at(25, Kind::kRead, kGroup)}},
      {"t_ccd_l: WR to WR in the group",
       twenty(&N::t_ccd_l),
       {at(0, Kind::kActivate), at(5, Kind::kWrite), at(25, Kind::kWrite)}},
      {"t_ccd_s: WR to WR of another group",
       twenty(&N::t_ccd_s),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kGroup), at(5, Kind::kWrite),
        at(25, Kind::kWrite, kGroup)}},
      // Write data end 5 cycles after the command.
      {"t_wtr_l: WR to RD in the group",
       twenty(&N::t_wtr_l),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kBeside), at(5, Kind::kWrite),
        at(30, Kind::kRead, kBeside)}},
      {"t_wtr_s: WR to RD of another group",
       twenty(&N::t_wtr_s),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kGroup), at(5, Kind::kWrite),
        at(30, Kind::kRead, kGroup)}},
  };
  return cases;
}

const std::vector<ExactCase>& bus_cases() {
  const auto late_reads = [](DramNumbers& n) {
    n.t_cas = 23;
  };  // their data 20 cycles after the command's own place among writes
  static const std::vector<ExactCase> cases{
      // Read data of cycle 9, 20 idle ones, write data of 30.
      {"t_rtw: RD to WR",
       twenty(&N::t_rtw),
       {at(0, Kind::kActivate), at(5, Kind::kRead), at(26, Kind::kWrite)}},
      {"t_rtw: RD to WR",
       twenty(&N::t_rtw),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kRank), at(5, Kind::kRead),
        at(26, Kind::kWrite, kRank)}},
      {"t_rtrs: RD to RD of another rank",
       twenty(&N::t_rtrs),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kRank), at(5, Kind::kRead),
        at(26, Kind::kRead, kRank)}},
      {"t_rtrs: WR to WR of another rank",
       twenty(&N::t_rtrs),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kRank), at(5, Kind::kWrite),
        at(26, Kind::kWrite, kRank)}},
      {"t_rtrs: RD to WR of another rank",
       twenty(&N::t_rtrs),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kRank), at(5, Kind::kRead),
        at(26, Kind::kWrite, kRank)}},
      {"t_rtrs: WR to RD of another rank",
       twenty(&N::t_rtrs),
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kRank), at(5, Kind::kWrite),
        at(26, Kind::kRead, kRank)}},
      // The columns may follow each cycle, their data not.
      {"data bus", twenty(&N::t_burst), {at(0, Kind::kActivate), at(5, Kind::kRead), at(25, Kind::kRead)}},
      {"data bus", twenty(&N::t_burst), {at(0, Kind::kActivate), at(5, Kind::kWrite), at(25, Kind::kWrite)}},
      {"t_rtw: RD to WR", late_reads, {at(0, Kind::kActivate), at(5, Kind::kRead), at(25, Kind::kWrite)}},
      {"command bus", twenty(&N::act_slots), {at(0, Kind::kActivate), at(20, Kind::kActivate, kGroup)}},
      {"command bus",
       twenty(&N::column_slots),
       {at(0, Kind::kActivate), at(5, Kind::kRead), at(25, Kind::kPrecharge)}},
      {"command bus",
       [](DramNumbers& n) { n.t_rrd_s = 0; },
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kGroup)}},
      {"command bus",
       [](DramNumbers& n) { n.shared_commands = true; },
       {at(0, Kind::kActivate), at(5, Kind::kActivate, kChannel), at(6, Kind::kPrecharge)}},
      {"command bus",
       [](DramNumbers& n) {
         n.shared_commands = n.separate_buses = true;
         n.column_slots = 20;
       },
       {at(0, Kind::kActivate), at(1, Kind::kActivate, kChannel), at(5, Kind::kRead),
        at(25, Kind::kRead, kChannel)}},
      {"order",
       [](DramNumbers& n) { n.separate_buses = true; },
       {at(0, Kind::kActivate), at(5, Kind::kRead), at(5, Kind::kActivate, kRank)}},
  };
  return cases;
}

const std::vector<ExactCase>& refresh_cases() {
  static const std::vector<ExactCase> cases{
      {"t_rc: ACT to REF",
       twenty(&N::t_rc),
       {at(0, Kind::kActivate), at(5, Kind::kPrecharge), at(20, Kind::kRefresh)}},
      {"t_rp: PRE to REF",
       twenty(&N::t_rp),
       {at(0, Kind::kActivate, kGroup), at(5, Kind::kPrecharge, kGroup), at(25, Kind::kRefresh)}},
      {"t_rp: PRE to REF",
       twenty(&N::t_rp),
       {at(0, Kind::kActivate, kGroup), at(5, Kind::kReadPrecharge, kGroup), at(26, Kind::kRefresh)}},
      {"t_rfc: REF to ACT", twenty(&N::t_rfc), {at(0, Kind::kRefresh), at(20, Kind::kActivate, kGroup)}},
      {"t_rfc: REF to REF", twenty(&N::t_rfc), {at(0, Kind::kRefresh), at(20, Kind::kRefresh)}},
      {"t_rfc: REF to REFpb", twenty(&N::t_rfc), {at(0, Kind::kRefresh), at(20, Kind::kRefreshBank, kGroup)}},
      {"t_rc: ACT to REFpb",
       twenty(&N::t_rc),
       {at(0, Kind::kActivate), at(5, Kind::kPrecharge), at(20, Kind::kRefreshBank)}},
      {"t_rp: PRE to REFpb",
       twenty(&N::t_rp),
       {at(0, Kind::kActivate), at(5, Kind::kPrecharge), at(25, Kind::kRefreshBank)}},
      {"t_rfc_pb: REFpb to ACT", twenty(&N::t_rfc_pb), {at(0, Kind::kRefreshBank), at(20, Kind::kActivate)}},
      {"t_rfc_pb: REFpb to REFpb",
       twenty(&N::t_rfc_pb),
       {at(0, Kind::kRefreshBank), at(20, Kind::kRefreshBank)}},
      {"t_rfc_pb: REFpb to REF",
       twenty(&N::t_rfc_pb),
       {at(0, Kind::kRefreshBank, kGroup), at(20, Kind::kRefresh)}},
      {"t_rrefd: REFpb to ACT of another bank",
       twenty(&N::t_rrefd),
       {at(0, Kind::kRefreshBank), at(20, Kind::kActivate, kBeside)}},
      {"REFpb to REFpb of another bank",
       twenty(&N::t_refb_refb),
       {at(0, Kind::kRefreshBank), at(20, Kind::kRefreshBank, kGroup)}},
      {"t_rrd_l: ACT to REFpb in the group",
       twenty(&N::t_rrd_l),
       {at(0, Kind::kActivate), at(20, Kind::kRefreshBank, kBeside)}},
      {"t_rrd_s: ACT to REFpb of another group",
       twenty(&N::t_rrd_s),
       {at(0, Kind::kActivate), at(20, Kind::kRefreshBank, kGroup)}},
  };
  return cases;
}

}  // namespace

DramNumbers toy() {
  DramNumbers n{.pseudo_channels = 2,
                .ranks = 2,
                .bank_groups = 2,
                .banks = 4,
                .rows = 16,
                .row_bytes = 256,
                .burst_bytes = 32};
  n.t_cas = n.t_cwl = 4;
  n.t_wtr_s = n.t_wtr_l = 0;
  n.t_wr = 0;
  n.t_refi = 1000;
  n.refresh = DramRefreshKind::kPerBank;
  return n;
}

const std::vector<StateCase>& state_cases() {
  static const std::vector<StateCase> cases{
      {"ACT to an open bank",
       {at(0, Kind::kActivate), at(9, Kind::kActivate, kHere, 1)},
       {at(0, Kind::kActivate), at(5, Kind::kPrecharge), at(9, Kind::kActivate, kHere, 1)}},
      {"column of a closed bank", {at(0, Kind::kRead)}, {at(0, Kind::kActivate), at(9, Kind::kRead)}},
      {"column of a closed bank",
       {at(0, Kind::kActivate), at(9, Kind::kWrite, kBeside)},
       {at(0, Kind::kActivate), at(9, Kind::kWrite)}},
      {"column of a closed bank",
       {at(0, Kind::kActivate), at(5, Kind::kReadPrecharge), at(9, Kind::kRead)},
       {at(0, Kind::kActivate), at(5, Kind::kRead), at(9, Kind::kReadPrecharge)}},
      {"column of another row",
       {at(0, Kind::kActivate, kHere, 3), at(9, Kind::kRead, kHere, 2)},
       {at(0, Kind::kActivate, kHere, 3), at(9, Kind::kRead, kHere, 3)}},
      {"column beyond the page",
       {at(0, Kind::kActivate), at(9, Kind::kRead, kHere, 0, 8)},
       {at(0, Kind::kActivate), at(9, Kind::kRead, kHere, 0, 7)}},
      {"column beyond the page",
       {at(0, Kind::kActivate), at(9, Kind::kWrite, kHere, 0, -1)},
       {at(0, Kind::kActivate), at(9, Kind::kWrite)}},
      {"address", {at(0, Kind::kActivate, kHere, 16)}, {at(0, Kind::kActivate, kHere, 15)}},
      {"address", {at(0, Kind::kActivate, {.bank = 2})}, {at(0, Kind::kActivate, {.bank = 1})}},
      {"address", {at(0, Kind::kActivate, {.group = 2})}, {at(0, Kind::kActivate, {.group = 1})}},
      {"address", {at(0, Kind::kActivate, {.rank = 2})}, {at(0, Kind::kActivate, {.rank = 1})}},
      {"address", {at(0, Kind::kActivate, {.channel = 2})}, {at(0, Kind::kActivate, {.channel = 1})}},
      {"refresh of an open bank",
       {at(0, Kind::kActivate, kGroup), at(9, Kind::kRefresh)},
       {at(0, Kind::kActivate, kRank), at(9, Kind::kRefresh)}},
      {"refresh of an open bank",
       {at(0, Kind::kActivate), at(9, Kind::kRefreshBank)},
       {at(0, Kind::kActivate), at(9, Kind::kRefreshBank, kGroup)}},
  };
  return cases;
}

std::vector<ExactCase> exact_cases() {
  std::vector<ExactCase> all;
  for (const auto* cases : {&bank_cases(), &rank_cases(), &bus_cases(), &refresh_cases()})
    all.insert(all.end(), cases->begin(), cases->end());
  return all;
}

}  // namespace quadrille::models::dram_cases
