/// One DRAM channel: banks with open rows, and a data bus. Says when an access's data moves; refresh is left out (docs/deviations.md).
///
/// A column command needs its row open: a closed bank is activated (t_rcd), another row is first precharged (t_rp, and no sooner than
/// t_ras after its activation and t_wr after its last write). Data follow t_cas later and hold the bus for t_burst a burst; changing the
/// bus's direction costs t_turnaround. Banks overlap; the bus does not. [P: Rixner et al., Memory Access Scheduling, ISCA 2000, for the
/// bank model]
#pragma once

#include <cstdint>
#include <vector>

namespace quadrille::models {

/// All times in cycles of the channel's clock.
struct DramParams {
  int banks = 16;
  int row_bytes = 2048;
  int burst_bytes = 32;
  int t_rcd = 14, t_rp = 14, t_cas = 14, t_ras = 32, t_wr = 15;
  int t_burst = 2;
  int t_turnaround = 4;
};

struct DramAccess {
  std::int64_t command = 0;   ///< column command: read or write
  std::int64_t start = 0;     ///< first data on the bus
  std::int64_t done = 0;      ///< bus free again, all data moved
  bool row_hit = false;       ///< the row was open
  bool row_conflict = false;  ///< another row was open and had to be closed
};

class DramChannel {
 public:
  explicit DramChannel(const DramParams& params);
  /// One access of `bytes` bytes (rounded up to bursts, within one row) at `address`, the channel's own contiguous address space; not
  /// before `cycle`. Rows are interleaved over banks. Calls are in the order in which the controller issues them.
  DramAccess access(std::uint64_t address, std::uint32_t bytes, bool write, std::int64_t cycle);
  /// Would an access hit an open row now? For a controller that picks row hits first.
  [[nodiscard]] bool row_open(std::uint64_t address) const;
  /// First cycle at which the data bus is free.
  [[nodiscard]] std::int64_t bus_free() const { return bus_free_; }

 private:
  struct Bank {
    std::int64_t row = -1;          // -1: closed
    std::int64_t column_ready = 0;  // earliest next column command to the open row
    std::int64_t precharge_ready = 0;
  };
  struct Place {
    std::size_t bank;
    std::int64_t row;
  };
  [[nodiscard]] Place place(std::uint64_t address) const;

  DramParams params_;
  std::vector<Bank> banks_;
  std::int64_t bus_free_ = 0;
  bool bus_wrote_ = false, bus_used_ = false;
};

}  // namespace quadrille::models
