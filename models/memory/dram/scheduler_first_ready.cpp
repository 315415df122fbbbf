/// First-ready scheduling (scheduler.h).
#include "models/memory/dram/scheduler.h"

namespace quadrille::models {

std::uint32_t FirstReadyScheduler::of_kind(const DramView& view, std::uint32_t bank, bool write) {
  const std::uint32_t oldest = view.queue.oldest(bank, write);
  if (oldest == DramQueue::kNone || oldest == view.starving[write]) return oldest;
  const std::uint32_t hit = view.queue.oldest_of_row(bank, write, view.device.open_row(bank));
  return hit == DramQueue::kNone ? oldest : hit;
}

std::uint32_t FirstReadyScheduler::pick(const DramView& view, std::uint32_t bank) const {
  const std::uint32_t read = view.reads ? of_kind(view, bank, false) : DramQueue::kNone;
  const std::uint32_t write = view.writes ? of_kind(view, bank, true) : DramQueue::kNone;
  if (read == DramQueue::kNone || write == DramQueue::kNone) return read == DramQueue::kNone ? write : read;
  // Both kinds want the bank: one that hits its row, else the older one.
  const std::int32_t row = view.device.open_row(bank);
  const bool read_hits = view.queue[read].at.row == row, write_hits = view.queue[write].at.row == row;
  if (read_hits != write_hits) return read_hits ? read : write;
  return view.queue[read].seq < view.queue[write].seq ? read : write;
}

std::unique_ptr<DramScheduler> make_dram_scheduler(DramSchedulerKind kind, int in_order_ahead) {
  switch (kind) {
    case DramSchedulerKind::kInOrder: return std::make_unique<InOrderScheduler>(in_order_ahead);
    case DramSchedulerKind::kFirstReady: return std::make_unique<FirstReadyScheduler>();
  }
  return nullptr;
}

}  // namespace quadrille::models
