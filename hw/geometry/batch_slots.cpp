#include "hw/geometry/batch_slots.h"

namespace quadrille::hw {

BatchSlots::BatchSlots(std::uint32_t first, std::uint32_t slots) : first_(first), last_use_(slots, 0) {
  for (std::uint32_t i = slots; i-- > 0;) free_.push_back(first + i);
}

std::uint32_t BatchSlots::take() {
  const std::uint32_t slot = free_.back();
  free_.pop_back();
  held_.push_back(slot);
  ++taken_;
  note_use(slot);
  return slot;
}

void BatchSlots::sweep(const models::VertexReuse& reuse) {
  std::erase_if(held_, [&](std::uint32_t slot) {
    if (last_use_[slot - first_] > released_ || reuse.remembers(slot)) return false;
    free_.push_back(slot);
    return true;
  });
}

}  // namespace quadrille::hw
