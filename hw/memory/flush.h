/// How a unit that writes through a cache ends a pass: what the cache has queued is sent, then a fence goes
/// to every slice of the L2 cache. When all fences are answered, every reader sees what was written.
#pragma once

#include "hw/memory/memory_port.h"

namespace quadrille::hw {

class Flush {
 public:
  /// Through this port, which outlives the flush.
  explicit Flush(MemoryPort& port) : port_(port) {}

  /// What is to be written stands in the port's queue.
  void begin() { step_ = Step::kSending; }
  /// Between `begin` and `end`.
  [[nodiscard]] bool running() const { return step_ != Step::kNone; }
  /// Call it after the port has sent: queues the fences as soon as everything before them has left. True when
  /// it did so now. `fences`: false where nothing was written that others could miss.
  bool advance(bool fences = true) {
    if (step_ != Step::kSending || !port_.queue_empty()) return false;
    step_ = Step::kFenced;
    if (!fences) return true;
    port_.fence(kFenceTag);
    unanswered_ = port_.slices();
    return true;
  }
  /// Is this the answer to one of the fences? Then it is counted.
  bool take(const MemoryResponse& answer) {
    if (answer.tag != kFenceTag) return false;
    --unanswered_;
    return true;
  }
  /// Every fence is answered.
  [[nodiscard]] bool done() const { return step_ == Step::kFenced && unanswered_ == 0; }
  void end() { step_ = Step::kNone; }

 private:
  static constexpr std::uint32_t kFenceTag = 0xffffffffu;  ///< no cache has as many misses under way
  enum class Step : std::uint8_t { kNone, kSending, kFenced };
  MemoryPort& port_;
  Step step_ = Step::kNone;
  int unanswered_ = 0;
};

}  // namespace quadrille::hw
