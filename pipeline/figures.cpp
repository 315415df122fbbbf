#include "pipeline/figures.h"

#include "pipeline/report.h"
#include "pipeline/sensitivity.h"

#include <algorithm>
#include <cmath>

namespace quadrille::pipeline {

namespace {

std::uint64_t value(const hw::Unit& unit, std::string_view counter) {
  for (const hw::Counter* c : unit.stats()->counters()) {
    if (c->name() == counter) return c->value();
  }
  QUADRILLE_CHECK(false, "{} has no counter {}", unit.name(), counter);
  return 0;
}

HistogramFigure figures_of(const hw::Histogram& h) {
  HistogramFigure f{
      std::string(h.name()), std::string(h.unit()), std::string(h.definition()), {h.buckets().begin(), h.buckets().end()}, h.sum()};
  while (!f.buckets.empty() && f.buckets.back() == 0) f.buckets.pop_back();
  return f;
}

UnitFigures figures_of(const hw::Unit& unit) {
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
      f.waits.push_back({port->name(), port->direction() == hw::PortBase::Direction::kIn, port->waited(), port->fifo().path()});
  }
  std::ranges::stable_sort(f.waits, std::ranges::greater{}, &WaitFigure::cycles);
  for (const hw::Resource& r : unit.resources().all())
    f.resources.push_back({std::string(r.name), std::string(r.serial), r.kind == hw::Resource::Kind::kPlaces, r.total(), r.at_end_of});
  if (unit.stats() != nullptr) {
    for (const hw::Counter* c : unit.stats()->counters()) {
      f.counters.push_back({std::string(c->name()), std::string(c->unit()), std::string(c->definition()), c->value()});
    }
    for (const hw::Histogram* h : unit.stats()->histograms()) f.histograms.push_back(figures_of(*h));
  }
  return f;
}

/// The least time in which a link carries `tokens`, in ticks: a slot is taken from a push until its credit is back, and `width` bounds the pushes of a cycle.
double least_ticks(const hw::FifoBase& link, std::uint64_t tokens) {
  if (tokens == 0) return 0;
  const auto last = static_cast<double>(tokens - 1);  // the frame may end with the last push
  const double round_trip = static_cast<double>(link.forward_lookahead() + link.credit_lookahead());
  const double cycle = static_cast<double>(link.producer()->clock().edge(1));
  return std::max(std::floor(last / link.spec().depth) * round_trip, std::floor(last / link.spec().width) * cycle);
}

LinkFigures figures_of(const hw::FifoBase& link, const std::string& key, hw::Tick end) {
  const hw::LinkSpec& spec = link.spec();
  return {link.path(),
          key,
          link.producer()->name(),
          link.consumer()->name(),
          spec.depth,
          spec.width,
          spec.latency,
          spec.credit_latency,
          link.pushes(),
          end > 0 ? least_ticks(link, link.pushes()) / static_cast<double>(end) : 0};
}

/// Sums over the units of a kind.
class Sums {
 public:
  explicit Sums(const Machine& m) : m_(m) {}
  [[nodiscard]] std::uint64_t core(std::string_view c) const { return over(m_.cores(), c, &Machine::Core::core); }
  [[nodiscard]] std::uint64_t texture(std::string_view c) const { return over(m_.cores(), c, &Machine::Core::texture); }
  [[nodiscard]] std::uint64_t depth(std::string_view c) const { return over(m_.partitions(), c, &Machine::Partition::depth); }
  [[nodiscard]] std::uint64_t packer(std::string_view c) const { return over(m_.partitions(), c, &Machine::Partition::packer); }
  [[nodiscard]] std::uint64_t rop(std::string_view c) const { return over(m_.partitions(), c, &Machine::Partition::rop); }
  [[nodiscard]] std::uint64_t l2(std::string_view c) const { return plain(m_.slices(), c); }
  [[nodiscard]] std::uint64_t memory(std::string_view c) const { return plain(m_.channels(), c); }

