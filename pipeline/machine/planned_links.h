/// The links of the plan as data: what the block diagram, the order of the flow and the tests walk. No
/// machine is built.
#pragma once

#include "pipeline/machine/machine_plan.h"

#include <string>
#include <string_view>
#include <vector>

namespace quadrille::pipeline {

/// A wire of a class of links between two kinds of units.
struct PlannedLink {
  std::string_view name;      ///< of the class: "core_to_rop"
  std::string_view from, to;  ///< kinds of units
  std::string token;          ///< what it carries: "TileToken"
  LinkWay way = LinkWay::kOnward;
};
/// In the plan's order. A class that joins clients to the L2 cache has a link for each kind of client.
[[nodiscard]] const std::vector<PlannedLink>& planned_links();

struct PlannedUnit {
  std::string_view kind;
  Stands stands = Stands::kOnce;
  Needed needed = Needed::kByAllFrames;
};
/// In the plan's order.
[[nodiscard]] const std::vector<PlannedUnit>& planned_units();
struct GpuParams;
/// How many units of a kind a machine has.
[[nodiscard]] int count_of(Stands stands, const GpuParams& gpu);

/// Kinds of units from up- to downstream: work comes to a unit from those before it. Where ways part, the
/// units on a way listed earlier come before those on a later one. Where a way leads back (the cores shade
/// vertices and then their fragments) a unit has the place that the way listed last gives it.
[[nodiscard]] const std::vector<std::string_view>& kinds_downstream();

}  // namespace quadrille::pipeline
