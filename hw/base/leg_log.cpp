#include "hw/base/leg_log.h"

#include <algorithm>

namespace quadrille::hw {

void LegLog::end(const Leg& leg) {
  legs_.push_back(leg);
  if (leg.out >= outs_.size()) outs_.resize(leg.out + 1, false);
  outs_[leg.out] = true;
}

namespace {

/// The last entry that satisfies `wanted`, of those before `behind`; null if none.
template <class Entry, class Wanted>
const Entry* last_before(const std::vector<Entry>& all, const Entry* behind, const Wanted& wanted) {
  while (behind != all.data())
    if (wanted(*--behind)) return behind;
  return nullptr;
}

/// Behind the last entry that is not later than `t`.
template <class Entry>
const Entry* behind(const Entry* first, const Entry* end, Tick Entry::*at, Tick t) {
  return std::upper_bound(first, end, t, [at](Tick tick, const Entry& entry) { return tick < entry.*at; });
}

}  // namespace

const LegLog::Leg* LegLog::ended_by(Tick t, std::uint32_t port) const {
  return last_before(legs_, behind(legs_.data(), legs_.data() + legs_.size(), &Leg::sent, t),
                     [port](const Leg& leg) { return leg.out == port; });
}

const LegLog::Leg* LegLog::left_by(Tick t, const Leg* before) const {
  const Leg* end = before == nullptr ? legs_.data() + legs_.size() : before;
  return last_before(legs_, behind(legs_.data(), end, &Leg::sent, t),
                     [](const Leg& leg) { return leg.leaves; });
}

const LegLog::Take* LegLog::taken_by(Tick t) const {
  return last_before(takes_, behind(takes_.data(), takes_.data() + takes_.size(), &Take::taken, t),
                     [](const Take&) { return true; });
}

const LegLog::Take* LegLog::entered_by(Tick t) const {
  return last_before(takes_, behind(takes_.data(), takes_.data() + takes_.size(), &Take::taken, t),
                     [](const Take& take) { return take.enters; });
}

}  // namespace quadrille::hw
