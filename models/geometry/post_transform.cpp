#include "models/geometry/post_transform.h"

#include "models/base/error.h"

namespace quadrille::models {

void VertexReuse::reset() {
  lanes_.fill(-1);
  size_ = 0;
}

int VertexReuse::find(std::uint32_t index) const {
  for (std::uint32_t slot = slot_of(index);; slot = (slot + 1) % kSlots) {
    const int lane = lanes_[slot];
    if (lane < 0 || indices_[static_cast<std::size_t>(lane)] == index) return lane;
  }
}

bool VertexReuse::fits(const std::array<std::uint32_t, 3>& triangle) const {
  const auto [a, b, c] = triangle;
  int added = find(a) < 0 ? 1 : 0;
  if (b != a && find(b) < 0) ++added;
  if (c != a && c != b && find(c) < 0) ++added;
  return size_ + added <= kCapacity;
}

int VertexReuse::find_or_add(std::uint32_t index) {
  std::uint32_t slot = slot_of(index);
  for (; lanes_[slot] >= 0; slot = (slot + 1) % kSlots) {
    if (indices_[static_cast<std::size_t>(lanes_[slot])] == index) return lanes_[slot];
  }
  QUADRILLE_CHECK(size_ < kCapacity, "vertex batch is full, vertex {} does not fit", index);
  indices_[static_cast<std::size_t>(size_)] = index;
  lanes_[slot] = static_cast<std::int8_t>(size_);
  return size_++;
}

}  // namespace quadrille::models
