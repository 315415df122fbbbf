/// Inputs of one kind, one a peer, of a unit that serves many: the links mark arrivals in a bit set, so that
/// looking for work costs nothing for those that are empty.
#pragma once

#include "hw/base/unit.h"

#include <array>
#include <bit>
#include <memory>
#include <utility>
#include <vector>

namespace quadrille::hw {

template <class T>
class FifoInGroup {
 public:
  FifoInGroup() = default;
  FifoInGroup(const FifoInGroup&) = delete;
  FifoInGroup& operator=(const FifoInGroup&) = delete;

  /// Adds the next input; before elaboration. Its index is the number of those added before.
  void add(Unit& owner, const char* name, LinkRole role = LinkRole::kFlow, int stream = 0) {
    const std::size_t i = ports_.size();
    QUADRILLE_CHECK(i < 64 * marks_.size(), "{} has more than {} inputs of a kind", owner.name(),
                    64 * marks_.size());
    ports_.push_back(std::make_unique<FifoIn<T>>(owner, name, role, stream));
    ports_.back()->mark_arrivals(marks_[i / 64], static_cast<int>(i % 64));
  }
  [[nodiscard]] std::size_t size() const { return ports_.size(); }
  [[nodiscard]] FifoIn<T>& operator[](std::size_t i) const { return *ports_[i]; }

  /// The earliest of actions that need `own` and any one input; the first input wins ties. Never, for want of
  /// the first input, while none holds a token; never, for want of nothing, of an empty group.
  [[nodiscard]] Wake earliest(const Wake& own = Wake()) const {
    if (ports_.empty()) return Wake(kNever);
    Wake first = Wake::never(*ports_[0]);
    visit_holding(0, [&](std::size_t, FifoIn<T>& in) {
      first = Wake::sooner(first, Wake(own).input(in));
      return false;
    });
    return first;
  }
  /// Calls `visit(index, input)` for the inputs that hold a token, visible or on its way, in order from
  /// `start` on and around; until it returns true.
  template <class Visit>
  bool visit_holding(std::size_t start, Visit&& visit) const {
    return visit_range(start, ports_.size(), visit) || visit_range(0, start, visit);
  }
  /// Calls `take(index, token)` for every token that is visible at `now`, input by input.
  template <class Take>
  void take_ready(Tick now, Take&& take) const {
    visit_holding(0, [&](std::size_t i, FifoIn<T>& in) {
      while (in.ready_at(now)) take(i, in.pop(now));
      return false;
    });
  }

 private:
  template <class Visit>
  bool visit_range(std::size_t begin, std::size_t end, Visit&& visit) const {
    for (std::size_t w = begin / 64; w * 64 < end; ++w) {
      std::uint64_t marks = marks_[w];
      if (w == begin / 64) marks &= ~std::uint64_t{0} << (begin % 64);
      if (end - w * 64 < 64) marks &= (std::uint64_t{1} << (end - w * 64)) - 1;
      for (; marks != 0; marks &= marks - 1) {
        const std::size_t i = w * 64 + static_cast<std::size_t>(std::countr_zero(marks));
        if (ports_[i]->ready() == kNever) {
          marks_[w] &= ~(marks & (~marks + 1));  // emptied since it was marked
        } else if (visit(i, *ports_[i])) {
          return true;
        }
      }
    }
    return false;
  }

  std::vector<std::unique_ptr<FifoIn<T>>> ports_;
  /// A bit an input: set when it gets a first token, cleared when it is found empty. Links point at them; the
  /// widest machine has 273 clients of an L2 slice.
  mutable std::array<std::uint64_t, 5> marks_{};
};

}  // namespace quadrille::hw
