/// Whether a row stays open once nobody waits for it, one case a policy.
///   open      until another row of its bank is wanted
///   closed    it closes with its last waiting burst (the precharge comes with the command)
///   adaptive  it closes when nobody asked for it for `idle` cycles
#pragma once

#include "models/memory/dram/request_queue.h"

#include <cstdint>

namespace quadrille::models {

enum class DramPagePolicyKind { kOpen, kClosed, kAdaptive };

class DramPagePolicy {
 public:
  DramPagePolicy(DramPagePolicyKind kind, std::int64_t idle) : kind_(kind), idle_(idle) {}
  /// Shall the burst that was just chosen, the last one of its request if `last`, close its row?
  [[nodiscard]] bool closes_with(const DramQueue& queue, std::uint32_t entry, bool last) const;
  /// Closes rows that nobody uses any more.
  [[nodiscard]] bool times() const { return kind_ == DramPagePolicyKind::kAdaptive; }
  /// When a row that was used last at `used` shall close.
  [[nodiscard]] std::int64_t closes_at(std::int64_t used) const { return used + idle_; }

 private:
  DramPagePolicyKind kind_;
  std::int64_t idle_;
};

}  // namespace quadrille::models
