#include "hw/base/resource.h"

namespace quadrille::hw {

void Resources::end_slices(Tick now) {
  while (now >= next_slice_) {
    for (Resource& r : all_) r.at_end_of.push_back(r.total(next_slice_));
    next_slice_ += slice_;
    if (static_cast<std::size_t>(next_slice_ / slice_) > kMostSlices) double_slice();
  }
}

void Resources::double_slice() {
  for (Resource& r : all_) {
    for (std::size_t i = 1; i < r.at_end_of.size(); i += 2) r.at_end_of[i / 2] = r.at_end_of[i];
    r.at_end_of.resize(r.at_end_of.size() / 2);
  }
  slice_ *= 2;
  next_slice_ = all_.empty() ? next_slice_ : static_cast<Tick>(all_.front().at_end_of.size() + 1) * slice_;
}

void Resources::finish(Tick end, Tick slice) {
  if (all_.empty()) return;
  end_slices(end);
  while (slice_ < slice) double_slice();
  if (static_cast<Tick>(all_.front().at_end_of.size()) * slice_ < end)
    for (Resource& r : all_) r.at_end_of.push_back(r.total(end));
}

}  // namespace quadrille::hw
