#include "models/memory/dram/page_policy.h"

namespace quadrille::models {

bool DramPagePolicy::closes_with(const DramQueue& queue, std::uint32_t entry, bool last) const {
  if (kind_ != DramPagePolicyKind::kClosed || !last) return false;
  const DramPlace& at = queue[entry].at;
  for (const bool write : {false, true}) {
    // The request itself is still in the queue: it does not count.
    const std::uint32_t other = queue.oldest_of_row(at.bank, write, at.row);
    if (other != DramQueue::kNone && (other != entry || queue.another_of_row(entry))) return false;
  }
  return true;
}

}  // namespace quadrille::models
