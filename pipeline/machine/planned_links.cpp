#include "pipeline/machine/planned_links.h"

#include "pipeline/machine/machine_config.h"

#include <algorithm>
#include <set>

namespace quadrille::pipeline {

namespace {

/// "TileToken" of `quadrille::hw::TileToken`, as the compiler spells it.
template <class T>
std::string type_name() {
  std::string_view text = __PRETTY_FUNCTION__;
  text.remove_prefix(text.find("T = ") + 4);
  text = text.substr(0, text.find_first_of("];"));
  return std::string(text.substr(text.rfind(':') + 1));
}

/// The kinds of units at an end of a link: one, or all clients of the L2 cache.
template <class End>
std::vector<std::string_view> kinds_at() {
  if constexpr (std::is_same_v<End, hw::MemoryPort>) {
    std::vector<std::string_view> clients;
    visit_unit_kinds([&]<class Unit>() {
      if constexpr (MemoryClientUnit<Unit>) clients.push_back(UnitKind<Unit>::name);
    });
    return clients;
  } else {
    return {UnitKind<End>::name};
  }
}

template <class Wire>
void add_wire(std::string_view name, LinkWay way, std::vector<PlannedLink>& links) {
  for (const std::string_view from : kinds_at<typename Wire::From>())
    for (const std::string_view to : kinds_at<typename Wire::To>())
      links.push_back({name, from, to, type_name<typename Wire::Token>(), way});
}

template <class... Wires>
void add_class(std::string_view name, LinkWay way, std::vector<PlannedLink>& links) {
  (add_wire<Wires>(name, way, links), ...);
}

/// Puts what lies downstream of a kind, and then the kind, before all that is in `order`: ways are followed
/// from the last to the first.
void follow(std::string_view kind, std::set<std::string_view>& seen, std::vector<std::string_view>& order) {
  if (!seen.insert(kind).second) return;
  const std::vector<PlannedLink>& links = planned_links();
  for (auto link = links.rbegin(); link != links.rend(); ++link)
    if (link->way == LinkWay::kOnward && link->from == kind) follow(link->to, seen, order);
  order.insert(order.begin(), kind);
}

}  // namespace

const std::vector<PlannedLink>& planned_links() {
  static const std::vector<PlannedLink> links = [] {
    std::vector<PlannedLink> all;
#define QUADRILLE_LINK(name, depth, width, latency, flow, way, ...) \
  add_class<__VA_ARGS__>(#name, LinkWay::way, all);
    QUADRILLE_LINKS(QUADRILLE_LINK)
#undef QUADRILLE_LINK
    return all;
  }();
  return links;
}

const std::vector<PlannedUnit>& planned_units() {
  static const std::vector<PlannedUnit> units = [] {
    std::vector<PlannedUnit> all;
    visit_unit_kinds([&]<class Unit>() {
      all.push_back({UnitKind<Unit>::name, UnitKind<Unit>::stands, UnitKind<Unit>::needed});
    });
    return all;
  }();
  return units;
}

const std::vector<std::string_view>& kinds_downstream() {
  static const std::vector<std::string_view> order = [] {
    std::vector<std::string_view> found;
    std::set<std::string_view> seen;
    for (const PlannedUnit& unit : planned_units()) follow(unit.kind, seen, found);
    return found;
  }();
  return order;
}

int count_of(Stands stands, const GpuParams& gpu) {
  switch (stands) {
    case Stands::kOnce: return 1;
    case Stands::kFrontEnd: return gpu.front_ends;
    case Stands::kEngine: return gpu.engines;
    case Stands::kPartition: return gpu.partitions;
    case Stands::kCore: return gpu.cores;
    case Stands::kChannel: return gpu.channels;
  }
  return 0;
}

}  // namespace quadrille::pipeline
