#include "pipeline/machine/counter_catalogue.h"

#include "pipeline/machine/machine_plan.h"

namespace quadrille::pipeline {
namespace {

/// The counters that a unit declares, and those of the parts it is made of, which register with its group.
template <class Stats, class... OfParts>
struct Declared : Stats, OfParts... {
  Declared() : OfParts(static_cast<Stats&>(*this))... {}
};

template <class Stats, class... OfParts>
std::shared_ptr<const hw::StatGroup> declared(hw::Parts<OfParts...> /*parts*/) {
  return std::make_shared<Declared<Stats, OfParts...>>();
}

template <class Unit>
std::shared_ptr<const hw::StatGroup> counters_of() {
  if constexpr (requires { typename Unit::CounterParts; })
    return declared<typename Unit::Stats>(typename Unit::CounterParts());
  else return declared<typename Unit::Stats>(hw::Parts<>());
}

}  // namespace

std::vector<UnitCounters> counter_catalogue() {
  std::vector<UnitCounters> all;
  visit_unit_kinds([&]<class Unit>() { all.push_back({UnitKind<Unit>::name, counters_of<Unit>()}); });
  return all;
}

}  // namespace quadrille::pipeline
