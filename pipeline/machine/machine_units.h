/// How each kind of unit is made: which of the machine's stores, clocks and counts its constructor gets.
#pragma once

#include "pipeline/machine/machine.h"

#include <type_traits>

namespace quadrille::pipeline {

class Machine::Maker {
 public:
  explicit Maker(Machine& machine) : m_(machine), c_(machine.config_), s_(machine.stores_) {}

  template <class Unit>
  using Made = std::unique_ptr<Unit>;
  template <class Unit>
  using Kind = std::type_identity<Unit>;
  /// The unit called `name`, number `i` of its kind.
#define QUADRILLE_MAKE(path, type, how_often, frames) \
  [[nodiscard]] Made<type> make(Kind<type> kind, const char* name, int i) const;
  QUADRILLE_UNITS(QUADRILLE_MAKE)
#undef QUADRILLE_MAKE

 private:
  template <class Unit>
  [[nodiscard]] hw::UnitContext context(Kind<Unit> kind, int number) const {
    return context(kind, number, m_.clock_);
  }
  template <class Unit>
  [[nodiscard]] hw::UnitContext context(Kind<Unit> /*kind*/, int number, const hw::Clock& clock) const {
    return {m_.clock_of_kind(UnitKind<Unit>::name, clock),
            m_.frame_.frame,
            m_.frame_.memory,
            {c_.gpu.cores, c_.gpu.partitions, c_.gpu.channels, c_.gpu.engines, c_.gpu.front_ends},
            number};
  }

  [[nodiscard]] hw::Store<hw::ClippedPiece>& pieces_between(int front_end, int engine) const {
    return *s_.pieces[static_cast<std::size_t>(engine * c_.gpu.front_ends + front_end)];
  }

  /// Those of a partition come from its engine.
  [[nodiscard]] hw::TriangleStore& triangles_of_partition(hw::PartitionId partition) const {
    return *s_.triangles[models::engine_of_partition(partition,
                                                     static_cast<std::uint32_t>(c_.gpu.engines.value()))];
  }

  Machine& m_;
  const MachineConfig& c_;
  Stores& s_;
};

}  // namespace quadrille::pipeline