 private:
  template <class V, class M>
  static std::uint64_t over(const V& all, std::string_view counter, M member) {
    std::uint64_t sum = 0;
    for (const auto& one : all) {
      if (one.*member) sum += value(*(one.*member), counter);
    }
    return sum;
  }
  template <class V>
  static std::uint64_t plain(const V& all, std::string_view counter) {
    std::uint64_t sum = 0;
    for (const auto& one : all) sum += value(*one, counter);
    return sum;
  }
  const Machine& m_;
};

std::vector<ClientFigures> bandwidth(const Machine& m) {
  const Sums sum(m);
  const hw::Unit& fetch = m.vertex_fetch();
  const hw::Unit& scan = m.scan_out();
  std::vector<ClientFigures> all{{"vertex_fetch", value(fetch, "read_bytes"), value(fetch, "write_bytes")}};
  if (m.cores()[0].texture) all.push_back({"texture", sum.texture("read_bytes"), sum.texture("write_bytes")});
  all.push_back({"depth", sum.depth("read_bytes"), sum.depth("write_bytes")});
  all.push_back({"color", sum.rop("read_bytes"), sum.rop("write_bytes")});
  all.push_back({"scan_out", value(scan, "read_bytes"), value(scan, "write_bytes")});
  return all;
}

class Laws {
 public:
  Laws(const Machine& m, const DeviceFrame& frame, const std::vector<ClientFigures>& clients)
      : m_(m), frame_(frame), clients_(clients), sum_(m) {}

  std::vector<Check> all() {
    geometry();
    fragments();
    caches();
    bytes();
    return std::move(checks_);
  }

 private:
  void law(std::string name, std::string left_name, std::uint64_t left, std::string right_name, std::uint64_t right) {
    checks_.push_back({std::move(name), std::move(left_name), std::move(right_name), left, right});
  }

  void geometry() {
    const hw::Unit& command = m_.command_processor();
    const hw::Unit& fetch = m_.vertex_fetch();
    const hw::Unit& assembly = m_.assembly();
    const hw::Unit& clipper = m_.clipper();
    const hw::Unit& setup = m_.setup();
    law("draws issued = draws of the frame", "command_processor.draws", value(command, "draws"), "frame.draws", frame_.frame.draws.size());
    law("draws issued = draws retired", "command_processor.draws * partitions", value(command, "draws") * m_.partitions().size(),
        "rop.draws", sum_.rop("draws"));
    law("vertices fetched = vertices shaded", "vertex_fetch.vertices", value(fetch, "vertices"), "core.vertices", sum_.core("vertices"));
    law("vertices shaded = vertices assembled", "core.vertices", sum_.core("vertices"), "primitive_assembly.vertices",
        value(assembly, "vertices"));
    law("triangles fetched = triangles assembled", "vertex_fetch.triangles", value(fetch, "triangles"), "primitive_assembly.triangles",
        value(assembly, "triangles"));
    law("triangles assembled = triangles to clip", "primitive_assembly.triangles", value(assembly, "triangles"), "clipper.triangles",
        value(clipper, "triangles"));
    law("triangles to clip = passed + cut + dropped", "clipper.triangles", value(clipper, "triangles"),
        "clipper.passed + clipped + rejected + not_finite",
        value(clipper, "passed") + value(clipper, "clipped") + value(clipper, "rejected") + value(clipper, "not_finite"));
    law("triangles and pieces passed = triangles set up", "clipper.passed + pieces", value(clipper, "passed") + value(clipper, "pieces"),
        "triangle_setup.triangles", value(setup, "triangles"));
    law("triangles set up = kept + dropped", "triangle_setup.triangles", value(setup, "triangles"),
        "triangle_setup.kept + culled + zero_area + offscreen + no_sample",
        value(setup, "kept") + value(setup, "culled") + value(setup, "zero_area") + value(setup, "offscreen") + value(setup, "no_sample"));
    law("triangles kept = triangles walked", "triangle_setup.kept", value(setup, "kept"), "coarse_raster.triangles",
        value(m_.coarse(), "triangles"));
    law("tiles kept = tiles rasterised", "coarse_raster.tiles_kept", value(m_.coarse(), "tiles_kept"), "fine_raster.tiles",
        value(m_.fine(), "tiles"));
  }

