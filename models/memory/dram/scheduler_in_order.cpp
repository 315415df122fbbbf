/// In-order scheduling (scheduler.h).
#include "models/memory/dram/scheduler.h"

namespace quadrille::models {

std::uint32_t InOrderScheduler::oldest(const DramView& view) {
  return view.reads && view.writes ? view.queue.oldest() : view.queue.oldest(view.writes);
}

std::uint32_t InOrderScheduler::pick(const DramView& view, std::uint32_t bank) const {
  const DramQueue& queue = view.queue;
  std::uint32_t read = view.reads ? queue.oldest(false) : DramQueue::kNone,
                write = view.writes ? queue.oldest(true) : DramQueue::kNone;
  for (int seen = 0; seen <= ahead_; ++seen) {
    if (read == DramQueue::kNone && write == DramQueue::kNone) break;
    const bool read_next =
        write == DramQueue::kNone || (read != DramQueue::kNone && queue[read].seq < queue[write].seq);
    std::uint32_t& next = read_next ? read : write;
    if (queue[next].at.bank == bank) return next;
    next = queue.younger(next);
  }
  return DramQueue::kNone;
}

}  // namespace quadrille::models
