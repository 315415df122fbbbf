/// Closed pages: a row closes with its last waiting burst; the precharge comes with the command.
#include "models/memory/dram/page_policy.h"

namespace quadrille::models {

namespace {

class ClosedPages final : public DramPagePolicy {
 public:
  [[nodiscard]] bool closes_with(const DramQueue& queue, std::uint32_t entry, bool last) const override {
    if (!last) return false;
    const DramPlace& at = queue[entry].at;
    for (const bool write : {false, true}) {
      // The request itself is still in the queue: it does not count.
      const std::uint32_t other = queue.oldest_of_row(at.bank, write, at.row);
      if (other != DramQueue::kNone && (other != entry || queue.another_of_row(entry))) return false;
    }
    return true;
  }
};

}  // namespace

constinit const DramPagePolicyEntry kClosedPages{
    "closed", "a row closes with its last waiting burst: the next row of its bank need not wait for that",
    [](const DramPageSetup& /*setup*/) -> std::unique_ptr<DramPagePolicy> {
      return std::make_unique<ClosedPages>();
    }};

}  // namespace quadrille::models
