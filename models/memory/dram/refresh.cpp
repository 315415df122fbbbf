#include "models/memory/dram/refresh.h"

#include <algorithm>

namespace quadrille::models {

namespace {
constexpr std::int64_t kNoRefresh = std::int64_t{1} << 62;

std::int64_t interval(const DramTiming& t) {
  switch (t.refresh) {
    case DramRefresh::kNone: return 0;
    case DramRefresh::kAllBank: return t.t_refi;
    // One bank at a time, and time between two of them for the others to open rows.
    case DramRefresh::kPerBank: return std::max({1, t.t_refi / t.banks, t.t_rfc_pb, 2 * t.t_rrefd});
  }
  return 0;
}
/// Intervals after which a refresh goes before all requests. Of single banks it does so a few intervals
/// early: the bank may have to move a burst and to close first, and those of the other banks are before it.
/// [G: a quarter of the banks]
std::int64_t most_postponed(const DramTiming& t) {
  const std::int64_t most = t.refresh == DramRefresh::kPerBank
                                ? std::int64_t{t.refresh_postpone} * t.banks - t.banks / 4
                                : t.refresh_postpone;
  return std::max(std::int64_t{1}, most);
}
}  // namespace

DramRefreshClock::DramRefreshClock(const DramTiming& t)
    : per_bank_(t.refresh == DramRefresh::kPerBank),
      interval_(interval(t)),
      banks_(static_cast<std::uint32_t>(t.banks)),
      due_at_(interval_ > 0 ? interval_ : kNoRefresh),
      must_at_(interval_ > 0 ? interval_ * most_postponed(t) : kNoRefresh) {}

}  // namespace quadrille::models
