#include "cli/frame_sequence.h"
#include "scenes/scene.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/command.h"
#include "cli/film.h"
#include "cli/frame_rows.h"
#include "cli/image_files.h"
#include "cli/process.h"
#include "models/base/error.h"
#include "studies/child_run.h"

namespace quadrille::cli {
namespace {

constexpr std::int64_t kMaxFrames = 100'000, kMaxJobs = 64;
constexpr double kMaxFps = 1e6;

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
  plan.frames = arguments.count();
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

}  // namespace

void FrameArguments::add_to(CLI::App& command) {
  command
      .add_option(
          "--frames", frames,
          "draws N frames over the scene's animation, or around the scene if it has none; of a capture "
          "its first N, each with what the one before it left; the names "
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

std::int64_t FrameArguments::count() const { return parse_whole(*frames, "--frames", 1, kMaxFrames); }

int FrameArguments::job_count() const {
  return jobs ? static_cast<int>(parse_whole(*jobs, "--jobs", 1, kMaxJobs)) : 1;
}

void FrameArguments::check(const SceneArguments& scene) const {
  if (frames && scene.is_capture() && (fps || orbit))
    throw user_error("{}: {} is a capture, whose frames come one after the other as they were captured",
                     fps ? "--fps" : "--orbit", scene.scene);
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
  tables.print(
      fmt::format("FRAMES  {}, {}, {}\n{}{}", scene.scene, over, about, note_rows(notes), frames_head()));
  if (plan.frames > 1) {  // unpacks here, once, the images that the frames' processes may sample
    (void)file.record(plan.moment(0));
    file.unpack_images();
  }
  const auto labels = [&](std::int64_t frame) {
    const scenes::Moment moment = plan.moment(frame);
    return FrameLabels{plan.animated ? std::optional(moment.time) : std::nullopt, moment.orbit};
  };
  FrameRows rows({plan.frames, plan.fps(), labels}, tables, take);
  std::vector<studies::ChildWork> works;
  works.reserve(static_cast<std::size_t>(plan.frames));
  for (std::int64_t i = 0; i < plan.frames; ++i)
    works.push_back(
        {[&, i] { return sent(draw(scene.record(file, plan.moment(i)), i)); }, {kFrameSeconds, 0}});
  rows.run(works, frames.job_count());
  return rows.result({{"scene", scene.scene},
                      {"animation_s", plan.animated ? Json(file.length()) : Json(nullptr)},
                      {"notes", notes}});
}

}  // namespace quadrille::cli
