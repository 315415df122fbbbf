#include "cli/render_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "cli/command.h"
#include "cli/detail_words.h"
#include "cli/film.h"
#include "cli/image_files.h"
#include "cli/process.h"
#include "models/base/error.h"
#include "models/base/say.h"
#include "pipeline/driver/host_cost.h"
#include "pipeline/report/draws_by_square.h"
#include "pipeline/report/flat_figures.h"
#include "pipeline/report/frames_output.h"
#include "pipeline/report/occupancy.h"
#include "pipeline/report/page.h"
#include "pipeline/report/report.h"
#include "pipeline/report/timeline.h"
#include "pipeline/watched_render.h"
#include "scenes/image/image_io.h"

namespace quadrille::cli {
namespace {

constexpr std::int64_t kMaxCycles = 1'000'000'000'000;
constexpr double kMostFaster = 100;
constexpr std::int64_t kMaxWindow = 1'000'000;  // cycles: far beyond what any frame gains by

void note_host(pipeline::Figures& figures, double load_s) {
  figures.host.load_s = load_s;
  figures.host.wall_s = wall_seconds();
  figures.host.peak_rss_mib = pipeline::peak_rss_mib();
}

}  // namespace

void RenderJob::add_to(CLI::App& command) {
  machine.add_to(command);
  command.add_option("--out", out, "writes the picture: .png as stored, .exr as linear floats")
      ->type_name("F.png|F.exr");
  command.add_option("--depth", depth, "writes the depths: .exr as they are, .png as grey, nearest white")
      ->type_name("F.exr|F.png");
  command
      .add_option("--stats", stats,
                  "writes all figures as JSON (docs/figures.md); - is standard output, and the table then "
                  "goes to standard error")
      ->type_name("F.json|-");
  command.add_option("--csv", csv, "writes the same figures as a flat table: path, value, unit")
      ->type_name("F.csv");
  command
      .add_option("--fidelity", fidelity,
                  "exact: the machine, cycle by cycle; functional: the same picture without time")
      ->check(CLI::IsMember({"exact", "functional"}))
      ->capture_default_str();
  command
      .add_option(
          "--leave-out", leave_out,
          "auto: units that the frame does not need are not built; none: all are. Same picture, same cycles")
      ->check(CLI::IsMember({"auto", "none"}))
      ->capture_default_str();
  units_option_ = command.add_option("--units", units, "rows of the table: folded by kind, or all units")
                      ->check(CLI::IsMember({"folded", "all"}))
                      ->capture_default_str();
  driver_option_ =
      command
          .add_option("--driver", driver,
                      "how units are scheduled: dispatcher is faster, native is SystemC's own. Same cycles")
          ->check(CLI::IsMember({"dispatcher", "native"}))
          ->capture_default_str();
  machine_options_ = {
      driver_option_,
      command
          .add_option("--window", window,
                      "how many cycles units may be simulated ahead of the exact bound: 0 is exact, more is "
                      "faster and approximate")
          ->type_name("W"),
      command
          .add_option("--max-cycles", max_cycles,
                      "gives up, and says who waits for whom, when the frame is not done by this cycle")
          ->type_name("N"),
      command
          .add_option(
              "--detail", detail,
              "draws: what each draw did, how long it took and what limited it, in --stats and as a "
              "table; tiles: counts by squares of "
              "the screen, in --stats; timeline: use of every resource, bytes by client and how full "
              "links are over the frame, in --stats; path: what the frame's end waited for, unit by "
              "unit and, with draws, draw by draw, as a table and in --stats (docs/why.md); misses: why "
              "texture caches missed, as a table and in --stats (docs/memory.md); textures: with which "
              "filters "
              "and levels each texture was sampled, and its bytes, as a table and in --stats. "
              "Same picture, same cycles")
          ->type_name(kDetailNames),
      command
          .add_option(
              "--report", report,
              fmt::format("writes all figures with the picture as a page for a browser, in one file that "
                          "needs no network (docs/report.md); --detail {} is part of it",
                          kDetailNames))
          ->type_name("F.html"),
      command
          .add_option(
              "--timeline", timeline,
              "writes the frame over time as a trace for Perfetto: .pftrace as TrackEvent protobuf, "
              ".json as Chrome's trace events; each draw in flight, the use of every unit's resources, "
              "bytes by client, how full links are")
          ->type_name("F.pftrace|F.json"),
      command
          .add_option(
              "--vcd", vcd,
              "writes tokens in every link and actions of every unit as waves for GTKWave, by SystemC's "
              "own tracing and scheduler; large: for short frames")
          ->type_name("F.vcd"),
      command
          .add_option("--energy", energy,
                      "estimates energy by unit and, with --detail draws or --report, by draw, and area: "
                      "relative, with its range, from a file of costs (docs/energy.md)")
          ->type_name("45nm|F.toml"),
      command
          .add_option("--faster", faster,
                      "makes all units of a kind so many times as fast, 1 to 100, in all that they do; "
                      "quadrille why tries every kind (docs/why.md)")
          ->type_name("UNIT=TIMES"),
      units_option_};
  command.add_flag("--alpha", alpha,
                   "keeps the alpha that the frame stored (otherwise pictures are written opaque)");
  command.add_flag("-q,--quiet", quiet, "prints no table");
}

void RenderJob::check_outputs() const {
  const auto check = [&](std::string_view flag, const std::optional<std::string>& path,
                         const std::vector<std::string>& extensions) {
    if (!path) return;
    if (frames.wanted()) check_pattern(flag, *path);
    check_output(flag, frames.wanted() ? numbered(*path, 0) : *path, extensions);
  };
  check("--out", out, {".png", ".exr"});
  check("--depth", depth, {".exr", ".png"});
  if (stats) check_json_output("--stats", *stats);
  if (csv) check_output("--csv", *csv, {".csv"});
  if (report) check_output("--report", *report, {".html"});
  if (timeline) check_output("--timeline", *timeline, {".pftrace", ".json"});
  if (vcd) check_output("--vcd", *vcd, {".vcd"});
  check_distinct({{"--out", out},
                  {"--depth", depth},
                  {"--stats", stats},
                  {"--csv", csv},
                  {"--report", report},
                  {"--timeline", timeline},
                  {"--vcd", vcd},
                  {"--film", frames.film}});
  frames.check_film();
}

void RenderJob::check_options_meant() const {
  for (const CLI::Option* option : machine_options_) {
    if (fidelity == "functional" && option->count() > 0)
      throw user_error(
          "{0}: a functional run has no units and no cycles; leave --fidelity functional or {0} out",
          option->get_name());
  }
  if (frames.wanted() && units_option_->count() > 0)
    throw user_error("--units: with --frames each frame is one row; --stats has the figures of every unit");
  if (frames.wanted() && timeline)
    throw user_error("--timeline: it is of one frame; leave --frames or --timeline out");
  if (vcd && (window || (driver_option_->count() > 0 && driver == "dispatcher")))
    throw user_error("--vcd: waves are written by SystemC's own scheduler; leave {} out",
                     window ? "--window" : "--driver dispatcher");
  if (vcd && frames.wanted()) throw user_error("--vcd: it is of one frame; leave --frames or --vcd out");
}

std::int64_t RenderJob::window_cycles() const {
  if (!window) return 0;
  const std::int64_t cycles = parse_whole(*window, "--window", 0, kMaxWindow);
  if (driver == "native" && cycles > 0)
    throw user_error("--window: the native driver is always exact; --window {} is for the dispatcher",
                     cycles);
  return cycles;
}

pipeline::DetailOptions RenderJob::details() const {
  const bool page = report && !frames.wanted();  // that of several frames shows none
  pipeline::DetailOptions chosen{.draws = page || timeline,
                                 .tiles = page,
                                 .timeline = page || timeline,
                                 .path = page,
                                 .misses = page,
                                 .textures = page};
  if (!detail) return chosen;
  choose_details(*detail, chosen);
  if ((chosen.tiles || (chosen.timeline && !timeline)) && !stats && !csv && !report)
    throw user_error("--detail: {} in the JSON alone; add --stats F.json",
                     chosen.tiles ? "tiles are" : "the timeline is");
  if (frames.wanted() && !stats)
    throw user_error("--detail: with --frames each frame is one row; add --stats F.json for its details");
  return chosen;
}

std::vector<std::pair<std::string, double>> RenderJob::faster_kinds() const {
  std::vector<std::pair<std::string, double>> kinds;
  for (const std::string& text : faster) {
    const std::size_t equals = std::min(text.find('='), text.size());
    const std::string kind = text.substr(0, equals);
    check_unit_kind("--faster", kind);
    if (equals == text.size()) throw user_error("--faster: how many times as fast? for example {}=1.1", kind);
    if (std::ranges::find(kinds, kind, [](const auto& given) { return given.first; }) != kinds.end())
      throw user_error("--faster: {} is given twice", kind);
    kinds.emplace_back(kind, parse_number(text.substr(equals + 1), "--faster", 1, kMostFaster));
  }
  return kinds;
}

RenderJob::Setting RenderJob::setting(const pipeline::MachineConfig& config) const {
  const hw::Clock clock(static_cast<std::int64_t>(config.gpu.clock_mhz * 1e6));
  hw::RunLimits limits;
  if (max_cycles) {
    const std::int64_t cycles = parse_whole(*max_cycles, "--max-cycles", 1, kMaxCycles);
    // beyond that it is later than time goes
    if (cycles < hw::kNever / (clock.period() + 1)) limits.max_time = clock.edge(cycles);
  }
  Setting chosen{config, std::move(limits), clock, clock.edge(window_cycles()), details(), faster_kinds()};
  if (energy) chosen.costs = pipeline::load_costs(*energy, config);
  return chosen;
}

int RenderJob::run() {
  scene.leave_out = scene.keep_packed = leave_out == "auto";
  scene.check();
  frames.check(scene);
  check_options_meant();
  pipeline::MachineConfig config;
  machine.apply(config);
  check_outputs();
  const Setting chosen = setting(config);
  return frames.wanted() ? run_frames(chosen) : run_one(chosen);
}

std::string RenderJob::DrawnJob::figures_json(const pipeline::MachineConfig& config) const {
  std::string json = pipeline::report_json({frame.figures, config, frame.image.width, frame.image.height});
  if (!kept.registers.empty()) json = pipeline::figures_with_kept(json, kept, config);
  return energy ? pipeline::figures_with_energy(json, *energy) : json;
}

RenderJob::DrawnJob RenderJob::simulate(const traces::CommandStream& stream, const Setting& setting,
                                        const hw::RunLimits& limits) const {
  const pipeline::MachineOptions options{
      .driver = driver == "native" ? pipeline::DriverKind::kNative : pipeline::DriverKind::kDispatcher,
      .window = setting.window,
      .leave_out = leave_out == "auto",
      .faster = setting.faster};
  const pipeline::MachineConfig& config = setting.config;
  if (!setting.costs && !setting.detail.any() && !vcd)
    return {pipeline::render_exact(stream, config, options, limits, setting.detail)};
  pipeline::KeptCounters kept;
  if (setting.costs && setting.detail.draws) kept.by_draw = pipeline::counters_of(*setting.costs);
  if (setting.detail.tiles) kept.by_square = pipeline::counters_by_square();
  DrawnJob drawn{
      vcd ? pipeline::render_exact_with_waves(stream, config, options, limits, setting.detail, kept, *vcd)
          : pipeline::render_exact_watched(stream, config, options, limits, setting.detail, kept)};
  if (setting.costs)
    drawn.energy = pipeline::energy_of(drawn.frame.figures, config, *setting.costs,
                                       kept.by_draw.draws.empty() ? nullptr : &kept.by_draw);
  drawn.kept = std::move(kept);
  return drawn;
}

RenderJob::DrawnJob RenderJob::draw(const SceneArguments::Loaded& loaded, const Setting& setting,
                                    const Outputs& outputs) const {
  const traces::CommandStream& stream = loaded.stream;
  const traces::PassTarget target = traces::shown_target(stream);
  if (depth && target.depth == traces::Format::kUndefined)
    throw user_error("--depth: {} has no depth attachment", scene.scene);
  Progress progress;
  progress.show("compiling shaders, building the machine");
  hw::RunLimits limits = setting.limits;
  limits.progress = [&](hw::Tick now) { progress.show_cycles(setting.clock.edges_before(now)); };
  DrawnJob drawn = [&] {
    try {
      return fidelity == "functional"
                 ? DrawnJob{pipeline::render_functional_frame(stream, setting.config.precision())}
                 : simulate(stream, setting, limits);
    } catch (const UserError& error) {
      // A shader of a trace or capture has a name of its own, and the file is what its user knows.
      const std::string_view text = error.what();
      if (!scene.is_trace() || text.starts_with("--") || text.find(scene.scene) != std::string_view::npos)
        throw;
      throw user_error("{}: {}", scene.scene, text);
    }
  }();
  const pipeline::RenderedFrame& frame = drawn.frame;
  std::vector<pipeline::LeftOut>& left_out_of_frame = drawn.frame.figures.left_out;
  left_out_of_frame.insert(left_out_of_frame.begin(), loaded.left_out.begin(), loaded.left_out.end());
  progress.show("writing");
  if (outputs.out) write_color(*outputs.out, frame.image, models::is_srgb_format(target.color), alpha);
  if (outputs.depth) write_depth(*outputs.depth, frame.image);
  return drawn;
}

void RenderJob::write_figures(const DrawnJob& drawn, const Setting& setting,
                              const traces::CommandStream& stream) const {
  const pipeline::FrameImage& image = drawn.frame.image;
  const pipeline::ReportSubject subject{drawn.frame.figures, setting.config, image.width, image.height};
  if (timeline)
    write_text(*timeline, timeline->ends_with(".json") ? pipeline::timeline_trace_json(subject)
                                                       : pipeline::timeline_protobuf(subject));
  if (!report && !csv && !stats) return;
  const std::string json = drawn.figures_json(setting.config);
  if (report) {
    const pipeline::PagePictures pictures{color_png(image), depth_png(image),
                                          pipeline::draws_by_square(stream, subject.machine.precision())};
    write_text(*report, pipeline::report_page(subject, json, pictures));
  }
  if (csv) write_text(*csv, pipeline::figures_csv(json));
  if (stats) write_text(*stats, json);
}

int RenderJob::run_one(const Setting& setting) const {
  const Stopwatch load;
  Progress progress;
  progress.show(fmt::format("loading {}", scene.scene));
  const SceneArguments::Loaded loaded = scene.load();
  const double load_s = load.seconds();
  progress.clear();
  DrawnJob drawn = draw(loaded, setting, {out, depth});
  pipeline::Figures& figures = drawn.frame.figures;
  note_host(figures, load_s);
  if (stats || csv || report || timeline) write_figures(drawn, setting, loaded.stream);
  const pipeline::UnitRows rows = units == "all" ? pipeline::UnitRows::kAll : pipeline::UnitRows::kFolded;
  const pipeline::FrameImage& image = drawn.frame.image;
  std::string table = pipeline::report_table({figures, setting.config, image.width, image.height}, rows);
  if (drawn.energy) table += pipeline::energy_table(*drawn.energy, figures);
  Tables(!quiet, stats).print(table);
  if (figures.checks_hold()) return kDone;
  say("quadrille: the figures contradict each other\n" + pipeline::failed_checks(figures));
  return kFailed;
}

int RenderJob::run_frames(const Setting& setting) const {
  const auto file = [](const std::optional<std::string>& pattern, std::int64_t number) {
    return pattern ? std::optional(numbered(*pattern, number)) : std::nullopt;
  };
  const auto draw_one = [&](const SceneArguments::Loaded& loaded, std::int64_t number) {
    const Stopwatch whole;
    DrawnJob drawn = draw(loaded, setting, {file(out, number), file(depth, number)});
    note_host(drawn.frame.figures, 0);
    drawn.frame.figures.host.wall_s = whole.seconds();
    const bool pictured = report || frames.film;
    return DrawnFrame{drawn.figures_json(setting.config),
                      pictured ? color_png(drawn.frame.image) : std::vector<std::byte>()};
  };
  if ((out && out->ends_with(".exr")) || (depth && depth->ends_with(".exr"))) scenes::open_image_module();
  const scenes::SceneOptions options = scene.is_trace() ? scenes::SceneOptions{} : scene.options();
  const std::string how =
      setting.window > 0 ? fmt::format("approximate (window of {} cycles)", window_cycles()) : fidelity;
  const std::string machine_and_how = fmt::format("machine {}, {}", setting.config.title(), how);
  std::optional<Film> film;
  pipeline::FramePictures pictures;
  const auto take = [&](std::int64_t number, double fps, std::vector<std::byte> png) {
    if (frames.film && !film) film.emplace(*frames.film, fps);
    if (film) film->add(png);
    if (report) pictures.emplace_back(number, std::move(png));
  };
  const Tables tables(!quiet, stats);
  const auto draw_all = [&] {
    if (scene.is_capture())
      return draw_capture_frames(scene, frames, machine_and_how, setting.config.precision(), tables, draw_one,
                                 take);
    const std::string about = fmt::format("{}x{}, {}", options.width, options.height, machine_and_how);
    return draw_frames(scene, frames, about, tables, draw_one, take);
  };
  const SequenceResult result = draw_all();
  if (film) film->finish();
  if (report) write_text(*report, pipeline::frames_page(result.json, pictures));
  if (csv) write_text(*csv, pipeline::frames_csv(result.json));
  if (stats) write_text(*stats, result.json);
  return result.exit_code;
}

}  // namespace quadrille::cli
