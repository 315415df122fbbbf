#include "pipeline/report/unit_facets.h"

#include "pipeline/report/report.h"

#include <algorithm>
#include <cmath>

namespace quadrille::pipeline {

namespace {

/// `facet` with the sums of its group's units.
std::string facet_text(const hw::Facet& facet, std::int64_t cycles) {
  using enum hw::Facet::Kind;
  switch (facet.kind) {
    case kCount: return fmt::format("{} {}", facet.label, grouped(static_cast<std::uint64_t>(facet.value)));
    case kRate: {
      const double rate = facet.value / static_cast<double>(std::max<std::int64_t>(1, cycles));
      return fmt::format("{} {:.2f}/clk ({:.0f} % of {:g})", facet.label, rate, 100 * rate / facet.peak,
                         facet.peak);
    }
    case kShare:
      if (facet.whole <= 0) return fmt::format("{} -", facet.label);
      return fmt::format("{} {:.1f} %", facet.label, 100 * facet.value / facet.whole);
    case kMean:
      if (facet.whole <= 0) return fmt::format("{} -", facet.label);
      return fmt::format("{} {:.2f}", facet.label, facet.value / facet.whole);
  }
  return {};
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
  for (const UnitFigures* unit : units)
    spread = std::max(spread, std::abs(share(unit->busy, unit->cycles) - mean));
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

std::vector<std::string> unit_facets(const UnitGroup& group) {
  std::vector<hw::Facet> row = group.units.front()->row;
  for (std::size_t u = 1; u < group.units.size(); ++u) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i].value += group.units[u]->row[i].value;
      row[i].whole += group.units[u]->row[i].whole;
    }
  }
  std::vector<std::string> texts;
  texts.reserve(row.size());
  for (const hw::Facet& facet : row) texts.push_back(facet_text(facet, group.cycles()));
  return texts;
}

std::string grouped(std::uint64_t value) {
  std::string digits = fmt::format("{}", value);
  for (std::size_t at = digits.size(); at > 3; at -= 3) digits.insert(at - 3, ",");
  return digits;
}

}  // namespace quadrille::pipeline
