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

/// Lengths of the slices in which bytes and tokens move, in ticks.
std::vector<double> moving_ticks(const FlowFigures& flow) {
  std::vector<double> ticks;
  ticks.reserve(flow.slices);
  for (std::size_t s = 0; s < flow.slices; ++s) ticks.push_back(static_cast<double>(flow.length_of(s)));
  return ticks;
}

/// `amount` of each slice over `factor` times its length.
FlowCurve flow_curve(std::string name, const std::vector<std::uint64_t>& amount, const FlowFigures& flow,
                     double factor) {
  FlowCurve curve{std::move(name), moving_ticks(flow)};
  for (std::size_t s = 0; s < flow.slices; ++s) {
    const double over = curve.value[s] * factor;
    curve.value[s] = over > 0 ? static_cast<double>(amount[s]) / over : 0;
  }
  return curve;
}

void add_if_any(std::vector<FlowCurve>& curves, FlowCurve curve) {
  if (std::ranges::any_of(curve.value, [](double v) { return v > 0; })) curves.push_back(std::move(curve));
}

/// Bytes a cycle of the GPU clock.
std::vector<FlowCurve> bytes_of(const std::vector<ClientCurve>& clients, const Figures& f) {
  const double cycles_a_tick = f.frame.clock_mhz / 1e9;
  std::vector<FlowCurve> curves;
  curves.reserve(2 * clients.size());
  for (const ClientCurve& c : clients) {
    add_if_any(curves, flow_curve(c.client + " read", c.read, *f.flow, cycles_a_tick));
    add_if_any(curves, flow_curve(c.client + " written", c.written, *f.flow, cycles_a_tick));
  }
  return curves;
}

std::vector<FlowCurve> tokens_of(const Figures& f) {
  std::vector<FlowCurve> curves;
  curves.reserve(f.flow->links.size());
  for (const LinkCurve& link : f.flow->links) {
    const auto links = static_cast<double>(std::ranges::count(f.links, link.key, &LinkFigures::key));
    add_if_any(curves, flow_curve(std::string(class_of(link.key)), link.held, *f.flow, links));
  }
  return curves;
}

std::vector<FlowCurves> flow_of(const Figures& f) {
  if (!f.flow) return {};
  return {{"L2 cache", "B/cycle", bytes_of(f.flow->asked, f)},
          {"memory", "B/cycle", bytes_of(f.flow->memory, f)},
          {"links", "tokens", tokens_of(f)}};
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
  return std::clamp(static_cast<double>(cycles) - begin_of(slice), 0.0, slice_cycles);
}

Timeline timeline_of(const Figures& figures) {
  Timeline line;
  line.cycles = figures.frame.cycles;
  line.slice_cycles = figures.slice_cycles > 0 ? figures.slice_cycles : static_cast<double>(line.cycles);
  if (line.slice_cycles > 0)
    line.slices = static_cast<std::size_t>(std::ceil(static_cast<double>(line.cycles) / line.slice_cycles));
  if (figures.flow) line.slices = figures.flow->slices;
  for (const UnitFigures& unit : figures.units) {
    UnitCurves curves{unit.path, {}};
    for (const ResourceFigure& r : unit.resources)
      curves.resources.push_back({r.name, r.kind, shares_of(r, line, unit.cycles)});
    if (!curves.resources.empty()) line.units.push_back(std::move(curves));
  }
  line.flow = flow_of(figures);
  if (figures.detail && figures.detail->wanted.draws) line.draw_rows = rows_of(figures.detail->draws);
  return line;
}

}  // namespace quadrille::pipeline
