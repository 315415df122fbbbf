#include "hw/shader/simd.h"

#include <algorithm>
#include <cmath>

namespace quadrille::hw {

void Simd::add(Cycle now, std::uint32_t name, std::uint32_t work, std::uint32_t span) {
  advance(now);
  const double cycles = std::max(1.0, static_cast<double>(span));
  running_.push_back({name, cycles, std::clamp(static_cast<double>(work) / cycles, kSimdRounding, 1.0), 0});
  share_out();
}

void Simd::advance(Cycle now) {
  if (now == now_) return;
  issued_ = issued(now);
  const auto cycles = static_cast<double>(now - now_);
  for (SimdClause& clause : running_) clause.left -= clause.speed * cycles;
  now_ = now;
}

double Simd::issued(Cycle now) const {
  double sum = issued_;
  // A clause that ends within its last cycle has no more to issue.
  for (const SimdClause& clause : running_)
    sum +=
        std::max(0.0, std::min(clause.left, clause.speed * static_cast<double>(now - now_))) * clause.share;
  return sum;
}

bool Simd::take_ended(Cycle now, std::uint32_t& name) {
  if (next_end_ > now) return false;
  advance(now);
  const auto ended = std::find_if(running_.begin(), running_.end(),
                                  [](const SimdClause& clause) { return clause.left < kSimdRounding; });
  if (ended == running_.end()) return false;
  name = ended->name;
  running_.erase(ended);
  share_out();
  return true;
}

void Simd::share_out() {
  sharing_->share(running_);
  double first = std::numeric_limits<double>::max();
  for (const SimdClause& clause : running_) {
    if (clause.left < kSimdRounding) first = 0;
    else if (clause.speed > 0) first = std::min(first, clause.left / clause.speed);
  }
  next_end_ = running_.empty() ? kNever : now_ + static_cast<Cycle>(std::ceil(first - kSimdRounding));
}

}  // namespace quadrille::hw
