#include "pipeline/unit_facets.h"

#include "pipeline/report.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace quadrille::pipeline {

namespace {

struct Facet {
  enum class Kind : std::uint8_t {
    kCount,  ///< the counter
    kShare,  ///< value / of, in per cent
    kMean,   ///< value / of
    kRate    ///< value a cycle and unit, and its share of the peak: the parameter `of` times `scale`
  };
  std::string_view label;
  Kind kind;
  std::string_view value;    ///< a counter
  std::string_view of = {};  ///< counters joined by '+', or the path of a parameter
  int scale = 1;
};

using enum Facet::Kind;
constexpr int kQuadPixels = 4;

/// The kinds of units in the order of the pipeline.
const std::map<std::string_view, std::vector<Facet>>& facet_table() {
  static const std::map<std::string_view, std::vector<Facet>> table{
      {"command_processor", {{"draws", kCount, "draws"}, {"passes", kCount, "passes"}}},
      {"vertex_fetch",
       {{"indices", kRate, "indices", "vertex_fetch.indices_per_clk"},
        {"indices/vertex", kMean, "indices", "vertices"},
        {"attributes", kRate, "attribute_fetches", "vertex_fetch.attributes_per_clk"},
        {"cache hit", kShare, "cache_hits", "cache_requests"}}},
      {"primitive_assembly",
       {{"triangles", kCount, "triangles"},
        {"vertices/batch", kMean, "vertices", "batches"},
        {"triangles/batch", kMean, "triangles", "batches"}}},
      {"clipper",
       {{"inside", kShare, "passed", "triangles"},
        {"cut", kShare, "clipped", "triangles"},
        {"outside", kShare, "rejected", "triangles"},
        {"pieces", kCount, "pieces"}}},
      {"triangle_setup",
       {{"kept", kShare, "kept", "triangles"},
        {"culled", kShare, "culled", "triangles"},
        {"no area", kShare, "zero_area", "triangles"},
        {"off screen", kShare, "offscreen", "triangles"},
        {"no sample", kShare, "no_sample", "triangles"}}},
      {"coarse_raster",
       {{"tile tests", kRate, "tiles_tested", "coarse_raster.tests_per_clk"},
        {"tiles/triangle", kMean, "tiles_kept", "triangles"},
        {"kept", kShare, "tiles_kept", "tiles_tested"},
        {"Hi-Z hid", kShare, "tiles_hidden", "tiles_kept+tiles_hidden"}}},
      {"fine_raster",
       {{"quads", kRate, "quads", "fine_raster.quads_per_clk"},
        {"fragments/quad", kMean, "fragments", "quads"},
        {"quads/tile", kMean, "quads", "tiles"},
        {"full tiles", kShare, "tiles_full", "tiles"}}},
      {"depth",
       {{"fragments", kRate, "fragments_in", "depth.quads_per_clk", kQuadPixels},
        {"killed early", kShare, "early_killed", "fragments_in"},
        {"tested late", kShare, "late_tested", "fragments_in"},
        {"killed late", kCount, "late_killed"},
        {"cache hit", kShare, "cache_hits", "cache_requests"}}},
      {"warp_packer",
       {{"quads", kRate, "quads", "warp_packer.quads_per_clk"},
        {"live lanes/warp", kMean, "fragments", "warps"},
        {"partial warps", kShare, "partial_warps", "warps"}}},
      {"work_distributor", {{"vertex warps", kCount, "vertex_warps"}, {"fragment warps", kCount, "fragment_warps"}}},
      {"core",
       {{"SIMDs held", kRate, "simd_busy", "core.simds"},
        {"instructions", kCount, "instructions"},
        {"lanes/instruction", kMean, "lane_operations", "instructions"},
        {"special function", kShare, "sfu_instructions", "instructions"},
        {"texture", kShare, "texture_instructions", "instructions"}}},
      {"texture",
       {{"bilinear quads", kRate, "bilinear_quads", "texture.filter_quads_per_clk"},
        {"requests", kCount, "requests"},
        {"lanes/request", kMean, "lanes", "requests"},
        {"cache hit", kShare, "cache_hits", "cache_requests"},
        {"merged", kShare, "cache_merged", "cache_requests"}}},
      {"rop",
       {{"written", kRate, "written", "rop.quads_per_clk", kQuadPixels},
        {"written", kShare, "written", "fragments_in"},
        {"discarded", kShare, "discarded", "fragments_in"},
        {"blended", kShare, "blended", "written"},
        {"cache hit", kShare, "cache_hits", "cache_requests"}}},
      {"l2",
       {{"requests", kCount, "requests"},
        {"hit", kShare, "hits", "requests"},
        {"merged", kShare, "merged", "requests"},
        {"missed", kShare, "misses", "requests"}}},
      {"memory",
       {{"accesses", kCount, "reads+writes"},
        {"row hit", kShare, "row_hits", "reads+writes"},
        {"data bus held", kShare, "bus_busy", "cycles"},
        {"refresh", kShare, "bus_refresh", "cycles"},
        {"turn-around", kShare, "bus_turnaround", "cycles"},
        {"activation", kShare, "bus_activation", "cycles"},
        {"spacing", kShare, "bus_spacing", "cycles"},
        {"in queue", kMean, "queue_occupancy", "cycles"}}},
      {"scan_out", {{"lines", kCount, "lines"}}}};
  return table;
}

/// The sum of counters joined by '+'; "cycles" are the units' own.
double value_of(const UnitGroup& group, std::string_view names) {
  if (names == "cycles") return static_cast<double>(group.cycles());
  double sum = 0;
  for (std::string_view rest = names; !rest.empty();) {
    const std::size_t plus = std::min(rest.find('+'), rest.size());
    sum += static_cast<double>(group.counter(rest.substr(0, plus)));
    rest.remove_prefix(std::min(rest.size(), plus + 1));
  }
  return sum;
}

double parameter(const MachineConfig& machine, std::string_view path) {
  const std::size_t dot = path.rfind('.');
  for (const auto& [name, group] : machine.groups()) {
    if (name != path.substr(0, dot)) continue;
    if (const hw::ParamBase* p = group->find(path.substr(dot + 1))) return std::stod(p->value_text());
  }
  QUADRILLE_CHECK(false, "no parameter {}", path);
  return 0;
}

std::string facet_text(const Facet& facet, const UnitGroup& group, const MachineConfig& machine) {
  const double value = value_of(group, facet.value);
  if (facet.kind == kCount) return fmt::format("{} {}", facet.label, grouped(static_cast<std::uint64_t>(value)));
  if (facet.kind == kRate) {
    const double peak = facet.scale * parameter(machine, facet.of);
    const double rate = value / static_cast<double>(std::max<std::int64_t>(1, group.cycles()));
    return fmt::format("{} {:.2f}/clk ({:.0f} % of {:g})", facet.label, rate, 100 * rate / peak, peak);
  }
  const double whole = value_of(group, facet.of);
  if (whole <= 0) return fmt::format("{} -", facet.label);
  if (facet.kind == kShare) return fmt::format("{} {:.1f} %", facet.label, 100 * value / whole);
  return fmt::format("{} {:.2f}", facet.label, value / whole);
}

}  // namespace

