/// Counters of units. A counter is declared once, with name, unit and definition, and is its own storage; reports, JSON and documentation walk the group.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace quadrille::hw {

class Counter;

/// The counters of one unit. Not copyable: counters register their own address.
class StatGroup {
 public:
  StatGroup() = default;
  StatGroup(const StatGroup&) = delete;
  StatGroup& operator=(const StatGroup&) = delete;
  [[nodiscard]] const std::vector<Counter*>& counters() const { return counters_; }
  void add(Counter& c) { counters_.push_back(&c); }

 private:
  std::vector<Counter*> counters_;
};

class Counter {
 public:
  Counter(StatGroup& group, std::string_view name, std::string_view unit, std::string_view definition)
      : name_(name), unit_(unit), definition_(definition) {
    group.add(*this);
  }
  Counter(const Counter&) = delete;
  Counter& operator=(const Counter&) = delete;

  Counter& operator++() {
    ++value_;
    return *this;
  }
  Counter& operator+=(std::uint64_t n) {
    value_ += n;
    return *this;
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }
  [[nodiscard]] std::string_view name() const { return name_; }
  [[nodiscard]] std::string_view unit() const { return unit_; }
  [[nodiscard]] std::string_view definition() const { return definition_; }

 private:
  std::uint64_t value_ = 0;
  std::string_view name_, unit_, definition_;
};

}  // namespace quadrille::hw
