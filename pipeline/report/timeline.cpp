#include "pipeline/report/timeline.h"

#include <algorithm>
#include <cmath>

namespace quadrille::pipeline {

namespace {

/// By slice, from what a resource had come to at the end of each. `cycles`: of the unit's clock, the frame.
std::vector<double> shares_of(const ResourceFigure& resource, const Timeline& line, std::int64_t cycles) {
  const double unit_cycles =
      static_cast<double>(cycles) / static_cast<double>(std::max<std::int64_t>(1, line.cycles));
  std::vector<double> shares;
  double before = 0;
  for (std::size_t s = 0; s < line.slices; ++s) {
    const double now = s < resource.at_end_of.size() ? resource.at_end_of[s] : before;
    const double length = line.length_of(s) * unit_cycles;
    shares.push_back(length > 0 ? (now - before) / length : 0);
    before = now;
  }
  return shares;
}

/// Each draw goes to the first row that is free when it begins.
std::vector<std::vector<DrawSpan>> rows_of(const std::vector<DrawFigures>& draws) {
  std::vector<DrawSpan> spans;
  for (std::size_t i = 0; i < draws.size(); ++i) spans.push_back({i, draws[i].issued, draws[i].retired});
  std::ranges::stable_sort(spans, {}, &DrawSpan::begin);
  std::vector<std::vector<DrawSpan>> rows;
  for (const DrawSpan& span : spans) {
    const auto free =
        std::ranges::find_if(rows, [&](const auto& row) { return row.back().end <= span.begin; });
    if (free == rows.end()) rows.push_back({span});
    else free->push_back(span);
  }
  return rows;
}

}  // namespace

double Timeline::length_of(std::size_t slice) const {
  return std::min(slice_cycles, static_cast<double>(cycles) - begin_of(slice));
}

Timeline timeline_of(const Figures& figures) {
  Timeline line;
  line.cycles = figures.frame.cycles;
  line.slice_cycles = figures.slice_cycles > 0 ? figures.slice_cycles : static_cast<double>(line.cycles);
  if (line.slice_cycles > 0)
    line.slices = static_cast<std::size_t>(std::ceil(static_cast<double>(line.cycles) / line.slice_cycles));
  for (const UnitFigures& unit : figures.units) {
    UnitCurves curves{unit.path, {}};
    for (const ResourceFigure& r : unit.resources)
      curves.resources.push_back({r.name, r.kind, shares_of(r, line, unit.cycles)});
    if (!curves.resources.empty()) line.units.push_back(std::move(curves));
  }
  if (figures.detail && figures.detail->wanted.draws) line.draw_rows = rows_of(figures.detail->draws);
  return line;
}

}  // namespace quadrille::pipeline
