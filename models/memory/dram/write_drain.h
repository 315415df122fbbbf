/// When writes are served, one file a policy (write_drain_*.cpp): always, or kept back and drained in runs so
/// that the data bus seldom turns around.
#pragma once

#include "models/base/policy.h"
#include "models/memory/dram/request_queue.h"

namespace quadrille::models {

class DramWriteDrain {
 public:
  virtual ~DramWriteDrain() = default;
  /// Looks at what waits; before reads() and writes().
  virtual void update(const DramQueue& queue) = 0;
  /// Requests of this kind may be served.
  [[nodiscard]] bool reads() const { return reads_; }
  [[nodiscard]] bool writes() const { return writes_; }

 protected:
  bool reads_ = true, writes_ = false;
};

/// Marks are of the pseudo-channel's share of the queue.
struct DramWriteDrainSetup {
  int high = 1, low = 0;
};
using DramWriteDrainPolicy = Policy<DramWriteDrain, const DramWriteDrainSetup&>;
/// What `memory.write_drain` chooses from.
[[nodiscard]] PolicyList<DramWriteDrainPolicy>& dram_write_drains();
extern const DramWriteDrainPolicy kNoWriteDrain, kWatermarkWriteDrain;

}  // namespace quadrille::models
