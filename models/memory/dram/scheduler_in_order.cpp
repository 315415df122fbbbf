/// In-order scheduling (scheduler.h).
#include "models/memory/dram/scheduler.h"

namespace quadrille::models {

std::uint32_t InOrderScheduler::pick(const DramView& view, std::uint32_t bank) const {
  const std::uint32_t first = view.reads && view.writes ? view.queue.oldest() : view.queue.oldest(view.writes);
  return first != DramQueue::kNone && view.queue[first].at.bank == bank ? first : DramQueue::kNone;
}

}  // namespace quadrille::models
