/// The default driver: one SC_METHOD that advances all units, each as far ahead as conservative look-ahead
/// allows, and SystemC's time with them.
///
/// Fixed-order units run until a FIFO stops them. Once all have run dry only choosers can start anything, so
/// a chooser k may act at t only if, for every chooser j, t < time(j) + distance(j, k): the distance is the
/// shortest sum of latencies from j to k through the machine, tokens forward and credits back, and for j = k
/// the shortest round trip. Nothing simulated later can then become visible to it at or before t.
///
/// `window` lets each chooser go beyond that bound, at most so far; the figures are then approximate. A token
/// that comes in time for a tick which the chooser has left behind is served late, so each chooser learns how
/// far it may go: its slack is halved by such a surprise and grows slowly without one [P: Chiu and Jain
/// 1989]. Every unit's own time still never runs backwards and no token is seen before its time, so pixels
/// and laws do not depend on the window.
#pragma once

#include "hw/base/driver.h"

namespace quadrille::hw {

class Dispatcher final : public Driver {
 public:
  /// `window`: the most that choosers may look ahead beyond the exact bound, in ticks; 0 is exact.
  explicit Dispatcher(sc_core::sc_module_name name, Tick window = 0) : Driver(name), window_(window) {}

 private:
  /// What bounds a chooser; see above.
  struct Reach {
    Tick others = kNever;  ///< smallest distance from any other chooser
    Tick self = kNever;    ///< shortest round trip
  };
  struct Chooser {
    Unit* unit = nullptr;
    std::uint64_t* mark_word = nullptr;
    std::uint64_t mark_bit = 0;
    Tick round_trip = kNever;
    Wake wake;
    Reach exact;
    Tick slack = 0;  ///< what it may go beyond the exact bound now, at most `window_`
  };
  void prepare() override;
  /// A unit that can surprise another, by number, and how soon.
  struct Neighbour {
    std::uint32_t unit = 0;
    Tick latency = 0;
  };
  /// Who can surprise each unit. Of several links between two units only the quickest counts.
  [[nodiscard]] std::vector<std::vector<Neighbour>> surprisers() const;
  [[nodiscard]] Reach reach_of(std::size_t chooser,
                               const std::vector<std::vector<Neighbour>>& surprisers) const;
  void step();
  /// Runs marked fixed-order units until none can act, then asks marked choosers again.
  void settle();
  /// Learns from what chooser `k` answers after something reached it: it would have acted at `asked`.
  void adapt(std::size_t k, Tick asked);
  /// One pass over the marked fixed-order units. False when none was marked.
  bool run_marked();
  void run_ahead(Unit& unit) const;
  /// One round over the choosers. False when none can act within the limit.
  bool round();
  /// Acts until `bound`; the chooser's time is before it.
  void run_chooser(std::size_t k, Tick bound);

  Tick window_;
  std::vector<Chooser> choosers_;
  std::vector<std::size_t> chooser_of_;       ///< unit index -> chooser index; only for choosers
  std::vector<std::uint64_t> chooser_marks_;  ///< which bits of `touched_` are choosers'
  /// choosers_[i].wake.at(), contiguous for the scans; padded with kNever
  std::vector<Tick> times_;
  /// by chooser: smallest distance from any other chooser, and its slack; padded
  std::vector<Tick> reach_;
};

}  // namespace quadrille::hw
