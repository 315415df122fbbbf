#include "pipeline/report/figures.h"

#include "hw/frame/laws.h"
#include "pipeline/report/report.h"
#include "pipeline/report/sensitivity.h"

#include <algorithm>
#include <cmath>

namespace quadrille::pipeline {

namespace {

HistogramFigure figures_of(const hw::Histogram& h) {
  HistogramFigure f{std::string(h.name()),
                    std::string(h.unit()),
                    std::string(h.definition()),
                    {h.buckets().begin(), h.buckets().end()},
                    h.sum()};
  while (!f.buckets.empty() && f.buckets.back() == 0) f.buckets.pop_back();
  return f;
}

UnitFigures figures_of(const hw::Unit& unit, hw::Tick end) {
  UnitFigures f;
  f.path = unit.name();
  f.cycles = unit.total_cycles();
  f.busy = unit.busy_cycles();
  f.waiting = unit.waiting_cycles();
  f.starved = unit.starved_cycles();
  f.blocked = unit.blocked_cycles();
  f.idle = unit.idle_cycles();
  for (const hw::PortBase* port : unit.ports()) {
    if (port->waited() > 0)
      f.waits.push_back({port->name(), port->direction() == hw::PortBase::Direction::kIn, port->waited(),
                         port->fifo().path()});
  }
  std::ranges::stable_sort(f.waits, std::ranges::greater{}, &WaitFigure::cycles);
  for (const hw::Resource& r : unit.resources().all())
    f.resources.push_back(
        {std::string(r.name), std::string(r.serial), r.kind, r.total(end), r.at_end_of, r.memory});
  if (unit.stats() != nullptr) {
    for (const hw::Counter* c : unit.stats()->counters()) {
      f.counters.push_back(
          {std::string(c->name()), std::string(c->unit()), std::string(c->definition()), c->value()});
    }
    for (const hw::Histogram* h : unit.stats()->histograms()) f.histograms.push_back(figures_of(*h));
  }
  f.row = unit.row();
  return f;
}

/// The least time in which a link carries `tokens`, in ticks: a slot is taken from a push until its credit is
/// back, and `width` bounds the pushes of a cycle.
double least_ticks(const hw::FifoBase& link, std::uint64_t tokens) {
  if (tokens == 0) return 0;
  const auto last = static_cast<double>(tokens - 1);  // the frame may end with the last push
  const double round_trip = static_cast<double>(link.forward_lookahead() + link.credit_lookahead());
  const double cycle = static_cast<double>(link.producer()->clock().edge(1));
  return std::max(std::floor(last / link.spec().depth) * round_trip,
                  std::floor(last / link.spec().width) * cycle);
}

/// `quiet`: write-backs may go on behind the frame's end, up to there.
LinkFigures figures_of(const hw::FifoBase& link, const std::string& key, hw::Tick end, hw::Tick quiet) {
  const hw::LinkSpec& spec = link.spec();
  const hw::Tick over = std::max(end, link.last_push());
  return {link.path(),
          key,
          link.producer()->name(),
          link.consumer()->name(),
          spec.depth,
          spec.width,
          spec.latency,
          spec.credit_latency,
          link.pushes(),
          end > 0 ? least_ticks(link, link.pushes()) / static_cast<double>(over) : 0,
          link.held_until(quiet)};
}

/// Sum of a counter over the units of a kind.
template <class Unit>
std::uint64_t sum(const Machine& m, hw::Counter Unit::Stats::*counter) {
  std::uint64_t sum = 0;
  for (const Unit* unit : m.all<Unit>()) sum += (unit->stats()->*counter).value();
  return sum;
}

std::vector<ClientFigures> bandwidth(const Machine& m) {
  std::vector<ClientFigures> all;
  visit_client_kinds([&]<class Unit>(Needed) {
    if (m.all<Unit>().empty()) return;
    ClientFigures figures{std::string(name_of(Unit::kMemoryClient)), 0, 0};
    for (Unit* unit : m.all<Unit>()) {
      figures.read_bytes += unit->memory_port().stats().read_bytes.value();
      figures.write_bytes += unit->memory_port().stats().write_bytes.value();
    }
    all.push_back(std::move(figures));
  });
  return all;
}

/// All laws that a unit or the frame named: those of the pipeline in its order, then others.
std::vector<Check> checks_of(const Machine& m, const DeviceFrame& frame,
                             const std::optional<Detail>& detail) {
  hw::Audit audit;
  for (const hw::Unit* unit : m.units()) unit->audit(audit);
  audit.right(hw::laws::kDrawsOfFrame, frame.frame.draws.size());
  if (!frame.frame.passes.empty())
    audit.right(hw::laws::kScanOut, frame.frame.passes.back().picture().surface.pixel_bytes_of_all());
  audit.left(hw::laws::kDirtyLines, frame.memory.dirty_lines());
  if (detail) detail->audit(audit);
  const auto place = [](const hw::Audit::Sides& sides) {
    return std::ranges::find(hw::laws::kAll, sides.law) - hw::laws::kAll.begin();
  };
  std::vector<hw::Audit::Sides> all = audit.all();
  std::ranges::stable_sort(all, {}, place);
  std::vector<Check> checks;
  checks.reserve(all.size());
  for (const hw::Audit::Sides& s : all)
    checks.push_back(
        {std::string(s.law->text), std::string(s.law->left), std::string(s.law->right), s.left, s.right});
  return checks;
}

}  // namespace

bool Figures::checks_hold() const { return std::ranges::all_of(checks, &Check::holds); }

std::uint64_t memory_bytes(const Figures& figures) {
  std::uint64_t bytes = 0;
  for (const UnitFigures& unit : figures.units) {
    if (without_number(unit.path) != "memory") continue;
    for (const CounterFigure& c : unit.counters)
      bytes += c.name == "read_bytes" || c.name == "write_bytes" ? c.value : 0;
  }
  return bytes;
}

namespace {

Fates fates_of(const Machine& m) {
  using Clipper = hw::Clipper;
  using SetUp = hw::TriangleSetupUnit;
  using Depth = hw::DepthUnit::Stats;
  return {.off_screen = sum<Clipper>(m, &Clipper::Stats::rejected) + sum<SetUp>(m, &SetUp::Stats::offscreen),
          .not_finite = sum<Clipper>(m, &Clipper::Stats::not_finite),
          .culled = sum<Clipper>(m, &Clipper::Stats::culled) + sum<SetUp>(m, &SetUp::Stats::culled),
          .no_area = sum<SetUp>(m, &SetUp::Stats::zero_area),
          .no_sample = sum<SetUp>(m, &SetUp::Stats::no_sample),
          .rasterised = sum<SetUp>(m, &SetUp::Stats::kept),
          .tiles_hidden = sum<hw::CoarseRaster>(m, &hw::CoarseRaster::Stats::tiles_hidden),
          .hidden = sum<hw::DepthUnit>(m, &Depth::early_killed) + sum<hw::DepthUnit>(m, &Depth::late_killed),
          .discarded = sum<hw::Rop>(m, &hw::Rop::Stats::discarded)};
}

}  // namespace

Figures collect_figures(const Machine& m, const DeviceFrame& frame, std::optional<Detail> detail) {
  Figures f;
  f.detail = std::move(detail);
  if (f.detail) f.queries = query_figures(frame.queries, frame.frame, *f.detail);
  using Core = hw::ShaderCore::Stats;
  f.frame.cycles = m.clock().edges_before(m.end());
  f.frame.render_cycles = m.clock().edges_before(m.one<hw::CommandProcessor>().render_end());
  f.frame.clock_mhz = static_cast<double>(m.clock().frequency_hz()) * 1e-6;
  const hw::CommandProcessor::Stats& commands = *m.one<hw::CommandProcessor>().stats();
  f.frame.draws = commands.draws.value() + commands.draws_culled.value();
  f.frame.triangles = sum<hw::PrimitiveAssembly>(m, &hw::PrimitiveAssembly::Stats::triangles);
  f.frame.vertices = sum<hw::ShaderCore>(m, &Core::vertices);
  f.frame.fragments_covered = sum<hw::FineRaster>(m, &hw::FineRaster::Stats::fragments);
  f.frame.fragments_shaded = sum<hw::ShaderCore>(m, &Core::fragments);
  f.frame.helper_lanes = sum<hw::ShaderCore>(m, &Core::helper_lanes);
  f.frame.fragment_warps = sum<hw::ShaderCore>(m, &Core::fragment_warps);
  f.frame.fragments_written = sum<hw::Rop>(m, &hw::Rop::Stats::written);
  f.frame.fates = fates_of(m);
  for (const hw::Unit* unit : m.units()) f.units.push_back(figures_of(*unit, m.end()));
  for (const hw::Unit* unit : m.units()) {
    if (!unit->resources().empty())
      f.slice_cycles = static_cast<double>(unit->resources().slice()) *
                       static_cast<double>(m.clock().frequency_hz()) * 1e-15;
  }
  const hw::Tick quiet = m.quiet_end();
  f.moving_cycles = m.clock().edges_before(quiet);
  for (std::size_t i = 0; i < m.links().size(); ++i)
    f.links.push_back(figures_of(*m.links()[i], m.link_keys()[i], m.end(), quiet));
  f.bandwidth = bandwidth(m);
  f.checks = checks_of(m, frame, f.detail);
  // The counted work at its peak rates fits into the frame.
  const auto light = static_cast<std::int64_t>(std::ceil(speed_of_light(f).cycles - 1e-6));
  f.checks.push_back({"cycles are not below the least time of the counted work",
                      "frame.cycles below frame.least_cycles", "none",
                      static_cast<std::uint64_t>(std::max<std::int64_t>(0, light - f.frame.cycles)), 0});
  f.left_out = m.left_out();
  f.host.actions = m.driver().actions();
  return f;
}

}  // namespace quadrille::pipeline
