/// Memory channel: a DRAM channel behind one L2 slice, its controller in order of arrival.
///
/// In    request_in    reads and writes of sectors of a line       Out   response_out  the sectors of a read
/// Time  the DRAM's (models/memory/dram.h): rows, banks and the data bus; up to `queue_depth` accesses under way
/// Not modelled: refresh, reordering for row hits (docs/deviations.md#D6)
#pragma once

#include "hw/base/param.h"
#include "hw/base/queue.h"
#include "hw/base/unit.h"
#include "hw/frame/tokens.h"
#include "models/memory/dram.h"

namespace quadrille::hw {

class MemoryChannel final : public Unit {
 public:
  struct Params : ParamGroup {
    Param<int> banks{*this, "banks", 16, "bank", {1, 1024}, "Banks. [G: GDDR6 class]"};
    Param<int> row_bytes{*this, "row_bytes", 2048, "byte", {128, 1 << 20}, "Bytes of an open row. [G]"};
    Param<int> t_rcd{*this, "t_rcd", 14, "clk", {0, 1 << 20}, "Activate to column command. [G]"};
    Param<int> t_rp{*this, "t_rp", 14, "clk", {0, 1 << 20}, "Precharge. [G]"};
    Param<int> t_cas{*this, "t_cas", 14, "clk", {0, 1 << 20}, "Column command to data. [G]"};
    Param<int> t_burst{*this, "t_burst", 1, "clk", {1, 1 << 20}, "Data bus cycles of a 32-byte sector: 1 is 32 bytes a cycle. [G]"};
    Param<int> queue_depth{*this, "queue_depth", 32, "access", {1, 4096}, "Accesses under way. [G]"};
    Param<int> path_clk{*this, "path_clk",   60,
                        "clk", {0, 1 << 20}, "Controller and wires, added to each answer. [G: about 100 ns idle latency in all]"};
  };
  struct Stats : StatGroup {
    Counter reads{*this, "reads", "access", "Reads"};
    Counter writes{*this, "writes", "access", "Writes"};
    Counter read_bytes{*this, "read_bytes", "byte", "Bytes read"};
    Counter write_bytes{*this, "write_bytes", "byte", "Bytes written"};
    Counter row_hits{*this, "row_hits", "access", "Accesses to an open row"};
    Counter row_conflicts{*this, "row_conflicts", "access", "Accesses that had to close another row"};
    Counter bus_busy{*this, "bus_busy", "clk", "Cycles the data bus moved data"};
  };
  MemoryChannel(sc_core::sc_module_name name, const Params& params, const Clock& clock, int channels);

  FifoIn<MemoryRequest> request_in{*this, "request_in"};
  FifoOut<MemoryResponse> response_out{*this, "response_out", LinkRole::kReply};

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const StatGroup* stats() const override { return &stats_; }
  [[nodiscard]] std::string state_text() const override;

 private:
  struct Access {
    Tick done = 0;
    MemoryResponse answer;
    bool write = false;
  };
  [[nodiscard]] Wake take_wake() const;
  [[nodiscard]] Wake finish_wake() const;
  void take(Tick now);

  const Params& params_;
  const std::uint32_t channels_;
  Stats stats_;
  models::DramChannel dram_;
  Queue<Access> under_way_;  ///< in order of completion
  Tick free_ = 0;
};

}  // namespace quadrille::hw
