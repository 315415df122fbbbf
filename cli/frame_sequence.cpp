#include "cli/frame_sequence.h"
#include "scenes/scene.h"

#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <span>

#include "cli/command.h"
#include "cli/film.h"
#include "cli/image_files.h"
#include "cli/process.h"
#include "models/base/error.h"
#include "models/base/say.h"
#include "studies/child_run.h"

namespace quadrille::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kFramesSchema = "quadrille-frames-1";
constexpr std::int64_t kMaxFrames = 100'000, kMaxJobs = 64;
constexpr double kMaxFps = 1e6, kNoLimit = 1e9;  // seconds: a frame takes as long as it takes

/// Which moments are drawn.
struct Plan {
  std::int64_t frames = 1;
  double start = 0, step = 0;  ///< seconds
  bool animated = false, orbit = false;

  /// Of a film in which the animation goes as fast as it is meant to; of a turn, those of many films.
  [[nodiscard]] double fps() const { return step > 0 ? 1 / step : 25; }
  [[nodiscard]] scenes::Moment moment(std::int64_t frame) const {
    scenes::Moment m{start + step * static_cast<double>(frame), std::nullopt};
    if (orbit) m.orbit = static_cast<double>(frame) / static_cast<double>(frames);
    return m;
  }
};

Plan make_plan(const FrameArguments& arguments, const scenes::SceneOptions& options,
               const scenes::Scene& scene) {
  Plan plan;
  plan.frames = parse_whole(*arguments.frames, "--frames", 1, kMaxFrames);
  plan.animated = scene.animated() && scene.length() > 0;
  plan.orbit = arguments.orbit || !plan.animated;
  plan.start = options.time.value_or(0);
  if (arguments.fps && !plan.animated)
    throw user_error("--fps: the scene has no animation; its frames are a turn around it");
  if (arguments.fps) {
    plan.step = 1 / parse_number(*arguments.fps, "--fps", 1 / kMaxFps, kMaxFps);
  } else if (plan.animated) {
    plan.step = scene.length() / static_cast<double>(plan.frames);
  }
  return plan;
}

/// What to say of frames after the animation's end; nothing if there are none.
std::vector<std::string> plan_notes(const Plan& plan, const scenes::Scene& scene) {
  if (!plan.animated || scene.repeats()) return {};
  std::int64_t late = 0;
  while (late < plan.frames && plan.moment(plan.frames - 1 - late).time > scene.length()) ++late;
  if (late == 0) return {};
  return {
      fmt::format("the last {} of {} frames are after the animation's end at {:g} s and show its last pose",
                  late, plan.frames, scene.length())};
}

/// What the limiter names, and its share.
std::string limit_text(const Json& limit) {
  if (limit.is_null()) return "-";
  const std::string kind = limit["kind"], name = limit["name"];
  const bool part_of_time =
      name != "scan_out" &&
      (kind == "work" || kind == "latency");  // scan-out's share is the part of the frame after all else
  return fmt::format("{}{} {:.1f}", part_of_time ? kind + " of " : "", name,
                     100 * limit["share"].get<double>());
}

std::string head() {
  return fmt::format("  {:>6}{:>10}{:>8}{:>13}{:>10}{:>12}{:>8}{:>12}{:>13}{:>11}  {}\n", "frame", "time s",
                     "turn", "cycles", "ms", "scan-out ms", "draws", "triangles", "fragments", "memory MB",
                     "what limits it, %");
}

std::string row(std::int64_t number, const Plan& plan, const Json& figures) {
  const Json& f = figures["frame"];
  const scenes::Moment moment = plan.moment(number);
  const bool timed = !f["cycles"].is_null();
  const auto number_or_dash = [](bool given, const std::string& text) {
    return given ? text : std::string("-");
  };
  std::string out = fmt::format(
      "  {:>6} {:>9}{:>8}", number, number_or_dash(plan.animated, fmt::format("{:.3f}", moment.time)),
      number_or_dash(moment.orbit.has_value(), fmt::format("{:.3f}", moment.orbit.value_or(0))));
  if (timed) {
    const double cycles = f["cycles"].get<double>();
    const double per_ms = f["clock_mhz"].get<double>() * 1e3;
    out += fmt::format("{:>13} {:>9.3f} {:>11.3f}", f["cycles"].get<std::int64_t>(), cycles / per_ms,
                       f["scan_out_cycles"].get<double>() / per_ms);
  } else {
    out += fmt::format("{:>13}{:>10}{:>12}", "-", "-", "-");
  }
  out += fmt::format("{:>8}{:>12}{:>13}", f["draws"].get<std::uint64_t>(),
                     f["triangles"].get<std::uint64_t>(), f["fragments_shaded"].get<std::uint64_t>());
  if (!timed) return out + fmt::format("{:>11}  -\n", "-");
  return out +
         fmt::format("{:>11.3f}  {}\n", f["memory_bytes"].get<double>() * 1e-6, limit_text(figures["limit"]));
}

std::string note_rows(const std::vector<std::string>& notes) {
  std::string text;
  for (const std::string& note : notes) text += fmt::format("          note: {}\n", note);
  return text;
}

