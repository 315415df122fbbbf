#include "hw/shader/simd.h"

#include <algorithm>
#include <cmath>

namespace quadrille::hw {

namespace {
/// Less than this of a cycle is rounding.
constexpr double kRounding = 1e-6;
}  // namespace

void Simd::add(Cycle now, std::uint32_t name, std::uint32_t work, std::uint32_t span) {
  advance(now);
  const double cycles = std::max(1.0, static_cast<double>(span));
  running_.push_back({name, cycles, std::clamp(static_cast<double>(work) / cycles, kRounding, 1.0), 0});
  share_out();
}

void Simd::advance(Cycle now) {
  if (now == now_) return;
  issued_ = issued(now);
  const auto cycles = static_cast<double>(now - now_);
  for (Running& clause : running_) clause.left -= clause.speed * cycles;
  now_ = now;
}

double Simd::issued(Cycle now) const {
  double sum = issued_;
  // A clause that ends within its last cycle has no more to issue.
  for (const Running& clause : running_)
    sum +=
        std::max(0.0, std::min(clause.left, clause.speed * static_cast<double>(now - now_))) * clause.share;
  return sum;
}

bool Simd::take_ended(Cycle now, std::uint32_t& name) {
  if (next_end_ > now) return false;
  advance(now);
  const auto ended = std::find_if(running_.begin(), running_.end(),
                                  [](const Running& clause) { return clause.left < kRounding; });
  if (ended == running_.end()) return false;
  name = ended->name;
  running_.erase(ended);
  share_out();
  return true;
}

void Simd::share_out() {
  if (scheduling_ == WarpScheduling::kRoundRobin) share_out_evenly();
  double free = 1;
  double first = std::numeric_limits<double>::max();
  for (Running& clause : running_) {
    if (scheduling_ == WarpScheduling::kOldest) clause.speed = std::min(clause.share, free) / clause.share;
    free -= clause.speed * clause.share;
    if (free < kRounding) free = 0;
    if (clause.left < kRounding) first = 0;
    else if (clause.speed > 0) first = std::min(first, clause.left / clause.speed);
  }
  next_end_ = running_.empty() ? kNever : now_ + static_cast<Cycle>(std::ceil(first - kRounding));
}

void Simd::share_out_evenly() {
  // The even share is the level that fills the SIMD: those that can use less than it leave the rest to the
  // others.
  double all = 0;
  for (const Running& clause : running_) all += clause.share;
  double level = 1;
  if (all > 1) {
    shares_.clear();
    for (const Running& clause : running_) shares_.push_back(clause.share);
    std::sort(shares_.begin(), shares_.end());
    double free = 1;
    for (std::size_t i = 0; i < shares_.size(); ++i) {
      level = free / static_cast<double>(shares_.size() - i);
      if (shares_[i] >= level) break;
      free -= shares_[i];
    }
  }
  for (Running& clause : running_) clause.speed = std::min(clause.share, level) / clause.share;
}

}  // namespace quadrille::hw
