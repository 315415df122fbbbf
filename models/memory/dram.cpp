#include "models/memory/dram.h"

#include "models/base/error.h"

#include <algorithm>

namespace quadrille::models {

DramChannel::DramChannel(const DramParams& params) : params_(params), banks_(static_cast<std::size_t>(std::max(params.banks, 1))) {
  QUADRILLE_CHECK(params.banks > 0 && params.row_bytes > 0 && params.burst_bytes > 0 && params.t_burst > 0,
                  "banks {} row {} burst {} t_burst {}", params.banks, params.row_bytes, params.burst_bytes, params.t_burst);
}

DramChannel::Place DramChannel::place(std::uint64_t address) const {
  const std::uint64_t row = address / static_cast<std::uint64_t>(params_.row_bytes);
  return {static_cast<std::size_t>(row % banks_.size()), static_cast<std::int64_t>(row / banks_.size())};
}

bool DramChannel::row_open(std::uint64_t address) const {
  const Place at = place(address);
  return banks_[at.bank].row == at.row;
}

DramAccess DramChannel::access(std::uint64_t address, std::uint32_t bytes, bool write, std::int64_t cycle) {
  const Place at = place(address);
  Bank& bank = banks_[at.bank];
  DramAccess result;
  result.row_hit = bank.row == at.row;
  result.row_conflict = !result.row_hit && bank.row >= 0;
  if (!result.row_hit) {
    std::int64_t activate = cycle;
    if (result.row_conflict) activate = std::max(cycle, bank.precharge_ready) + params_.t_rp;
    bank.row = at.row;
    bank.column_ready = activate + params_.t_rcd;
    bank.precharge_ready = activate + params_.t_ras;
  }
  const std::int64_t turnaround = bus_used_ && bus_wrote_ != write ? params_.t_turnaround : 0;
  result.start = std::max(std::max(cycle, bank.column_ready) + params_.t_cas, bus_free_ + turnaround);
  result.command = result.start - params_.t_cas;
  const std::uint32_t burst_bytes = static_cast<std::uint32_t>(params_.burst_bytes);
  const std::int64_t bursts = std::max<std::int64_t>(1, (std::int64_t{bytes} + burst_bytes - 1) / burst_bytes);
  result.done = result.start + bursts * params_.t_burst;

  bank.column_ready = result.command + bursts * params_.t_burst;
  bank.precharge_ready = std::max(bank.precharge_ready, write ? result.done + params_.t_wr : bank.column_ready);
  bus_free_ = result.done;
  bus_wrote_ = write;
  bus_used_ = true;
  return result;
}

}  // namespace quadrille::models
