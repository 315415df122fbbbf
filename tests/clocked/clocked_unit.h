/// The synthetic units as clocked state machines. `Role` in world_spec.h says what each does.
#pragma once

#include "tests/clocked/clocked_link.h"

#include <vector>

namespace quadrille::clocked {

/// One end of a link as a unit sees it.
struct Pin {
  ClockedLink* link = nullptr;
  bool together = false;  ///< the other end's clock has an edge at this moment
};

class ClockedUnit {
 public:
  explicit ClockedUnit(const hw::world::UnitSpec& spec);
  /// One edge of the unit's clock, at `now` femtoseconds.
  void tick(std::int64_t now);

  std::vector<Pin> in, out;
  std::vector<hw::world::Event> events;

 private:
  /// One action if one is possible now; the cycles it keeps the unit, or 0 if none is.
  int try_one();
  int move_one();         ///< stage, fork, route, recycle, join
  int generate_or_eat();  ///< source, sink
  int hold_one();         ///< serial, expand, pack
  int merge();            ///< arbiter, priority
  int spread();
  int core();
  int memory();

  [[nodiscard]] bool ready(std::size_t i) const { return in[i].link->can_pop(); }
  [[nodiscard]] bool room(std::size_t i) const { return out[i].link->can_push(); }
  hw::world::Token pop(std::size_t i) { return in[i].link->pop(in[i].together); }
  void push(std::size_t i, hw::world::Token t) { out[i].link->push(t, out[i].together); }
  int done(char what, std::size_t port, std::uint32_t id, int cycles);

  struct Place {  ///< a core's context or a memory's slot
    enum class Phase { kEmpty, kAsk, kWait, kReady } phase = Phase::kEmpty;
    int cycles_left = 0, requests_left = 0;  ///< cycles below 0: done for so long
    int order = 0;                           ///< of acceptance
    std::size_t port = 0;
    hw::world::Token token;
  };
  [[nodiscard]] Place* find(Place::Phase phase);

  hw::world::UnitSpec spec_;
  std::vector<Place> places_;
  int busy_edges_ = 0;  ///< edges that pass before the next action
  std::int64_t now_ = 0;
  std::uint32_t number_ = 0;  ///< tokens sent or eaten
  hw::world::Token held_;
  int held_count_ = 0;
  std::size_t turn_ = 0;
  int accepted_ = 0;
};

}  // namespace quadrille::clocked
