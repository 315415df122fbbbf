/// Scan-out: reads the finished colour surface through the L2 cache, as a display would, after the colour
/// caches were flushed.
///
/// In    scan_in    show the target of this pass
/// Out   done_out   all of it was read
/// Mem   every line of the surface, in order
/// Time  one line a cycle, up to `lines_in_flight` under way
#pragma once

#include "hw/base/param.h"
#include "hw/frame/frame.h"
#include "hw/frame/unit_context.h"
#include "hw/memory/l1_cache.h"
#include "hw/memory/memory_port.h"

namespace quadrille::hw {

class ScanOut final : public Unit {
 public:
  struct Params : ParamGroup {
    Param<int> lines_in_flight{*this,  "lines_in_flight", 128,
                               "line", {1, 65536},        "Lines under way. [G: bandwidth times latency]"};
  };
  struct Stats : StatGroup {
    Counter lines{*this, "lines", "line", "Lines of 128 bytes read"};
  };
  using CounterParts = Parts<MemoryPortStats, EncodedReadStats>;
  ScanOut(sc_core::sc_module_name name, const UnitContext& context, const Params& params);

  FifoIn<ScanToken> scan_in{*this, "scan_in"};
  FifoOut<ReleaseToken> done_out{*this, "done_out", LinkRole::kReply};

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const Stats* stats() const override { return &stats_; }
  void audit(Audit& audit) const override;
  void details(Details& details) const override;
  [[nodiscard]] std::vector<Facet> row() const override;
  [[nodiscard]] std::string state_text() const override;
  [[nodiscard]] MemoryPort& memory_port() { return port_; }
  static constexpr MemoryClient kMemoryClient = MemoryClient::kScanOut;

 private:
  [[nodiscard]] Wake ask_wake() const;
  void read_next();

  const Params& params_;
  const Frame& frame_;
  const models::DeviceMemory& device_;
  Stats stats_;
  MemoryPort port_;
  EncodedReadStats encoded_;
  bool scanning_ = false;
  std::uint32_t next_line_ = 0, end_line_ = 0;
  std::uint8_t sectors_ = 0xf;  ///< of each line, that hold pixels
  int in_flight_ = 0;
  Tick free_ = 0;
};

}  // namespace quadrille::hw
