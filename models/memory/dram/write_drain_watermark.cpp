/// Writes between watermarks: a drain begins when `high` writes wait, or when nothing else does; it ends at
/// `low` writes, or with the last one where no read waits. [P: Stuecheli et al., The Virtual Write Queue,
/// ISCA 2010, for the watermarks in use]
#include "models/memory/dram/write_drain.h"

namespace quadrille::models {

namespace {

class WatermarkWriteDrain final : public DramWriteDrain {
 public:
  explicit WatermarkWriteDrain(const DramWriteDrainSetup& setup) : high_(setup.high), low_(setup.low) {}
  void update(const DramQueue& queue) override {
    const int reads = queue.count(false), writes = queue.count(true);
    if (writes_) writes_ = writes > 0 && (writes > low_ || reads == 0);
    else writes_ = writes >= high_ || (reads == 0 && writes > 0);
    reads_ = !writes_;
  }

 private:
  int high_, low_;
};

}  // namespace

constinit const DramWriteDrainPolicy kWatermarkWriteDrain{
    "watermark", "writes are kept back and drained in runs: the data bus seldom turns around",
    [](const DramWriteDrainSetup& setup) -> std::unique_ptr<DramWriteDrain> {
      return std::make_unique<WatermarkWriteDrain>(setup);
    }};

}  // namespace quadrille::models
