/// A dirty victim takes the other dirty lines of its block along: those that lie in the same rows of all
/// banks, so that they are written while the rows are open. [P: Lee 2010]
#include "hw/memory/write_back.h"

namespace quadrille::hw {

namespace {

class RowWriteBack final : public WriteBack {
 public:
  explicit RowWriteBack(std::uint32_t block_lines) : block_lines_(block_lines) {}
  [[nodiscard]] Lines with(std::uint32_t victim, const models::Interleave& slices) const override {
    const std::uint32_t first = slices.index_of(victim) / block_lines_ * block_lines_;
    return {first, first + block_lines_};
  }

 private:
  std::uint32_t block_lines_;
};

}  // namespace

constinit const WriteBackPolicy kRowWriteBack{
    "row", "the dirty lines around a victim leave with it, while their rows of DRAM are open",
    [](const WriteBackSetup& setup) -> std::unique_ptr<WriteBack> {
      return std::make_unique<RowWriteBack>(setup.block_lines);
    }};

}  // namespace quadrille::hw
