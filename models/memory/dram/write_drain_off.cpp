/// No write drain: writes are served like reads.
#include "models/memory/dram/write_drain.h"

namespace quadrille::models {

namespace {

class NoWriteDrain final : public DramWriteDrain {
 public:
  NoWriteDrain() { writes_ = true; }
  void update(const DramQueue& /*queue*/) override {}
};

}  // namespace

constinit const DramWriteDrainPolicy kNoWriteDrain{
    "off", "writes are served like reads: the simplest controller",
    [](const DramWriteDrainSetup& /*setup*/) -> std::unique_ptr<DramWriteDrain> {
      return std::make_unique<NoWriteDrain>();
    }};

}  // namespace quadrille::models
