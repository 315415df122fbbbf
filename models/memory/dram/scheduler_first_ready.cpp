/// First ready: one request a bank, the oldest that hits the open row, else the oldest of all. Rows of other
/// banks are prepared meanwhile. When the oldest request waits longer than the age cap, younger hits to its
/// bank no longer go before it. [P: Rixner et al. 2000: first-ready]
#include "models/memory/dram/scheduler.h"

namespace quadrille::models {

namespace {

class FirstReadyScheduler final : public DramScheduler {
 public:
  [[nodiscard]] std::uint32_t pick(const DramView& view, std::uint32_t bank) const override;
  [[nodiscard]] bool looks_beyond_bank() const override { return false; }

 private:
  [[nodiscard]] static std::uint32_t of_kind(const DramView& view, std::uint32_t bank, bool write);
};

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

}  // namespace

constinit const DramSchedulerPolicy kFirstReadyScheduler{
    "first_ready", "hits to open rows go first: fewer rows are opened, and the data bus waits less",
    [](const DramSchedulerSetup& /*setup*/) -> std::unique_ptr<DramScheduler> {
      return std::make_unique<FirstReadyScheduler>();
    }};

}  // namespace quadrille::models
