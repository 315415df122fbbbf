/// Which requests a controller considers, one file a policy (scheduler_*.cpp). It names requests; what each
/// needs next (its row closed, opened, a burst moved) and when the rules allow it is the controller's: among
/// what can be done now the oldest request comes first.
#pragma once

#include "models/base/policy.h"
#include "models/memory/dram/device.h"
#include "models/memory/dram/request_queue.h"

#include <array>

namespace quadrille::models {

struct DramView {
  const DramQueue& queue;
  const DramDevice& device;
  bool reads = true, writes = true;  ///< kinds that may be served
  /// The oldest request of each kind (reads, writes) if it waits longer than the age cap, else kNone.
  std::array<std::uint32_t, 2> starving{DramQueue::kNone, DramQueue::kNone};
};

class DramScheduler {
 public:
  virtual ~DramScheduler() = default;
  /// The request of a bank to consider; kNone for none.
  [[nodiscard]] virtual std::uint32_t pick(const DramView& view, std::uint32_t bank) const = 0;
  /// May the bursts of the picked request be moved, or only its row be prepared?
  [[nodiscard]] virtual bool moves(const DramView& /*view*/, std::uint32_t /*request*/) const { return true; }
  /// Does a bank's pick depend on the requests of other banks?
  [[nodiscard]] virtual bool looks_beyond_bank() const = 0;
};

/// Numbers of the machine that schedulers may use.
struct DramSchedulerSetup {
  int in_order_ahead = 0;  ///< `in_order`: requests behind the oldest whose rows are prepared
};
using DramSchedulerPolicy = Policy<DramScheduler, const DramSchedulerSetup&>;
/// What `memory.scheduler` chooses from.
[[nodiscard]] PolicyList<DramSchedulerPolicy>& dram_schedulers();
extern const DramSchedulerPolicy kInOrderScheduler, kFirstReadyScheduler;

}  // namespace quadrille::models
