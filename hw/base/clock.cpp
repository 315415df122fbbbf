#include "hw/base/clock.h"

namespace quadrille::hw {

std::int64_t Clock::cycles(Tick from, Tick to) const { return edges_before(to) - edges_before(from); }

Tick Clock::after_uneven(Tick t, std::int64_t cycles) const { return edge(edges_before(t) + cycles); }

}  // namespace quadrille::hw
