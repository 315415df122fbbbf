/// In order: bursts move in the order of arrival. With `ahead` of 0 what waits behind the oldest request
/// waits for all of it [P: Rixner et al., Memory Access Scheduling, ISCA 2000: in order]; else the rows of
/// that many requests behind it are closed and opened meanwhile, in banks that no older one needs.
#include "models/memory/dram/scheduler.h"

namespace quadrille::models {

namespace {

class InOrderScheduler final : public DramScheduler {
 public:
  explicit InOrderScheduler(int ahead) : ahead_(ahead) {}
  [[nodiscard]] std::uint32_t pick(const DramView& view, std::uint32_t bank) const override;
  [[nodiscard]] bool moves(const DramView& view, std::uint32_t request) const override {
    return request == oldest(view);
  }
  [[nodiscard]] bool looks_beyond_bank() const override { return true; }

 private:
  [[nodiscard]] static std::uint32_t oldest(const DramView& view) {
    return view.reads && view.writes ? view.queue.oldest() : view.queue.oldest(view.writes);
  }
  int ahead_;
};

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

}  // namespace

constinit const DramSchedulerPolicy kInOrderScheduler{
    "in_order", "requests are served in the order of arrival: what other schedulers are measured against",
    [](const DramSchedulerSetup& setup) -> std::unique_ptr<DramScheduler> {
      return std::make_unique<InOrderScheduler>(setup.in_order_ahead);
    }};

}  // namespace quadrille::models