/// The laws that a frame's figures break, a line each.
std::string broken_laws(std::int64_t number, const Json& figures) {
  std::string text;
  for (const Json& check : figures["checks"]) {
    if (!check["holds"].get<bool>())
      text += fmt::format("quadrille: frame {}: its figures contradict each other: {}\n", number,
                          check["law"].get<std::string>());
  }
  return text;
}

/// What a row of frames takes: one after another, and where the scan-out of each overlaps the drawing of the
/// next. Two targets take turns: a frame is drawn when the one before it is drawn and the target that it
/// draws into, which the one before that is shown from, is free. Neither slows the other in memory.
class DisplayQueue {
 public:
  /// When the next frame is drawn and shown, in cycles since the first began to be drawn; null when it was
  /// not timed.
  Json add(const Json& frame) {
    if (frame["cycles"].is_null()) return nullptr;
    const std::int64_t cycles = frame["cycles"], drawing = frame["render_cycles"];
    const std::int64_t from = std::max(drawn_, shown_before_);
    shown_before_ = shown_;
    drawn_ = from + drawing;
    shown_ = std::max(drawn_, shown_) + (cycles - drawing);
    one_after_another_ += cycles;
    clock_mhz_ = frame["clock_mhz"];
    ++frames_;
    return {{"drawn_from", from}, {"drawn_at", drawn_}, {"shown_at", shown_}};
  }
  /// The last line of the table; empty when no frame was timed.
  [[nodiscard]] std::string text() const {
    if (frames_ == 0) return "";
    const auto rate = [this](std::int64_t cycles) {
      return fmt::format("{} cycles, {:.1f} frames/s", cycles,
                         1e6 * clock_mhz_ * frames_ / static_cast<double>(cycles));
    };
    return fmt::format(
        "  all: {} one after another; {} where the scan-out of each overlaps the drawing of the next\n",
        rate(one_after_another_), rate(shown_));
  }
  [[nodiscard]] Json json() const {
    if (frames_ == 0) return nullptr;
    return {{"one_after_another", one_after_another_}, {"overlapped", shown_}, {"clock_mhz", clock_mhz_}};
  }

 private:
  std::int64_t drawn_ = 0, shown_ = 0, shown_before_ = 0, one_after_another_ = 0;
  double clock_mhz_ = 0;
  int frames_ = 0;
};

/// A frame as it comes from its process: figures, a zero, and the picture.
struct Drawn {
  Json figures;
  std::vector<std::byte> png;
};

std::string sent(const DrawnFrame& frame) {
  std::string text = frame.figures_json;
  text += '\0';
  return text.append(reinterpret_cast<const char*>(frame.png.data()), frame.png.size());
}

Drawn received(const std::string& text) {
  const std::size_t end = text.find('\0');
  const auto png = std::as_bytes(std::span(text).subspan(end + 1));
  return {Json::parse(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end)),
          {png.begin(), png.end()}};
}

/// Frames as their processes end, in any order; rows are printed, and laws checked, in the frames' order.
class Sequence {
 public:
  Sequence(const Plan& plan, const Tables& tables, const TakePicture& take)
      : plan_(plan), tables_(tables), take_(take) {}

  void add(std::int64_t number, Drawn drawn) {
    waiting_.emplace(number, std::move(drawn));
    while (!waiting_.empty() && waiting_.begin()->first == size()) {
      append(std::move(waiting_.begin()->second));
      waiting_.erase(waiting_.begin());
    }
  }
  /// Frames in order so far.
  [[nodiscard]] std::int64_t size() const { return static_cast<std::int64_t>(frames_.size()); }
  [[nodiscard]] Json take() { return std::move(frames_); }
  [[nodiscard]] const DisplayQueue& queue() const { return queue_; }
  [[nodiscard]] int exit_code() const { return exit_code_; }

 private:
  void append(Drawn drawn) {
    const std::int64_t number = size();
    Json& figures = drawn.figures;
    if (take_) take_(number, plan_.fps(), std::move(drawn.png));
    tables_.print(row(number, plan_, figures) + note_rows(figures["notes"]));
    if (const std::string broken = broken_laws(number, figures); !broken.empty()) {
      say(broken);
      exit_code_ = kFailed;
    }
    const scenes::Moment moment = plan_.moment(number);
    Json overlapped = queue_.add(figures["frame"]);
    frames_.push_back({{"frame", number},
                       {"time_s", plan_.animated ? Json(moment.time) : Json(nullptr)},
                       {"turn", moment.orbit ? Json(*moment.orbit) : Json(nullptr)},
                       {"overlapped", std::move(overlapped)},
                       {"figures", std::move(figures)}});
  }

  const Plan& plan_;
  const Tables& tables_;
  const TakePicture& take_;
  DisplayQueue queue_;
  std::map<std::int64_t, Drawn> waiting_;
  Json frames_ = Json::array();
  int exit_code_ = kDone;
};

}  // namespace

