/// Whether a row stays open once nobody waits for it, one file a policy (page_*.cpp).
#pragma once

#include "models/base/policy.h"
#include "models/memory/dram/request_queue.h"

#include <cstdint>

namespace quadrille::models {

class DramPagePolicy {
 public:
  virtual ~DramPagePolicy() = default;
  /// Shall the burst that was just chosen, the last one of its request if `last`, close its row?
  [[nodiscard]] virtual bool closes_with(const DramQueue& /*queue*/, std::uint32_t /*entry*/,
                                         bool /*last*/) const {
    return false;
  }
  /// Closes rows that nobody uses any more.
  [[nodiscard]] virtual bool times() const { return false; }
  /// When a row that was used last at `used` shall close; asked only of a policy that `times()`.
  [[nodiscard]] virtual std::int64_t closes_at(std::int64_t /*used*/) const { return INT64_MAX; }
};

struct DramPageSetup {
  std::int64_t idle = 0;  ///< `adaptive`: cycles without a burst after which a row closes
};
using DramPagePolicyEntry = Policy<DramPagePolicy, const DramPageSetup&>;
/// What `memory.page` chooses from.
[[nodiscard]] PolicyList<DramPagePolicyEntry>& dram_page_policies();
extern const DramPagePolicyEntry kOpenPages, kClosedPages, kAdaptivePages;

}  // namespace quadrille::models
