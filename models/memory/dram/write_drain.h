/// When writes are served: always, or kept back and drained in runs so that the data bus seldom turns around.
///
/// Marks are of the pseudo-channel's share of the queue.
/// With watermarks a drain begins when `high` writes wait, or when nothing else does; it ends at `low`
/// writes, or with the last one where no read waits. [P: Stuecheli et al., The Virtual Write Queue, ISCA
/// 2010, for the watermarks in use]
#pragma once

#include "models/memory/dram/request_queue.h"

namespace quadrille::models {

enum class DramWriteDrainKind { kOff, kWatermark };

class DramWriteDrain {
 public:
  DramWriteDrain(DramWriteDrainKind kind, int high, int low) : kind_(kind), high_(high), low_(low) {}
  /// Looks at what waits; before reads() and writes().
  void update(const DramQueue& queue) {
    const int reads = queue.count(false), writes = queue.count(true);
    if (draining_) draining_ = writes > 0 && (writes > low_ || reads == 0);
    else draining_ = writes >= high_ || (reads == 0 && writes > 0);
  }
  [[nodiscard]] bool reads() const { return kind_ == DramWriteDrainKind::kOff || !draining_; }
  [[nodiscard]] bool writes() const { return kind_ == DramWriteDrainKind::kOff || draining_; }

 private:
  DramWriteDrainKind kind_;
  int high_, low_;
  bool draining_ = false;
};

}  // namespace quadrille::models
