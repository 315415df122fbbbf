/// The queue of a unit whose entries wait for answers from memory. Whoever answers knows an entry by its
/// number, which stays the same while entries before it leave.
///
/// `Entry` has `int missing`, the answers it waits for, and `Tick ready`, when the last one came.
#pragma once

#include "hw/base/clock.h"
#include "hw/base/queue.h"

#include <algorithm>
#include <cstdint>

namespace quadrille::hw {

template <class Entry>
class WaitingQueue : public Queue<Entry> {
 public:
  /// Numbers have 31 bits: the highest one is free for a mark of the caller's.
  static constexpr std::uint32_t kNumbers = 0x7fffffffu;
  /// Of the entry at a place, counted from the front.
  [[nodiscard]] std::uint32_t number(std::size_t i) const {
    return (first_ + static_cast<std::uint32_t>(i)) & kNumbers;
  }
  /// Of the entry that came last.
  [[nodiscard]] std::uint32_t newest() const { return number(this->size() - 1); }
  [[nodiscard]] Entry& numbered(std::uint32_t number) { return (*this)[(number - first_) & kNumbers]; }
  /// One of the answers that an entry waits for is here.
  void answer(std::uint32_t number, Tick now) {
    Entry& entry = numbered(number);
    --entry.missing;
    entry.ready = std::max(entry.ready, now);
  }
  void pop_front() {
    Queue<Entry>::pop_front();
    first_ = number(1);
  }

 private:
  std::uint32_t first_ = 0;  ///< number of the front
};

}  // namespace quadrille::hw
