#include "tests/models/memory/dram_rules.h"

#include <algorithm>

namespace quadrille::models {

namespace {

using Rules = std::vector<DramPairRule>;
constexpr auto kAct = DramEvent::kActivate;
constexpr auto kPre = DramEvent::kPrecharge;
constexpr auto kRd = DramEvent::kRead;
constexpr auto kWr = DramEvent::kWrite;
constexpr auto kRef = DramEvent::kRefresh;
constexpr auto kRefBank = DramEvent::kRefreshBank;

void add_bank_rules(const DramNumbers& n, Rules& rules) {
  constexpr auto kBank = DramScope::kSameBank;
  const std::int64_t write_end = n.t_cwl + n.t_burst;
  rules.insert(rules.end(), {
                                {"t_rcd: ACT to RD", kAct, kRd, kBank, n.t_rcd},
                                {"t_rcd_wr: ACT to WR", kAct, kWr, kBank, n.t_rcd_wr},
                                {"t_ras: ACT to PRE", kAct, kPre, kBank, n.t_ras},
                                {"t_rc: ACT to ACT", kAct, kAct, kBank, n.t_rc},
                                {"t_rp: PRE to ACT", kPre, kAct, kBank, n.t_rp},
                                {"t_rtp: RD to PRE", kRd, kPre, kBank, n.t_rtp},
                                {"t_wr: WR to PRE", kWr, kPre, kBank, write_end + n.t_wr},
                            });
}

void add_rank_rules(const DramNumbers& n, Rules& rules) {
  constexpr auto kGroup = DramScope::kSameGroup;
  constexpr auto kOther = DramScope::kOtherGroup;
  const std::int64_t write_end = n.t_cwl + n.t_burst;
  rules.insert(rules.end(),
               {
                   {"t_rrd_l: ACT to ACT in the group", kAct, kAct, kGroup, n.t_rrd_l},
                   {"t_rrd_s: ACT to ACT of another group", kAct, kAct, kOther, n.t_rrd_s},
                   {"t_ccd_l: RD to RD in the group", kRd, kRd, kGroup, n.t_ccd_l},
                   {"t_ccd_s: RD to RD of another group", kRd, kRd, kOther, n.t_ccd_s},
                   {"t_ccd_l: WR to WR in the group", kWr, kWr, kGroup, n.t_ccd_l},
                   {"t_ccd_s: WR to WR of another group", kWr, kWr, kOther, n.t_ccd_s},
                   {"t_wtr_l: WR to RD in the group", kWr, kRd, kGroup, write_end + n.t_wtr_l},
                   {"t_wtr_s: WR to RD of another group", kWr, kRd, kOther, write_end + n.t_wtr_s},
               });
}

/// Who follows whom on the data bus of a pseudo-channel.
void add_bus_rules(const DramNumbers& n, Rules& rules) {
  constexpr auto kOther = DramScope::kOtherRank;
  rules.insert(
      rules.end(),
      {
          {"t_rtw: RD to WR", kRd, kWr, DramScope::kSameChannel, n.t_cas + n.t_burst + n.t_rtw - n.t_cwl},
          {"t_rtrs: RD to RD of another rank", kRd, kRd, kOther, n.t_burst + n.t_rtrs},
          {"t_rtrs: WR to WR of another rank", kWr, kWr, kOther, n.t_burst + n.t_rtrs},
          {"t_rtrs: RD to WR of another rank", kRd, kWr, kOther, n.t_cas + n.t_burst + n.t_rtrs - n.t_cwl},
          {"t_rtrs: WR to RD of another rank", kWr, kRd, kOther, n.t_cwl + n.t_burst + n.t_rtrs - n.t_cas},
      });
}

void add_refresh_rules(const DramNumbers& n, Rules& rules) {
  constexpr auto kRank = DramScope::kSameRank;
  constexpr auto kBank = DramScope::kSameBank;
  constexpr auto kOther = DramScope::kOtherBank;
  rules.insert(
      rules.end(),
      {
          {"t_rc: ACT to REF", kAct, kRef, kRank, n.t_rc},
          {"t_rp: PRE to REF", kPre, kRef, kRank, n.t_rp},
          {"t_rfc: REF to ACT", kRef, kAct, kRank, n.t_rfc},
          {"t_rfc: REF to REF", kRef, kRef, kRank, n.t_rfc},
          {"t_rfc: REF to REFpb", kRef, kRefBank, kRank, n.t_rfc},
          {"t_rc: ACT to REFpb", kAct, kRefBank, kBank, n.t_rc},
          {"t_rp: PRE to REFpb", kPre, kRefBank, kBank, n.t_rp},
          {"t_rfc_pb: REFpb to ACT", kRefBank, kAct, kBank, n.t_rfc_pb},
          {"t_rfc_pb: REFpb to REFpb", kRefBank, kRefBank, kBank, n.t_rfc_pb},
          {"t_rfc_pb: REFpb to REF", kRefBank, kRef, kRank, n.t_rfc_pb},
          {"t_rrefd: REFpb to ACT of another bank", kRefBank, kAct, kOther, n.t_rrefd},
          {"REFpb to REFpb of another bank", kRefBank, kRefBank, kOther, n.t_refb_refb},
          {"t_rrd_l: ACT to REFpb in the group", kAct, kRefBank, DramScope::kSameGroup, n.t_rrd_l},
          {"t_rrd_s: ACT to REFpb of another group", kAct, kRefBank, DramScope::kOtherGroup, n.t_rrd_s},
      });
}

}  // namespace

std::vector<DramPairRule> dram_pair_rules(const DramNumbers& numbers) {
  Rules rules;
  add_bank_rules(numbers, rules);
  add_rank_rules(numbers, rules);
  add_bus_rules(numbers, rules);
  add_refresh_rules(numbers, rules);
  std::erase_if(rules, [](const DramPairRule& rule) { return rule.distance <= 0; });
  return rules;
}

}  // namespace quadrille::models