void FrameArguments::add_to(CLI::App& command) {
  command
      .add_option("--frames", frames,
                  "draws N frames over the scene's animation, or around the scene if it has none; the names "
                  "of --out and --depth then need #, "
                  "as in frame_####.png")
      ->type_name("N");
  command
      .add_option("--fps", fps,
                  "with --frames: frames a second of the animation (default: N frames over its whole length)")
      ->type_name("F");
  command.add_flag("--orbit", orbit,
                   "with --frames: carries the camera once around the scene (the scene moves too if --time "
                   "or --animation is given)");
  command
      .add_option("--film", film,
                  "with --frames: makes a film of the frames, by ffmpeg, at the pace of the animation, or 25 "
                  "frames a second of a turn")
      ->type_name("F.mp4|F.gif");
  command
      .add_option("--jobs", jobs, "with --frames: frames at a time, each in a process of its own (default 1)")
      ->type_name("N");
}

void FrameArguments::check_film() const {
  if (!film) return;
  check_output("--film", *film, {".mp4", ".gif"});
  check_film_program();
}

int FrameArguments::job_count() const {
  return jobs ? static_cast<int>(parse_whole(*jobs, "--jobs", 1, kMaxJobs)) : 1;
}

void FrameArguments::check() const {
  if (frames) {
    (void)parse_whole(*frames, "--frames", 1, kMaxFrames);
    (void)job_count();
    if (fps) (void)parse_number(*fps, "--fps", 1 / kMaxFps, kMaxFps);
    return;
  }
  if (fps) throw user_error("--fps: goes with --frames");
  if (orbit) throw user_error("--orbit: goes with --frames");
  if (jobs) throw user_error("--jobs: goes with --frames");
  if (film) throw user_error("--film: goes with --frames");
}

void check_pattern(std::string_view flag, const std::string& pattern) {
  const std::string name = std::filesystem::path(pattern).filename().string();
  const std::size_t first = name.find('#');
  const std::size_t end = first == std::string::npos ? first : name.find_first_not_of('#', first);
  if (first == std::string::npos || (end != std::string::npos && name.find('#', end) != std::string::npos))
    throw user_error(
        "{}: {}: with --frames the name needs one run of # for the frame's number, as in frame_####.png",
        flag, pattern);
}

std::string numbered(const std::string& pattern, std::int64_t frame) {
  const std::filesystem::path path(pattern);
  std::string name = path.filename().string();
  const std::size_t first = name.find('#'), end = std::min(name.size(), name.find_first_not_of('#', first));
  name.replace(first, end - first, fmt::format("{:0{}}", frame, end - first));
  return (path.parent_path() / name).string();
}

SequenceResult draw_frames(const SceneArguments& scene, const FrameArguments& frames,
                           const std::string& about, const Tables& tables, const DrawFrame& draw,
                           const TakePicture& take) {
  if (scene.is_trace()) throw user_error("--frames: {} is a trace, which holds one frame", scene.scene);
  scenes::SceneOptions options = scene.options();
  const bool moves = !frames.orbit || frames.fps || options.time || !options.animation.empty();
  if (moves && !options.time) options.time = 0;
  Progress progress;
  progress.show(fmt::format("loading {}", scene.scene));
  scenes::Scene file(scene.scene, options);
  const Plan plan = make_plan(frames, options, file);
  progress.clear();
  const std::string over = plan.animated ? fmt::format("{} frames over {:g} s", plan.frames,
                                                       plan.step * static_cast<double>(plan.frames))
                                         : fmt::format("{} frames around the scene", plan.frames);
  const std::vector<std::string> notes = plan_notes(plan, file);
  tables.print(fmt::format("FRAMES  {}, {}, {}\n{}{}", scene.scene, over, about, note_rows(notes), head()));
  if (plan.frames > 1) {  // unpacks here, once, the images that the frames' processes may sample
    (void)file.record(plan.moment(0));
    file.unpack_images();
  }
  Sequence sequence(plan, tables, take);
  std::vector<studies::ChildWork> works;
  works.reserve(static_cast<std::size_t>(plan.frames));
  for (std::int64_t i = 0; i < plan.frames; ++i)
    works.push_back({[&, i] { return sent(draw(scene.record(file, plan.moment(i)), i)); }, {kNoLimit, 0}});
  progress.show(fmt::format("frame 0 of {}", plan.frames));
  studies::run_in_children(works, frames.job_count(), [&](std::size_t i, const studies::ChildRun& run) {
    Drawn drawn = received(studies::output_of(run, fmt::format("frame {}", i)));
    progress.clear();
    sequence.add(static_cast<std::int64_t>(i), std::move(drawn));
    if (sequence.size() < plan.frames)
      progress.show(fmt::format("frame {} of {}", sequence.size(), plan.frames));
  });
  progress.clear();
  tables.print(sequence.queue().text());
  const Json document = {{"schema", kFramesSchema},
                         {"scene", scene.scene},
                         {"cycles", sequence.queue().json()},
                         {"animation_s", plan.animated ? Json(file.length()) : Json(nullptr)},
                         {"notes", notes},
                         {"frames", sequence.take()}};
  return {sequence.exit_code(), document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"};
}

}  // namespace quadrille::cli