  void fragments() {
    law("fragments covered = fragments to test", "fine_raster.fragments", value(m_.fine(), "fragments"), "depth.fragments_in",
        sum_.depth("fragments_in"));
    law("fragments to test = killed + passed", "depth.fragments_in", sum_.depth("fragments_in"), "depth.early_killed + fragments_out",
        sum_.depth("early_killed") + sum_.depth("fragments_out"));
    law("fragments covered = tested early + deferred + untested", "fine_raster.fragments", value(m_.fine(), "fragments"),
        "depth.early_tested + deferred + untested", sum_.depth("early_tested") + sum_.depth("deferred") + sum_.depth("untested"));
    law("fragments deferred = tested late + discarded before that", "depth.deferred", sum_.depth("deferred"),
        "depth.late_tested + rop.late_discarded", sum_.depth("late_tested") + sum_.rop("late_discarded"));
    law("fragments passed = fragments packed", "depth.fragments_out", sum_.depth("fragments_out"), "warp_packer.fragments",
        sum_.packer("fragments"));
    law("fragments packed = fragments shaded", "warp_packer.fragments", sum_.packer("fragments"), "core.fragments", sum_.core("fragments"));
    law("warps packed = warps distributed", "warp_packer.warps", sum_.packer("warps"), "work_distributor.fragment_warps",
        value(m_.distributor(), "fragment_warps"));
    law("warps distributed = warps retired", "work_distributor.fragment_warps", value(m_.distributor(), "fragment_warps"), "rop.warps",
        sum_.rop("warps"));
    law("fragments shaded = fragments at the ROP", "core.fragments", sum_.core("fragments"), "rop.fragments_in", sum_.rop("fragments_in"));
    law("fragments at the ROP = discarded + killed late + written", "rop.fragments_in", sum_.rop("fragments_in"),
        "rop.discarded + late_killed + written", sum_.rop("discarded") + sum_.rop("late_killed") + sum_.rop("written"));
    law("killed late, seen by ROP = seen by depth", "rop.late_killed", sum_.rop("late_killed"), "depth.late_killed",
        sum_.depth("late_killed"));
  }

  void cache(const std::string& path, std::uint64_t requests, std::uint64_t hits, std::uint64_t merged, std::uint64_t misses) {
    law(path + ": requests = hits + merged + misses", path + ".requests", requests, path + ".hits + merged + misses",
        hits + merged + misses);
  }

  void caches() {
    const hw::Unit& fetch = m_.vertex_fetch();
    cache("vertex_fetch.cache", value(fetch, "cache_requests"), value(fetch, "cache_hits"), value(fetch, "cache_merged"),
          value(fetch, "cache_misses"));
    if (m_.cores()[0].texture) {
      law("texture requests sent = answered", "core.texture_instructions", sum_.core("texture_instructions"), "texture.requests",
          sum_.texture("requests"));
      law("texture groups taken = answered", "texture.groups", sum_.texture("groups"), "texture.groups_answered",
          sum_.texture("groups_answered"));
      cache("texture.cache", sum_.texture("cache_requests"), sum_.texture("cache_hits"), sum_.texture("cache_merged"),
            sum_.texture("cache_misses"));
    }
    cache("depth.cache", sum_.depth("cache_requests"), sum_.depth("cache_hits"), sum_.depth("cache_merged"), sum_.depth("cache_misses"));
    cache("rop.cache", sum_.rop("cache_requests"), sum_.rop("cache_hits"), sum_.rop("cache_merged"), sum_.rop("cache_misses"));
    cache("l2", sum_.l2("requests"), sum_.l2("hits"), sum_.l2("merged"), sum_.l2("misses"));
  }

  void bytes() {
    std::uint64_t read = 0, written = 0, asked = 0;
    for (const ClientFigures& c : clients_) {
      read += c.read_bytes;
      written += c.write_bytes;
    }
    const auto requests = [this](std::string_view n) {
      return value(m_.vertex_fetch(), n) + sum_.texture(n) + sum_.depth(n) + sum_.rop(n) + value(m_.scan_out(), n);
    };
    asked = requests("memory_reads") + requests("memory_writes");
    law("requests of clients = requests looked up in L2", "clients.memory_reads + memory_writes", asked, "l2.requests",
        sum_.l2("requests"));
    law("bytes asked by clients = bytes answered by L2", "clients.read_bytes", read, "l2.read_bytes", sum_.l2("read_bytes"));
    law("bytes written by clients = bytes taken by L2", "clients.write_bytes", written, "l2.write_bytes", sum_.l2("write_bytes"));
    law("bytes filled into L2 = bytes read from memory", "l2.fill_bytes", sum_.l2("fill_bytes"), "memory.read_bytes",
        sum_.memory("read_bytes"));
    law("bytes written back by L2 = bytes written to memory", "l2.writeback_bytes", sum_.l2("writeback_bytes"), "memory.write_bytes",
        sum_.memory("write_bytes"));
    law("rows hit + missed + in conflict = accesses", "memory.row_hits + row_misses + row_conflicts",
        sum_.memory("row_hits") + sum_.memory("row_misses") + sum_.memory("row_conflicts"), "memory.reads + writes",
        sum_.memory("reads") + sum_.memory("writes"));
    data_buses();
    if (!frame_.frame.passes.empty()) {
      law("bytes scanned out = bytes of the target", "scan_out.read_bytes", value(m_.scan_out(), "read_bytes"), "target.bytes",
          frame_.frame.passes.back().color.bytes());
    }
    law("dirty lines left in first-level caches = 0", "device_memory.dirty_lines", frame_.memory.dirty_lines(), "none", 0);
  }

