/// The table: what a person reads first. Every share says of what, every rate its unit and what the best
/// would be.
#include "pipeline/report/limiter.h"
#include "pipeline/report/notes.h"
#include "pipeline/report/report.h"
#include "pipeline/report/unit_facets.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <span>

namespace quadrille::pipeline {

namespace {

constexpr std::size_t kColumns = 139;
constexpr std::size_t kFacetColumn = 79;

double ratio(double a, double b) { return b > 0 ? a / b : 0; }
double ratio(std::uint64_t a, std::uint64_t b) {
  return ratio(static_cast<double>(a), static_cast<double>(b));
}
double megabytes(std::uint64_t bytes) { return static_cast<double>(bytes) * 1e-6; }

/// Text in lines of `kColumns`, broken at facets, the later ones indented to `indent`.
std::string wrapped(const std::vector<std::string>& facets, std::size_t indent) {
  std::string out;
  std::size_t column = indent;
  for (const std::string& facet : facets) {
    if (column > indent && column + facet.size() + 3 > kColumns) {
      out += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      out += "   ";
      column += 3;
    }
    out += facet;
    column += facet.size();
  }
  return out + "\n";
}

std::string row(std::string_view title, const std::vector<std::string>& facets) {
  return fmt::format("  {:<12}", title) + wrapped(facets, 14);
}

std::string time_row(const ReportSubject& s) {
  const FrameFigures& f = s.figures.frame;
  if (s.figures.units.empty())
    return row("time", {"not simulated (functional: the picture and its counts only)"});
  const auto text = [](std::int64_t cycles) { return grouped(static_cast<std::uint64_t>(cycles)); };
  const double mhz = s.machine.gpu.clock_mhz;
  const auto rate = [mhz](std::int64_t cycles) { return 1e6 * ratio(mhz, static_cast<double>(cycles)); };
  return row(
      "time",
      {fmt::format("{}{} cycles: {} until all passes are flushed, {} of scan-out after that",
                   s.figures.window_cycles > 0 ? "approximate: " : "", text(f.cycles), text(f.render_cycles),
                   text(f.scan_out_cycles())),
       fmt::format("{:.3f} ms at {:g} MHz", ratio(static_cast<double>(f.cycles), mhz) * 1e-3, mhz),
       fmt::format("{:.1f} frames/s one after another", rate(f.cycles)),
       fmt::format("{:.1f} frames/s where scan-out overlaps the next frame", rate(f.period_cycles()))});
}

/// Empty for an exact run.
std::string window_text(const Figures& f) {
  if (f.window_cycles == 0) return "";
  return fmt::format(" (window of {} cycles; quadrille accuracy measures its error)", f.window_cycles);
}

std::string frame_text(const ReportSubject& s) {
  const FrameFigures& f = s.figures.frame;
  const std::uint64_t pixels = std::uint64_t{s.width} * s.height;
  const std::uint64_t executed = f.fragments_shaded + f.helper_lanes;
  std::string out = fmt::format("FRAME  {}, {}x{}, machine {}, {}{}\n", s.figures.scene, s.width, s.height,
                                s.machine.title(), s.figures.fidelity, window_text(s.figures));
  out += time_row(s);
  out += row("geometry",
             {fmt::format("{} draws", grouped(f.draws)), fmt::format("{} triangles", grouped(f.triangles)),
              fmt::format("{} vertices shaded ({:.2f} a triangle)", grouped(f.vertices),
                          ratio(f.vertices, f.triangles))});
  out += row("fragments", {fmt::format("{} covered", grouped(f.fragments_covered)),
                           fmt::format("{} shaded", grouped(f.fragments_shaded)),
                           fmt::format("{} written", grouped(f.fragments_written)),
                           fmt::format("{} helper lanes ({:.1f} % of the lanes executed)",
                                       grouped(f.helper_lanes), 100 * ratio(f.helper_lanes, executed))});
  std::vector<std::string> rates{
      fmt::format("{:.2f} covered", ratio(f.fragments_covered, pixels)),
      fmt::format("{:.2f} shaded", ratio(f.fragments_shaded, pixels)),
      fmt::format("{:.2f} written (overdraw)", ratio(f.fragments_written, pixels))};
  if (f.cycles > 0)
    rates.push_back(
        fmt::format("and {:.3f} fragments shaded a cycle",
                    ratio(static_cast<double>(f.fragments_shaded), static_cast<double>(f.cycles))));
  return out + row("per pixel", rates);
}

std::string wait_text(const UnitGroup& group) {
  std::map<std::string, std::int64_t> by_port;
  for (const UnitFigures* u : group.units) {
    for (const WaitFigure& w : u->waits) by_port[std::string(without_number(w.port))] += w.cycles;
  }
  const auto longest = std::ranges::max_element(by_port, {}, [](const auto& p) { return p.second; });
  if (longest == by_port.end()) return "-";
  return fmt::format("{:<15}{:>6.1f}", longest->first,
                     100 * ratio(static_cast<double>(longest->second), static_cast<double>(group.cycles())));
}

std::string unit_row(const UnitGroup& group) {
  const auto share = [&](std::int64_t UnitFigures::*member) {
    return 100 * ratio(static_cast<double>(group.sum(member)), static_cast<double>(group.cycles()));
  };
  const std::string name =
      group.units.size() > 1 ? fmt::format("{} x{}", group.kind, group.units.size()) : group.name;
  const std::string spread = group.units.size() > 1 ? fmt::format("+-{:.1f}", group.busy_spread()) : "";
  double use = 0;
  for (const UnitFigures* unit : group.units) use = std::max(use, use_of(*unit));
  std::string out = fmt::format("  {:<19}{:>6.1f}{:>7.1f} {:<6}{:>7.1f}{:>8.1f}{:>8.1f}{:>6.1f}  {:<22} ",
                                name, 100 * use, share(&UnitFigures::busy), spread,
                                share(&UnitFigures::waiting), share(&UnitFigures::starved),
                                share(&UnitFigures::blocked), share(&UnitFigures::idle), wait_text(group));
  out.resize(std::max(out.size(), kFacetColumn), ' ');
  const std::vector<std::string> facets = unit_facets(group);
  if (facets.empty()) out.erase(out.find_last_not_of(' ') + 1);
  return out + wrapped(facets, kFacetColumn);
}

std::string units_text(const ReportSubject& s, UnitRows rows) {
  if (s.figures.units.empty()) return "";
  std::string out = fmt::format(
      "\nUNITS{}  in % of each unit's cycles: use is the least time of its work at its peak rates; busy "
      "(work begins) + waiting (for its "
      "own "
      "latencies) + starved (an\n  input was missing) + blocked (an output was full) + idle (no work in "
      "flight) make 100\n"
      "  {:<19}{:>6}{:>7} {:<6}{:>7}{:>8}{:>8}{:>6}  {:<15}{:>6}  {}\n",
      s.figures.window_cycles > 0 ? " (approximate)" : "", "unit", "use", "busy", "", "waiting", "starved",
      "blocked", "idle", "longest wait", "%", "what it did; /clk is a unit's mean rate, with % of its peak");
  for (const UnitGroup& group : group_units(s.figures.units, rows == UnitRows::kFolded))
    out += unit_row(group);
  return out;
}

std::string light_text(const Figures& f) {
  const SpeedOfLight light = speed_of_light(f);
  return fmt::format(
      "LEAST  {} cycles for the counted work at its peak rates ({}): the frame takes {:.2f} times that\n",
      grouped(static_cast<std::uint64_t>(std::ceil(light.cycles))), light.resource,
      ratio(static_cast<double>(f.frame.cycles), light.cycles));
}

std::string limit_text(const Figures& f) {
  const Limiter limiter = find_limiter(f);
  return limiter.kind == Limiter::Kind::kNothing
             ? ""
             : fmt::format("\nLIMIT  {}\n{}", limiter.text, light_text(f));
}

std::string notes_text(const Figures& f) {
  std::string out;
  for (const std::string& note : notes_on(f)) out += fmt::format("\nNOTE  {}\n", note);
  return out;
}

std::string bandwidth_row(std::string_view name, std::uint64_t read, std::uint64_t written,
                          std::int64_t cycles, double peak) {
  const double rate = ratio(static_cast<double>(read + written), static_cast<double>(cycles));
  return fmt::format("  {:<19}{:>12.3f}{:>13.3f}{:>12.3f}{:>11.1f}\n", name, megabytes(read),
                     megabytes(written), rate, 100 * ratio(rate, peak));
}

std::string bandwidth_text(const ReportSubject& s) {
  const Figures& f = s.figures;
  if (f.bandwidth.empty()) return "";
  const double peak = peak_memory_bytes_per_cycle(s.machine);
  std::string out = fmt::format(
      "\nBANDWIDTH{}  clients at the L2 cache, and what reached memory; the memory's peak is {:.1f} byte/clk "
      "({:.1f} GB/s, {} channels)\n"
      "  {:<19}{:>12}{:>13}{:>12}{:>11}\n",
      s.figures.window_cycles > 0 ? " (approximate)" : "", peak, peak * s.machine.gpu.clock_mhz * 1e-3,
      s.machine.gpu.channels.value(), "client", "read MB", "written MB", "byte/clk", "% of peak");
  std::uint64_t read = 0, written = 0;
  for (const ClientFigures& c : f.bandwidth) {
    out += bandwidth_row(c.name, c.read_bytes, c.write_bytes, f.frame.cycles, peak);
    read += c.read_bytes;
    written += c.write_bytes;
  }
  out += bandwidth_row("all clients", read, written, f.frame.cycles, peak);
  for (const UnitGroup& group : group_units(f.units, true)) {
    if (group.kind == "memory")
      out += bandwidth_row("memory", group.counter("read_bytes"), group.counter("write_bytes"),
                           f.frame.cycles, peak);
  }
  return out;
}

std::string checks_text(const Figures& f) {
  if (f.checks.empty()) return "";
  const auto holding = std::ranges::count_if(f.checks, &Check::holds);
  return fmt::format("\nCHECKS  {} of {} laws hold\n{}", holding, f.checks.size(), failed_checks(f));
}

std::string path_text(const Figures& f) {
  return f.path && f.path->ticks > 0 ? "\n" + path_table(*f.path, f.frame.clock_mhz) : "";
}

std::string misses_text(const Figures& f) {
  if (!f.texture_misses || f.texture_misses->empty()) return "";
  const MissKindFigures m = all_texture_misses(f);
  const auto share = [](std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0.0 : 100 * static_cast<double>(part) / static_cast<double>(whole);
  };
  std::string out = fmt::format("\nMISSES  of the texture caches: {} of {} look-ups ({:.2f} %)\n",
                                grouped(m.misses), grouped(m.look_ups), share(m.misses, m.look_ups));
  const auto line = [&](std::string_view name, models::MissKind kind, std::string_view text) {
    out += fmt::format("  {:<12}{:>14}{:>7.1f} %  {}\n", name, grouped(m.of(kind)),
                       share(m.of(kind), m.misses), text);
  };
  line("compulsory", models::MissKind::kCompulsory, "never held before");
  line("capacity", models::MissKind::kCapacity, "an LRU cache of as many lines without sets misses too");
  line("conflict", models::MissKind::kConflict, "it does not");
  return out + fmt::format("  without sets{:>14} misses in all\n", grouped(m.kinds.associative_misses));
}

/// The textures that took most, in as many lines.
constexpr std::size_t kDearestTextures = 10;

std::string textures_text(const Figures& f) {
  if (!f.textures || f.textures->empty()) return "";
  std::vector<const TextureFigures*> order;
  order.reserve(f.textures->size());
  for (const TextureFigures& t : *f.textures) order.push_back(&t);
  std::ranges::stable_sort(order, std::ranges::greater(),
                           [](const TextureFigures* t) { return t->use.read_bytes; });
  order.resize(std::min(order.size(), kDearestTextures));
  const auto share = [](std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0.0 : 100 * static_cast<double>(part) / static_cast<double>(whole);
  };
  std::string out = fmt::format(
      "\nTEXTURES  {} of {} by bytes asked of the L2 cache\n  {:>12}{:>8}{:>10}{:>8}{:>12}{:>8}{:>12}{:>12}  "
      "{}\n",
      order.size(), f.textures->size(), "lanes", "linear", "2 levels", "level", "look-ups", "missed",
      "L2 bytes", "memory", "texture");
  for (const TextureFigures* t : order) {
    const hw::TextureUse& use = t->use;
    double level = 0;
    for (std::size_t l = 0; l < use.levels.size(); ++l)
      level += static_cast<double>(l) * static_cast<double>(use.levels[l]);
    out += fmt::format("  {:>12}{:>6.0f} %{:>8.0f} %{:>8.2f}{:>12}{:>6.1f} %{:>12}{:>12}  {} {}x{} {}\n",
                       grouped(use.lanes), share(use.linear, use.lanes), share(use.two_levels, use.lanes),
                       use.lanes == 0 ? 0.0 : level / static_cast<double>(use.lanes), grouped(use.look_ups),
                       share(use.misses, use.look_ups), grouped(use.read_bytes), grouped(t->memory_bytes),
                       t->image.format, t->image.width, t->image.height, t->image.name);
  }
  return out;
}

/// The draws that were in flight longest, in as many lines.
constexpr std::size_t kDearestDraws = 10;

std::string limiter_text(const DrawLimiter& l) {
  if (l.unit.empty()) return "latency";
  const std::string work = fmt::format("{} works for {:.0f} cycles, {:.1f} %", l.unit, l.work, 100 * l.share);
  return l.latency() ? fmt::format("latency ({})", work) : work;
}

std::string draws_text(const Figures& f) {
  if (!f.detail || !f.detail->wanted.draws || f.detail->draws.empty()) return "";
  const Detail& d = *f.detail;
  std::vector<const DrawFigures*> dearest;
  for (const DrawFigures& draw : d.draws) dearest.push_back(&draw);
  std::ranges::stable_sort(dearest, std::ranges::greater{}, &DrawFigures::in_flight);
  dearest.resize(std::min(dearest.size(), kDearestDraws));
  std::string out = fmt::format(
      "\nDRAWS  the {} of {} that were in flight longest; draws overlap. Limiter: the unit with most work, "
      "if that is half of the time\n"
      "  {:>6}  {:<40}{:>5}{:>12}{:>11}{:>11}{:>12}  {}\n",
      dearest.size(), d.draws.size(), "draw", "label", "pass", "cycles", "triangles", "drawn", "fragments",
      "limiter");
  for (const DrawFigures* draw : dearest) {
    std::string label = draw->label;
    if (label.size() > 39) label = "..." + label.substr(label.size() - 36);  // the end tells draws apart
    out +=
        fmt::format("  {:>6}  {:<40}{:>5}{:>12}{:>11}{:>11}{:>12}  {}\n", draw - d.draws.data(), label,
                    draw->pass.index(), grouped(static_cast<std::uint64_t>(draw->in_flight())),
                    grouped(draw->of(DrawCount::kTrianglesIn)), grouped(draw->of(DrawCount::kTrianglesDrawn)),
                    grouped(draw->of(DrawCount::kShaded)), limiter_text(d.limiter(*draw)));
  }
  return out;
}

/// So many lines at most; the JSON has all.
constexpr std::size_t kShownQueries = 20;

std::string queries_text(const Figures& f) {
  if (f.queries.empty()) return "";
  const std::size_t shown = std::min(f.queries.size(), kShownQueries);
  std::string out = fmt::format("\nQUERIES  {} of {}: sums over their draws\n", shown, f.queries.size());
  for (const QueryFigures& q : std::span(f.queries).first(shown)) {
    std::vector<std::string> values;
    for (const QueryValue& v : q.values) {
      std::string name(v.name);
      std::ranges::replace(name, '_', ' ');
      values.push_back(fmt::format("{} {}", v.value ? grouped(*v.value) : "-", name));
    }
    const std::string draws = q.range.draws == 0   ? "no draw"
                              : q.range.draws == 1 ? fmt::format("draw {}", q.range.first_draw)
                                                   : fmt::format("draws {}..{}", q.range.first_draw,
                                                                 q.range.first_draw + q.range.draws - 1);
    out += fmt::format("  {:<12}{:>6}  {:<18}", q.range.pool, q.range.query, draws) + wrapped(values, 40);
  }
  return out;
}

std::string left_out_text(const Figures& f) {
  if (f.left_out.empty()) return "";
  std::string out = "\nLEFT OUT  what this frame does not need\n";
  for (const LeftOut& l : f.left_out) out += fmt::format("  {}: {} ({})\n", l.what, l.why, l.saved);
  return out;
}

std::string host_text(const Figures& f) {
  const HostFigures& h = f.host;
  std::vector<std::string> speed{fmt::format("{:.3f} million fragments/s", h.fragments_per_s * 1e-6)};
  if (!f.units.empty()) {
    speed.push_back(fmt::format("{:.3f} million cycles/s", h.cycles_per_s * 1e-6));
    speed.push_back(fmt::format("{} actions of units, {:.0f} ns each", grouped(h.actions),
                                1e9 * ratio(h.simulate_s, static_cast<double>(h.actions))));
  }
  return "\nHOST  what the simulation cost here\n" +
         row("seconds",
             {fmt::format("load {:.3f}", h.load_s), fmt::format("build {:.3f}", h.build_s),
              fmt::format("unpack textures {:.3f}", h.unpack_s),
              fmt::format("simulate {:.3f} ({:.3f} of processor time)", h.simulate_s, h.simulate_cpu_s),
              fmt::format("whole process {:.3f}", h.wall_s)}) +
         row("speed", speed) + row("memory", {fmt::format("{:.0f} MiB at most", h.peak_rss_mib)});
}

}  // namespace

std::string failed_checks(const Figures& figures) {
  std::string out;
  for (const Check& c : figures.checks) {
    if (!c.holds())
      out += fmt::format("  law broken: {}: {} is {}, {} is {}\n", c.law, c.left_name, c.left, c.right_name,
                         c.right);
  }
  return out;
}

std::string_view without_number(std::string_view name) {
  const std::size_t bar = name.rfind('_');
  if (bar == std::string_view::npos || bar + 1 == name.size()) return name;
  const bool number =
      std::ranges::all_of(name.substr(bar + 1), [](unsigned char c) { return std::isdigit(c) != 0; });
  return number ? name.substr(0, bar) : name;
}

double peak_memory_bytes_per_cycle(const MachineConfig& machine) {
  return machine.gpu.channels * machine.memory.bytes_per_clk() * machine.gpu.memory_mhz /
         machine.gpu.clock_mhz;
}

std::string report_table(const ReportSubject& subject, UnitRows rows) {
  return frame_text(subject) + notes_text(subject.figures) + units_text(subject, rows) +
         limit_text(subject.figures) + path_text(subject.figures) + bandwidth_text(subject) +
         misses_text(subject.figures) + textures_text(subject.figures) + draws_text(subject.figures) +
         queries_text(subject.figures) + checks_text(subject.figures) + left_out_text(subject.figures) +
         host_text(subject.figures);
}

}  // namespace quadrille::pipeline
