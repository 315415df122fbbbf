#include "hw/base/clock.h"

#include <algorithm>
#include <cmath>

namespace quadrille::hw {

std::int64_t Clock::cycles(Tick from, Tick to) const { return edges_before(to) - edges_before(from); }

Tick Clock::after_uneven(Tick t, std::int64_t cycles) const { return edge(edges_before(t) + cycles); }

Clock Clock::faster(double times) const {
  Clock clock = *this;
  const double period = static_cast<double>(kFemto) / static_cast<double>(hz_) / times;
  clock.whole_ = std::max<Tick>(1, std::llround(period));
  clock.fraction_ = 0;
  clock.exact_below_ = std::numeric_limits<std::int64_t>::max();
  clock.hz_ = kFemto / clock.whole_;
  clock.per_tick_ = 1 / static_cast<double>(clock.whole_);
  clock.free_running_ = true;
  return clock;
}

}  // namespace quadrille::hw