std::int64_t UnitGroup::sum(std::int64_t UnitFigures::*member) const {
  std::int64_t total = 0;
  for (const UnitFigures* unit : units) total += unit->*member;
  return total;
}

std::uint64_t UnitGroup::counter(std::string_view counter_name) const {
  std::uint64_t total = 0;
  for (const UnitFigures* unit : units) {
    const auto found = std::ranges::find(unit->counters, counter_name, &CounterFigure::name);
    QUADRILLE_CHECK(found != unit->counters.end(), "{} has no counter {}", unit->path, counter_name);
    total += found->value;
  }
  return total;
}

double UnitGroup::busy_spread() const {
  const auto share = [](std::int64_t busy, std::int64_t of) {
    return of > 0 ? 100.0 * static_cast<double>(busy) / static_cast<double>(of) : 0.0;
  };
  const double mean = share(sum(&UnitFigures::busy), cycles());
  double spread = 0;
  for (const UnitFigures* unit : units) spread = std::max(spread, std::abs(share(unit->busy, unit->cycles) - mean));
  return spread;
}

std::vector<UnitGroup> group_units(std::span<const UnitFigures> units, bool folded) {
  std::vector<UnitGroup> groups;
  for (const UnitFigures& unit : units) {
    const std::string kind(without_number(unit.path));
    const auto known = std::ranges::find(groups, kind, &UnitGroup::kind);
    if (folded && known != groups.end()) {
      known->units.push_back(&unit);
    } else {
      groups.push_back({kind, unit.path, {&unit}});
    }
  }
  return groups;
}

std::vector<std::string> unit_facets(const UnitGroup& group, const MachineConfig& machine) {
  std::vector<std::string> texts;
  const auto facets = facet_table().find(group.kind);
  if (facets == facet_table().end()) return texts;
  for (const Facet& facet : facets->second) texts.push_back(facet_text(facet, group, machine));
  return texts;
}

std::string grouped(std::uint64_t value) {
  std::string digits = fmt::format("{}", value);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, ",");
  return digits;
}

}  // namespace quadrille::pipeline
