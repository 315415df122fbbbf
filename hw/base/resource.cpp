#include "hw/base/resource.h"

namespace quadrille::hw {

namespace {

/// Of two slices that become one, what they had come to at the end of the second.
template <class Value>
void keep_every_second(std::vector<Value>& at_end_of) {
  for (std::size_t i = 1; i < at_end_of.size(); i += 2) at_end_of[i / 2] = std::move(at_end_of[i]);
  at_end_of.resize(at_end_of.size() / 2);
}

}  // namespace

void Resources::end_slice(Tick at) {
  for (Resource& r : all_) r.at_end_of.push_back(r.total(at));
  if (row_) rows_.push_back(row_());
  ++ended_;
}

void Resources::end_slices(Tick now) {
  while (now >= next_slice_) {
    end_slice(next_slice_);
    next_slice_ += slice_;
    if (static_cast<std::size_t>(next_slice_ / slice_) > kMostSlices) double_slice();
  }
}

void Resources::double_slice() {
  for (Resource& r : all_) keep_every_second(r.at_end_of);
  if (row_) keep_every_second(rows_);
  slice_ *= 2;
  ended_ /= 2;
  next_slice_ = static_cast<Tick>(ended_ + 1) * slice_;
}

void Resources::finish(Tick end, Tick slice) {
  if (empty()) return;
  end_slices(end);
  while (slice_ < slice) double_slice();
  if (static_cast<Tick>(ended_) * slice_ < end) end_slice(end);
}

}  // namespace quadrille::hw
