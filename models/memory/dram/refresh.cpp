#include "models/memory/dram/refresh.h"

#include <algorithm>

namespace quadrille::models {

namespace {
constexpr std::int64_t kNoRefresh = std::int64_t{1} << 62;

std::int64_t interval(const DramTiming& t) {
  switch (t.refresh) {
    case DramRefresh::kNone: return 0;
    case DramRefresh::kAllBank: return t.t_refi;
    case DramRefresh::kPerBank: return std::max(1, t.t_refi / t.banks);
  }
  return 0;
}
}  // namespace

DramRefreshClock::DramRefreshClock(const DramTiming& t)
    : per_bank_(t.refresh == DramRefresh::kPerBank),
      interval_(interval(t)),
      banks_(static_cast<std::uint32_t>(t.banks)),
      due_at_(interval_ > 0 ? interval_ : kNoRefresh),
      must_at_(interval_ > 0
                   ? interval_ * std::max(std::int64_t{1}, t.refresh_postpone * (per_bank_ ? std::int64_t{t.banks} : std::int64_t{1}))
                   : kNoRefresh) {}

}  // namespace quadrille::models
