/// A DRAM scheduler of your own in one file: each bank serves its oldest read, and writes only when it has no
/// read. The list of schedulers is told of it in main.cpp, and `memory.scheduler=reads_first` then chooses
/// it.
#include "models/memory/dram/scheduler.h"

namespace examples {

namespace {

using namespace quadrille::models;

class ReadsFirstScheduler final : public DramScheduler {
 public:
  [[nodiscard]] std::uint32_t pick(const DramView& view, std::uint32_t bank) const override {
    const std::uint32_t read = view.reads ? view.queue.oldest(bank, false) : DramQueue::kNone;
    if (read != DramQueue::kNone || !view.writes) return read;
    return view.queue.oldest(bank, true);
  }
  [[nodiscard]] bool looks_beyond_bank() const override { return false; }
};

}  // namespace

extern const DramSchedulerPolicy kReadsFirstScheduler;
constinit const DramSchedulerPolicy kReadsFirstScheduler{
    "reads_first", "reads before writes: somebody waits for a read",
    [](const DramSchedulerSetup& /*setup*/) -> std::unique_ptr<DramScheduler> {
      return std::make_unique<ReadsFirstScheduler>();
    }};

}  // namespace examples
