/// Runs a small world and hands its figures to a check; each run is a forked process.
#pragma once

#include "hw/base/dispatcher.h"
#include "tests/hw/base/worlds.h"

namespace quadrille::hw::world {

/// The outcome of `spec` with the plain dispatcher, all charges closed at `end` (kNever: after the last
/// action).
inline contract::Outcome outcome_of(const WorldSpec& spec, Tick end = kNever) {
  class Ending final : public contract::Specimen {
   public:
    Ending(const WorldSpec& s, Driver& driver, const contract::Variation& v, Tick at)
        : world_(s, driver, v), end_(at) {}
    [[nodiscard]] std::uint64_t digest() const override { return world_.digest(); }
    [[nodiscard]] Tick end() const override { return end_; }

   private:
    World world_;
    Tick end_;
  };
  return contract::run_forked(
      [&](Driver& driver, const contract::Variation& v) {
        return std::make_unique<Ending>(spec, driver, v, end);
      },
      {});
}

inline contract::Builder builder_of(WorldSpec spec) {
  return [spec = std::move(spec)](Driver& driver, const contract::Variation& v) {
    return std::make_unique<World>(spec, driver, v);
  };
}

}  // namespace quadrille::hw::world
