/// Counters of units. A counter is declared once, with name, unit and definition, and is its own storage;
/// reports, JSON and documentation walk the group.
#pragma once

#include "hw/base/work_log.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string_view>
#include <vector>

namespace quadrille::hw {

class Counter;
class Histogram;

/// What every statistic says of itself.
class Statistic {
 public:
  Statistic(std::string_view name, std::string_view unit, std::string_view definition)
      : name_(name), unit_(unit), definition_(definition) {}
  Statistic(const Statistic&) = delete;
  Statistic& operator=(const Statistic&) = delete;
  [[nodiscard]] std::string_view name() const { return name_; }
  [[nodiscard]] std::string_view unit() const { return unit_; }
  [[nodiscard]] std::string_view definition() const { return definition_; }

 private:
  std::string_view name_, unit_, definition_;
};

/// The counters of one unit. Not copyable: counters register their own address.
class StatGroup {
 public:
  StatGroup() = default;
  StatGroup(const StatGroup&) = delete;
  StatGroup& operator=(const StatGroup&) = delete;
  [[nodiscard]] const std::vector<Counter*>& counters() const { return counters_; }
  [[nodiscard]] const std::vector<Histogram*>& histograms() const { return histograms_; }
  /// Both, in the order in which they are declared.
  [[nodiscard]] const std::vector<Statistic*>& all() const { return all_; }
  void add(Counter& c);
  void add(Histogram& h);

  /// What is counted from here on is for this draw, `kNoDraw` if for none, and, where one is known, for this
  /// tile of 8x8 pixels of its target.
  void working_for(DrawId draw) {
    if (log_ != nullptr) [[unlikely]]
      log_->turn_to({draw, kNoTile});
  }
  void working_for(DrawId draw, std::uint32_t tile_x, std::uint32_t tile_y) {
    if (log_ != nullptr) [[unlikely]]
      log_->turn_to({draw, tile_at(tile_x, tile_y)});
  }
  /// The same draw, but for this tile.
  void working_at(std::uint32_t tile_x, std::uint32_t tile_y) {
    if (log_ != nullptr) [[unlikely]]
      log_->turn_to({log_->now().draw, tile_at(tile_x, tile_y)});
  }
  /// Null while nobody asks for which draw anything was counted.
  [[nodiscard]] WorkLog* log() const { return log_; }
  /// Before the run. A log changes no count, so a group that one may but read can have one.
  void keep_log(WorkLog& log) const { log_ = &log; }

 private:
  mutable WorkLog* log_ = nullptr;
  std::vector<Statistic*> all_;
  std::vector<Counter*> counters_;
  std::vector<Histogram*> histograms_;
};

class Counter final : public Statistic {
 public:
  Counter(StatGroup& group, std::string_view name, std::string_view unit, std::string_view definition)
      : Statistic(name, unit, definition) {
    group.add(*this);
  }
  Counter& operator++() {
    ++value_;
    return *this;
  }
  Counter& operator+=(std::uint64_t n) {
    value_ += n;
    return *this;
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }
  /// Where it is kept; for a log.
  [[nodiscard]] const std::uint64_t& storage() const { return value_; }

 private:
  std::uint64_t value_ = 0;
};

/// Names the parts of a unit that register counters of their own with its group: `using CounterParts =
/// Parts<MemoryPortStats>`.
template <class... Stats>
struct Parts {};

/// How often a quantity had which size: bucket 0 counts zeros, bucket k > 0 counts sizes from 2^(k-1) to 2^k
/// - 1.
class Histogram final : public Statistic {
 public:
  static constexpr std::size_t kBuckets = 48;
  Histogram(StatGroup& group, std::string_view name, std::string_view unit, std::string_view definition)
      : Statistic(name, unit, definition) {
    group.add(*this);
  }
  void note(std::uint64_t size) {
    ++buckets_[std::min<std::size_t>(static_cast<std::size_t>(std::bit_width(size)), kBuckets - 1)];
    sum_ += size;
  }
  [[nodiscard]] const std::array<std::uint64_t, kBuckets>& buckets() const { return buckets_; }
  /// Of all sizes noted.
  [[nodiscard]] std::uint64_t sum() const { return sum_; }
  [[nodiscard]] std::uint64_t count() const {
    return std::accumulate(buckets_.begin(), buckets_.end(), std::uint64_t{0});
  }

 private:
  std::array<std::uint64_t, kBuckets> buckets_{};
  std::uint64_t sum_ = 0;
};

inline void StatGroup::add(Counter& c) {
  counters_.push_back(&c);
  all_.push_back(&c);
}
inline void StatGroup::add(Histogram& h) {
  histograms_.push_back(&h);
  all_.push_back(&h);
}

}  // namespace quadrille::hw