  void data_buses() {
    std::uint64_t uses = 0, cycles = 0;
    for (const char* use : {"bus_read", "bus_write", "bus_refresh", "bus_turnaround", "bus_activation", "bus_spacing", "bus_idle"})
      uses += sum_.memory(use);
    for (const auto& channel : m_.channels()) cycles += static_cast<std::uint64_t>(channel->total_cycles());
    law("data bus: every cycle has a use", "memory.bus_read + write + refresh + turnaround + activation + spacing + idle", uses,
        "memory.cycles", cycles);
  }

  const Machine& m_;
  const DeviceFrame& frame_;
  const std::vector<ClientFigures>& clients_;
  Sums sum_;
  std::vector<Check> checks_;
};

}  // namespace

bool Figures::checks_hold() const { return std::ranges::all_of(checks, &Check::holds); }

std::uint64_t memory_bytes(const Figures& figures) {
  std::uint64_t bytes = 0;
  for (const UnitFigures& unit : figures.units) {
    if (without_number(unit.path) != "memory") continue;
    for (const CounterFigure& c : unit.counters) bytes += c.name == "read_bytes" || c.name == "write_bytes" ? c.value : 0;
  }
  return bytes;
}

namespace {

Fates fates_of(const Machine& m) {
  const Sums sum(m);
  const hw::Unit &clipper = m.clipper(), &setup = m.setup();
  return {.off_screen = value(clipper, "rejected") + value(setup, "offscreen"),
          .not_finite = value(clipper, "not_finite"),
          .culled = value(setup, "culled"),
          .no_area = value(setup, "zero_area"),
          .no_sample = value(setup, "no_sample"),
          .rasterised = value(setup, "kept"),
          .tiles_hidden = value(m.coarse(), "tiles_hidden"),
          .hidden = sum.depth("early_killed") + sum.depth("late_killed"),
          .discarded = sum.rop("discarded")};
}

}  // namespace

Figures collect_figures(const Machine& m, const DeviceFrame& frame) {
  Figures f;
  const Sums sum(m);
  f.frame.cycles = m.clock().edges_before(m.end());
  f.frame.render_cycles = m.clock().edges_before(m.command_processor().render_end());
  f.frame.clock_mhz = static_cast<double>(m.clock().frequency_hz()) * 1e-6;
  f.frame.draws = value(m.command_processor(), "draws");
  f.frame.triangles = value(m.assembly(), "triangles");
  f.frame.vertices = sum.core("vertices");
  f.frame.fragments_covered = value(m.fine(), "fragments");
  f.frame.fragments_shaded = sum.core("fragments");
  f.frame.helper_lanes = sum.core("helper_lanes");
  f.frame.fragment_warps = sum.core("fragment_warps");
  f.frame.fragments_written = sum.rop("written");
  f.frame.fates = fates_of(m);
  for (const hw::Unit* unit : m.units()) f.units.push_back(figures_of(*unit));
  for (const hw::Unit* unit : m.units()) {
    if (!unit->resources().empty())
      f.slice_cycles = static_cast<double>(unit->resources().slice()) * static_cast<double>(m.clock().frequency_hz()) * 1e-15;
  }
  for (std::size_t i = 0; i < m.links().size(); ++i) f.links.push_back(figures_of(*m.links()[i], m.link_keys()[i], m.end()));
  f.bandwidth = bandwidth(m);
  f.checks = Laws(m, frame, f.bandwidth).all();
  // The counted work at its peak rates fits into the frame.
  const auto light = static_cast<std::int64_t>(std::ceil(speed_of_light(f).cycles - 1e-6));
  f.checks.push_back({"cycles are not below the least time of the counted work", "frame.cycles below frame.least_cycles", "none",
                      static_cast<std::uint64_t>(std::max<std::int64_t>(0, light - f.frame.cycles)), 0});
  f.left_out = m.left_out();
  f.host.actions = m.driver().actions();
  return f;
}

}  // namespace quadrille::pipeline
