/// The figures as JSON. Keys keep the order in which they are written here, so that two runs compare as text.
#include "pipeline/report/limiter.h"
#include "pipeline/report/notes.h"
#include "pipeline/report/report.h"
#include "pipeline/report/sensitivity.h"
#include "pipeline/report/timeline.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <map>

namespace quadrille::pipeline {

namespace {

using Json = nlohmann::ordered_json;

/// A frame that was not timed has no cycles, warps or traffic: null, not zero.
template <class Count>
Json if_timed(const Figures& f, Count count) {
  return f.units.empty() ? Json(nullptr) : Json(count);
}

Json frame_json(const ReportSubject& s) {
  const FrameFigures& f = s.figures.frame;
  return {{"width", s.width},
          {"height", s.height},
          {"cycles", if_timed(s.figures, f.cycles)},
          {"render_cycles", if_timed(s.figures, f.render_cycles)},
          {"scan_out_cycles", if_timed(s.figures, f.scan_out_cycles())},
          {"least_cycles", if_timed(s.figures, speed_of_light(s.figures).cycles)},
          {"period_cycles", if_timed(s.figures, f.period_cycles())},
          {"moving_cycles", if_timed(s.figures, s.figures.moving_cycles)},
          {"clock_mhz", s.machine.gpu.clock_mhz.value()},
          {"draws", f.draws},
          {"triangles", f.triangles},
          {"vertices", f.vertices},
          {"fragments_covered", f.fragments_covered},
          {"fragments_shaded", f.fragments_shaded},
          {"helper_lanes", f.helper_lanes},
          {"executed_lanes", f.fragments_shaded + f.helper_lanes},
          {"fragment_warps", if_timed(s.figures, f.fragment_warps)},
          {"fragments_written", f.fragments_written},
          {"memory_bytes", if_timed(s.figures, memory_bytes(s.figures))}};
}

Json faster_json(const Figures& f) {
  Json faster = Json::object();
  for (const auto& [kind, times] : f.faster) faster[kind] = times;
  return faster;
}

Json unit_json(const UnitFigures& u) {
  Json waits = Json::object(), counters = Json::object();
  for (const WaitFigure& w : u.waits) waits[w.port] = w.cycles;
  for (const CounterFigure& c : u.counters) counters[c.name] = c.value;
  Json histograms = Json::object();
  for (const HistogramFigure& h : u.histograms) histograms[h.name] = {{"buckets", h.buckets}, {"sum", h.sum}};
  Json resources = Json::object();
  for (const ResourceFigure& r : u.resources) {
    switch (r.kind) {
      case hw::Resource::Kind::kRate:
        resources[r.name] = {{"kind", "rate"}, {"least_cycles", r.cycles}};
        break;
      case hw::Resource::Kind::kLoss:
        resources[r.name] = {{"kind", "loss"}, {"lost_cycles", r.cycles}};
        break;
      case hw::Resource::Kind::kPlaces:
        resources[r.name] = {{"kind", "places"}, {"full_cycles", r.cycles}};
        break;
    }
  }
  return {{"cycles", u.cycles},
          {"use", use_of(u)},
          {"busy", u.busy},
          {"waiting", u.waiting},
          {"starved", u.starved},
          {"blocked", u.blocked},
          {"idle", u.idle},
          {"resources", std::move(resources)},
          {"waits", std::move(waits)},
          {"counters", std::move(counters)},
          {"histograms", std::move(histograms)}};
}

/// Unit and definition of every counter, once a kind of unit.
Json definitions_json(const Figures& f) {
  Json all = Json::object();
  for (const UnitFigures& u : f.units) {
    Json& kind = all[std::string(without_number(u.path))];
    if (!kind.is_null()) continue;
    kind = Json::object();
    for (const CounterFigure& c : u.counters) kind[c.name] = {{"unit", c.unit}, {"definition", c.definition}};
    for (const HistogramFigure& h : u.histograms)
      kind[h.name] = {{"unit", h.unit}, {"definition", h.definition}};
  }
  return all;
}

Json checks_json(const Figures& f) {
  Json all = Json::array();
  for (const Check& c : f.checks) {
    all.push_back({{"law", c.law},
                   {"left", {{"name", c.left_name}, {"value", c.left}}},
                   {"right", {{"name", c.right_name}, {"value", c.right}}},
                   {"holds", c.holds()}});
  }
  return all;
}

/// What holds the frame up: what each resource's doubling is expected to gain, and all uses, from a
/// thousandth and a hundredth on.
Json limit_json(const Figures& f) {
  const Limiter limiter = find_limiter(f);
  if (limiter.kind == Limiter::Kind::kNothing) return nullptr;
  const Sensitivity s = sensitivity(f);
  Json uses = Json::object(), full = Json::object(), gains = Json::object();
  for (const ResourceUse& use : s.uses) {
    if (use.use >= 0.01) (use.places ? full : uses)[use.name] = use.use;
  }
  for (const Gain& gain : s.gains) {
    if (gain.share >= 0.001) gains[gain.resource] = gain.share;
  }
  return {{"kind", limiter_kind_name(limiter.kind)},
          {"name", limiter.name},
          {"resource", limiter.resource},
          {"share", limiter.share},
          {"walk", limiter.walk},
          {"text", limiter.text},
          {"gains", std::move(gains)},
          {"uses", std::move(uses)},
          {"full", std::move(full)},
          {"waiting", s.waiting}};
}

/// Counts of a draw, in their groups.
Json counts_json(const DrawFigures& draw) {
  Json groups = Json::object();
  for (std::size_t i = 0; i < kReportedDrawCounts; ++i)
    groups[std::string(draw_counts()[i].group)][std::string(draw_counts()[i].key)] = draw.counts[i];
  return groups;
}

/// Of the kinds that worked for it.
template <class Cycles>
Json by_kind(const std::vector<std::string>& kinds, const std::vector<Cycles>& cycles) {
  Json all = Json::object();
  for (std::size_t k = 0; k < kinds.size(); ++k)
    if (cycles[k] > 0) all[kinds[k]] = cycles[k];
  return all;
}

Json draw_json(const Detail& d, const DrawFigures& draw) {
  Json all = {{"label", draw.label},
              {"shaders", {{"vertex", draw.vertex_shader}, {"fragment", draw.fragment_shader}}},
              {"pass", draw.pass.index()},
              {"issued", draw.issued},
              {"retired", draw.retired},
              {"cycles_in_flight", draw.in_flight()}};
  all.update(counts_json(draw));
  const DrawLimiter limiter = d.limiter(draw);
  all["busy"] = by_kind(d.kinds, draw.busy);
  all["work"] = by_kind(d.kinds, draw.work);
  all["limiter"] = {{"kind", limiter.kind()},
                    {"unit", limiter.unit},
                    {"work_cycles", limiter.work},
                    {"share", limiter.share}};
  return all;
}

Json tiles_json(const TileFigures& tiles) {
  Json all = {{"width", tiles.width}, {"height", tiles.height}, {"tile_pixels", tiles.pixels}};
  Json outside = Json::object();
  for (std::size_t i = 0; i < kTileCounts; ++i) {
    const std::string key(tile_counts()[i].key);
    std::vector<std::uint64_t> counts = tiles.counts[i];
    outside[key] = counts.back();
    counts.pop_back();
    all[key] = std::move(counts);
  }
  all["outside_tiles"] = std::move(outside);
  return all;
}

/// A ten-thousandth is far below what a slice can tell.
Json rounded(const std::vector<double>& values) {
  Json all = Json::array();
  for (const double value : values) all.push_back(std::round(value * 1e4) / 1e4);
  return all;
}

Json unit_curves_json(const Timeline& line) {
  Json units = Json::object();
  for (const UnitCurves& unit : line.units) {
    Json curves = Json::object();
    for (const ResourceCurve& curve : unit.resources) curves[curve.resource] = rounded(curve.share);
    units[unit.unit] = std::move(curves);
  }
  return units;
}

/// Bytes are counts; of links the mean is told, as of what units took.
void add_flow(Json& all, const FlowFigures& flow, const Timeline& line) {
  Json bandwidth = Json::object(), memory = Json::object(), links = Json::object();
  for (const ClientCurve& c : flow.asked)
    bandwidth[c.client] = {{"read_bytes", c.read}, {"write_bytes", c.written}};
  for (const ClientCurve& c : flow.memory)
    memory[c.client] = c.client == name_of(hw::MemoryClient::kWriteBack) ? c.written : c.read;
  for (const FlowCurve& curve : line.flow.back().curves) links[curve.name] = rounded(curve.value);
  all["bandwidth"] = std::move(bandwidth);
  all["memory"] = std::move(memory);
  all["links"] = std::move(links);
}

Json timeline_json(const Figures& f) {
  const Timeline line = timeline_of(f);
  Json all = {
      {"slice_cycles", line.slice_cycles}, {"slices", line.slices}, {"units", unit_curves_json(line)}};
  if (f.flow) add_flow(all, *f.flow, line);
  return all;
}

/// By class of links.
Json links_json(const Figures& f) {
  struct Class {
    int links = 0, depth = 0;
    std::uint64_t tokens = 0, held_ticks = 0;
  };
  std::map<std::string, Class> classes;
  Json all = Json::object();
  for (const LinkFigures& link : f.links) {
    const std::string name(class_of(link.key));
    Class& of = classes[name];
    ++of.links;
    of.depth = link.depth;
    of.tokens += link.tokens;
    of.held_ticks += link.held_ticks;
    all[name] = nullptr;  // keeps the order of the links
  }
  for (const auto& [name, of] : classes)
    all[name] = {{"links", of.links},
                 {"depth", of.depth},
                 {"tokens", of.tokens},
                 {"held_cycles", static_cast<double>(of.held_ticks) * f.frame.clock_mhz * 1e-9}};
  return all;
}

/// Adds what was asked for.
void add_detail(Json& document, const Figures& f) {
  const std::optional<Detail>& detail = f.detail;
  if (!detail) return;
  if (detail->wanted.draws) {
    Json draws = Json::array();
    for (std::size_t i = 0; i < detail->draws.size(); ++i) {
      draws.push_back(draw_json(*detail, detail->draws[i]));
      if (f.path) draws.back()["path"] = draw_path_json(f.path->of_each[i], f.frame.clock_mhz);
    }
    document["draws"] = std::move(draws);
    document["outside_draws"] = counts_json(detail->outside_draws);
    document["outside_draws"]["busy"] = by_kind(detail->kinds, detail->outside_draws.busy);
  }
  if (detail->wanted.tiles) document["tiles"] = tiles_json(detail->tiles);
}

Json miss_kinds_json(const MissKindFigures& m) {
  return {{"look_ups", m.look_ups},
          {"misses", m.misses},
          {"compulsory", m.of(models::MissKind::kCompulsory)},
          {"capacity", m.of(models::MissKind::kCapacity)},
          {"conflict", m.of(models::MissKind::kConflict)},
          {"associative_misses", m.kinds.associative_misses}};
}

/// Only where it was asked for.
void add_texture_misses(Json& document, const Figures& f) {
  if (!f.texture_misses) return;
  Json units = Json::object();
  for (const MissKindFigures& m : *f.texture_misses) units[m.unit] = miss_kinds_json(m);
  document["texture_misses"] = miss_kinds_json(all_texture_misses(f));
  document["texture_misses"]["units"] = std::move(units);
}

/// Only where it was asked for.
void add_textures(Json& document, const Figures& f) {
  if (!f.textures) return;
  Json textures = Json::array();
  for (const TextureFigures& t : *f.textures) {
    const hw::TextureUse& use = t.use;
    textures.push_back({{"name", t.image.name},
                        {"format", t.image.format},
                        {"width", t.image.width},
                        {"height", t.image.height},
                        {"depth", t.image.depth},
                        {"layers", t.image.layers},
                        {"levels", t.image.levels},
                        {"bytes", t.image.end - t.image.begin},
                        {"requests", use.requests},
                        {"lanes", use.lanes},
                        {"texels", use.texels},
                        {"nearest", use.nearest},
                        {"linear", use.linear},
                        {"two_levels", use.two_levels},
                        {"several_samples", use.several_samples},
                        {"lanes_by_level", use.levels},
                        {"look_ups", use.look_ups},
                        {"misses", use.misses},
                        {"read_bytes", use.read_bytes},
                        {"memory_bytes", t.memory_bytes}});
  }
  document["textures"] = std::move(textures);
}

/// Only where the frame has some.
void add_queries(Json& document, const std::vector<QueryFigures>& queries) {
  if (queries.empty()) return;
  Json all = Json::array();
  for (const QueryFigures& q : queries) {
    const bool occlusion = q.range.type == traces::QueryType::kOcclusion;
    Json values = Json::object();
    for (const QueryValue& v : q.values)
      values[std::string(v.name)] = v.value ? Json(*v.value) : Json(nullptr);
    all.push_back({{"pool", q.range.pool},
                   {"pool_number", q.range.pool_number},
                   {"query", q.range.query},
                   {"type", occlusion ? "occlusion" : "pipeline_statistics"},
                   {"first_draw", q.range.first_draw},
                   {"draws", q.range.draws},
                   {"values", std::move(values)}});
  }
  document["queries"] = std::move(all);
}

Json host_json(const Figures& f) {
  const HostFigures& h = f.host;
  return {{"load_s", h.load_s},
          {"build_s", h.build_s},
          {"unpack_s", h.unpack_s},
          {"simulate_s", h.simulate_s},
          {"simulate_cpu_s", h.simulate_cpu_s},
          {"wall_s", h.wall_s},
          {"fragments_per_s", h.fragments_per_s},
          {"cycles_per_s", if_timed(f, h.cycles_per_s)},
          {"peak_rss_mib", h.peak_rss_mib},
          {"actions", h.actions}};
}

}  // namespace

std::string machine_json(const MachineConfig& machine) {
  Json parameters = Json::object(), changed = Json::object();
  for (const auto& [path, group] : machine.groups()) {
    for (const hw::ParamBase* p : group->params())
      parameters[path + "." + std::string(p->name())] = Json::parse(p->literal());
  }
  for (const MachineConfig::Change& c : machine.changes())
    changed[c.path] = {{"value", Json::parse(c.value)}, {"base", Json::parse(c.base_value)}};
  const Json all = {{"name", machine.name},
                    {"base", machine.base()},
                    {"changed", std::move(changed)},
                    {"parameters", std::move(parameters)}};
  return all.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string report_json(const ReportSubject& s) {
  const Figures& f = s.figures;
  Json units = Json::object(), bandwidth = Json::object(), left_out = Json::array();
  for (const UnitFigures& u : f.units) units[u.path] = unit_json(u);
  for (const ClientFigures& c : f.bandwidth)
    bandwidth[c.name] = {{"read_bytes", c.read_bytes}, {"write_bytes", c.write_bytes}};
  for (const LeftOut& l : f.left_out)
    left_out.push_back({{"what", l.what}, {"why", l.why}, {"saved", l.saved}});
  Json document = {{"schema", kFiguresSchema},       {"scene", f.scene},
                   {"fidelity", f.fidelity},         {"window_cycles", f.window_cycles},
                   {"faster", faster_json(f)},       {"machine", Json::parse(machine_json(s.machine))},
                   {"frame", frame_json(s)},         {"notes", notes_on(f)},
                   {"units", std::move(units)},      {"counter_definitions", definitions_json(f)},
                   {"limit", limit_json(f)},         {"bandwidth", std::move(bandwidth)},
                   {"links", links_json(f)},         {"checks", checks_json(f)},
                   {"left_out", std::move(left_out)}};
  if (f.path) document["critical_path"] = path_json(*f.path, f.frame.clock_mhz);
  add_texture_misses(document, f);
  add_textures(document, f);
  add_queries(document, f.queries);
  add_detail(document, f);
  if (f.report_timeline) document["timeline"] = timeline_json(f);
  document["host"] = host_json(f);
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace quadrille::pipeline
