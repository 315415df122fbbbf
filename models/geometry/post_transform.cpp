#include "models/geometry/post_transform.h"

#include "models/base/error.h"

#include <algorithm>

namespace quadrille::models {

VertexReuse::VertexReuse(ReusePolicy policy, int batch_vertices, int entries)
    : policy_(policy), batch_vertices_(batch_vertices), entries_(static_cast<std::size_t>(entries)) {
  QUADRILLE_CHECK(batch_vertices >= 3 && batch_vertices <= kLanes, "a batch of {} vertices", batch_vertices);
  QUADRILLE_CHECK(policy != ReusePolicy::kFifo || entries >= 3, "a FIFO of {} vertices", entries);
  start_batch();
}

void VertexReuse::start_draw() {
  order_.clear();
  places_.clear();
  remembered_.clear();
  slots_remembered_ = 0;
}

void VertexReuse::start_batch(std::uint32_t slot) {
  lanes_.fill(-1);
  size_ = 0;
  slot_ = slot;
}

int VertexReuse::find(std::uint32_t index) const {
  for (std::uint32_t slot = slot_of(index);; slot = (slot + 1) % kSlots) {
    const int lane = lanes_[slot];
    if (lane < 0 || indices_[static_cast<std::size_t>(lane)] == index) return lane;
  }
}

bool VertexReuse::fits(const std::array<std::uint32_t, 3>& triangle) const {
  std::ptrdiff_t added = 3;
  if (policy_ == ReusePolicy::kBatch)
    added = std::ranges::count_if(triangle, [this](std::uint32_t v) { return find(v) < 0; });
  return size_ + added <= batch_vertices_;
}

VertexPlace VertexReuse::place(std::uint32_t index) {
  switch (policy_) {
    case ReusePolicy::kBatch: {
      const int lane = find(index);
      return {slot_, lane >= 0 ? static_cast<std::uint8_t>(lane) : add_lane(index)};
    }
    case ReusePolicy::kFifo: {
      if (const auto known = places_.find(index); known != places_.end()) return known->second;
      const VertexPlace place{slot_, add_lane(index)};
      remember(index, place);
      return place;
    }
    case ReusePolicy::kNone: return {slot_, add_lane(index)};
  }
  return {};
}

std::uint8_t VertexReuse::add_lane(std::uint32_t index) {
  QUADRILLE_CHECK(size_ < batch_vertices_, "vertex batch is full, vertex {} does not fit", index);
  indices_[static_cast<std::size_t>(size_)] = index;
  if (policy_ == ReusePolicy::kBatch) {
    std::uint32_t slot = slot_of(index);
    while (lanes_[slot] >= 0) slot = (slot + 1) % kSlots;
    lanes_[slot] = static_cast<std::int8_t>(size_);
  }
  return static_cast<std::uint8_t>(size_++);
}

void VertexReuse::remember(std::uint32_t index, const VertexPlace& place) {
  if (order_.size() == entries_) forget_oldest();
  order_.push_back(index);
  places_.emplace(index, place);
  if (place.slot >= remembered_.size()) remembered_.resize(place.slot + 1);
  if (remembered_[place.slot]++ == 0) ++slots_remembered_;
}

void VertexReuse::forget_oldest() {
  const auto oldest = places_.find(order_.front());
  if (--remembered_[oldest->second.slot] == 0) --slots_remembered_;
  places_.erase(oldest);
  order_.pop_front();
}

void VertexReuse::limit_slots(int slots) {
  while (slots_remembered_ > slots) forget_oldest();
}

}  // namespace quadrille::models
