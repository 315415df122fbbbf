/// A dirty victim leaves alone.
#include "hw/memory/write_back.h"

namespace quadrille::hw {

namespace {

class VictimWriteBack final : public WriteBack {
 public:
  [[nodiscard]] Lines with(std::uint32_t /*victim*/, const models::Interleave& /*slices*/) const override {
    return {};
  }
};

}  // namespace

constinit const WriteBackPolicy kVictimWriteBack{
    "victim", "a dirty victim leaves alone: each line is written as late and as seldom as can be",
    [](const WriteBackSetup& /*setup*/) -> std::unique_ptr<WriteBack> {
      return std::make_unique<VictimWriteBack>();
    }};

}  // namespace quadrille::hw
