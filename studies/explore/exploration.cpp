#include "studies/explore/exploration.h"

#include <xxhash.h>

#include <algorithm>
#include <chrono>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "models/base/error.h"
#include "pipeline/report/report.h"
#include "scenes/scene.h"
#include "studies/child_run.h"
#include "studies/explore/point_run.h"
#include "traces/trace_file.h"

namespace quadrille::studies::explore {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMeasuredMachines = 3;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

LoadedScene with_hash(SceneEntry entry, traces::CommandStream stream) {
  const std::vector<std::byte> bytes = traces::encode_trace(stream);
  return {std::move(entry), std::move(stream),
          fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()))};
}

/// The frame that the next processes inherit. It is made when a task needs another one than the last.
class Exploration::Preparation {
 public:
  void make(const Exploration& e, const Task& task) {
    if (scene_ == &e.scenes_[task.scene] && needs_ == task.needs) return;
    scene_ = &e.scenes_[task.scene];
    needs_ = task.needs;
    frame_.reset();  // first, so that there are never two
    try {
      pipeline::MachineConfig machine;
      e.space_.configure(task.candidate->values, machine);
      frame_ = std::make_unique<pipeline::PreparedFrame>(scene_->stream, machine);
    } catch (const UserError&) {
      frame_.reset();  // the point builds it for itself, fails, and says why
    } catch (const std::bad_alloc&) { frame_.reset(); }
  }
  [[nodiscard]] pipeline::PreparedFrame* frame() const { return frame_.get(); }

 private:
  const LoadedScene* scene_ = nullptr;
  std::string needs_;
  std::unique_ptr<pipeline::PreparedFrame> frame_;
};

Exploration::Exploration(const Sweep& sweep, const Space& space, std::span<const LoadedScene> scenes,
                         Results& results, const ExploreSetting& setting, std::optional<std::int64_t> window)
    : sweep_(sweep),
      space_(space),
      scenes_(scenes),
      results_(results),
      setting_(setting),
      window_(window.value_or(sweep.window)) {
  std::vector<std::string> others = results.versions();
  std::erase(others, setting.version);
  if (!others.empty() && !setting.mix_versions)
    throw user_error(
        "the results hold points of {}; this is {}: begin other results with --out, or let them mix with "
        "--mix-versions",
        fmt::join(others, ", "), setting.version);
}

void Exploration::check_formulas(const Candidate& candidate) const {
  scenes::SceneOptions options;
  options.width = options.height = 16;
  const traces::CommandStream stream = scenes::load_scene("builtin:triangle", options);
  const std::string lines = output_of(
      run_in_child([&] {
        pipeline::MachineConfig machine;
        space_.configure(candidate.values, machine);
        const pipeline::RenderedFrame frame = pipeline::render_exact(stream, machine, {.leave_out = false});
        return figure_lines(pipeline::report_json({frame.figures, machine, 16, 16}));
      }),
      candidate.machine);
  check_objectives(sweep_, space_, candidate.values, figures_of(lines));
}

PointKey Exploration::key(std::size_t scene, const Candidate& candidate) const {
  return {scenes_[scene].hash, candidate.hash, window_};
}

std::optional<PointRow> Exploration::point(std::size_t scene, const Candidate& candidate) const {
  return results_.load(key(scene, candidate));
}

std::optional<std::vector<double>> Exploration::objectives(const Candidate& candidate) const {
  std::vector<std::vector<double>> scenes;
  for (std::size_t s = 0; s < scenes_.size(); ++s) {
    const std::optional<PointRow> row = point(s, candidate);
    if (!row || !row->done()) return std::nullopt;
    scenes.push_back(objective_values(sweep_, space_, candidate.values, figures_of(row->figures)));
  }
  return over_scenes(sweep_, scenes);
}

/// By scene, and within a scene those together that share a frame.
std::vector<Exploration::Task> Exploration::tasks(std::span<const Candidate> candidates,
                                                  bool retry_failed) const {
  const std::map<PointKey, std::string> known = results_.statuses();
  std::set<PointKey> taken;
  std::vector<Task> all;
  for (const Candidate& candidate : candidates) {
    std::string needs;
    for (std::size_t s = 0; s < scenes_.size(); ++s) {
      const PointKey point = key(s, candidate);
      const auto found = known.find(point);
      if (found != known.end() && (found->second == "done" || !retry_failed)) continue;
      if (setting_.only && !setting_.only->contains(point)) continue;
      if (!taken.insert(point).second) continue;
      if (needs.empty()) {
        pipeline::MachineConfig machine;
        space_.configure(candidate.values, machine);
        needs = pipeline::PreparedFrame::needs(machine);
      }
      all.push_back({s, &candidate, needs});
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Task& a, const Task& b) {
    return std::tie(a.scene, a.needs) < std::tie(b.scene, b.needs);
  });
  return all;
}

std::size_t Exploration::known(std::span<const Candidate> candidates) const {
  return candidates.size() * scenes_.size() - tasks(candidates, setting_.retry_failed).size();
}

std::vector<PointKey> Exploration::missing(std::span<const Candidate> candidates, bool retry_failed) const {
  std::vector<PointKey> points;
  for (const Task& task : tasks(candidates, retry_failed)) points.push_back(key(task.scene, *task.candidate));
  return points;
}

/// In the process of a point.
std::string Exploration::draw(const Task& task, pipeline::PreparedFrame* prepared) const {
  const LoadedScene& scene = scenes_[task.scene];
  if (setting_.in_process) setting_.in_process(scene.entry, *task.candidate);
  pipeline::MachineConfig machine;
  space_.configure(task.candidate->values, machine);
  // What was committed when this process began; a picture that is sent twice is kept once.
  return encode(draw_point(scene.stream, machine, window_, prepared,
                           [this](const std::string& hash) { return pictures_.contains(hash); }));
}

void Exploration::draw_all(const std::vector<Task>& tasks,
                           const std::function<void(std::size_t, PointRow, std::vector<std::byte>)>& done) {
  Preparation preparation;
  std::vector<ChildWork> works;
  works.reserve(tasks.size());
  const ChildLimits limits{
      .seconds = sweep_.seconds, .memory_bytes = sweep_.memory_mib << 20, .keep_log = true};
  for (const Task& task : tasks)
    works.push_back({[this, &task, &preparation] { return draw(task, preparation.frame()); }, limits,
                     [this, &task, &preparation] { preparation.make(*this, task); }});
  run_in_children(works, setting_.jobs, [&](std::size_t i, const ChildRun& run) {
    const Task& task = tasks[i];
    PointRow row;
    row.key = key(task.scene, *task.candidate);
    row.version = setting_.version;
    row.scene = scenes_[task.scene].entry.name;
    row.machine = task.candidate->machine;
    pipeline::MachineConfig from, machine;
    pipeline::load_machine(from, row.machine);
    space_.configure(task.candidate->values, machine);
    row.settings = machine_settings(from, machine);
    row.wall_s = run.wall_s;
    row.cpu_s = run.cpu_s;
    row.peak_rss_mib = run.peak_rss_mib;
    row.status = child_end_name(run.end);
    std::vector<std::byte> png;
    if (run.end == ChildEnd::kDone) {
      PointOutput output = decode_output(run.output);  // a process that was done has sent it whole
      row.figures = std::move(output.figures);
      row.picture = std::move(output.picture);
      row.simulate_s = output.simulate_s;
      png = std::move(output.png);
      pictures_.insert(row.picture);
    } else {
      row.reason = run.output;
      row.log = run.log;
    }
    done(i, std::move(row), std::move(png));
  });
}

/// The oldest first; what cannot be saved stays.
void Exploration::save(std::vector<Unsaved>& unsaved) const {
  std::size_t saved = 0;
  try {
    for (const Unsaved& point : unsaved) {
      results_.save(point.row, point.png);
      ++saved;
    }
  } catch (const ResultsNotWritten&) {
    unsaved.erase(unsaved.begin(), unsaved.begin() + static_cast<std::ptrdiff_t>(saved));
    throw;
  }
  unsaved.clear();
}

void Exploration::run(std::span<const Candidate> candidates, std::size_t later) {
  const std::vector<Task> all = tasks(candidates, setting_.retry_failed);
  const Clock::time_point start = Clock::now();
  progress_.total = progress_.done + all.size() + later * scenes_.size();
  std::vector<Unsaved> unsaved;
  draw_all(all, [&](std::size_t i, PointRow row, std::vector<std::byte> png) {
    ++progress_.done;
    progress_.failed += !row.done();
    progress_.last =
        fmt::format("{} on {}: {}", row.scene, fmt::join(all[i].candidate->values, " "), row.status);
    progress_.seconds_left = (seconds_ + seconds_since(start)) / static_cast<double>(progress_.done) *
                             static_cast<double>(progress_.total - progress_.done);
    unsaved.push_back({std::move(row), std::move(png)});
    try {
      save(unsaved);
    } catch (const ResultsNotWritten&) {  // tried again when the next one ends: there may be room then
    }
    setting_.progress(progress_);
  });
  seconds_ += seconds_since(start);
  try {
    save(unsaved);
  } catch (const ResultsNotWritten& error) {
    throw user_error(
        "the results cannot be written: {}; {} points were drawn in vain: make room and run it again",
        error.what(), unsaved.size());
  }
}

Measured Exploration::measure(std::span<const Candidate> candidates) {
  std::vector<Task> few;
  const std::size_t count = std::min(kMeasuredMachines, candidates.size());
  for (std::size_t s = 0; s < scenes_.size(); ++s)
    for (std::size_t i = 0; i < count; ++i) {
      const Candidate& candidate = candidates[count == 1 ? 0 : i * (candidates.size() - 1) / (count - 1)];
      pipeline::MachineConfig machine;
      space_.configure(candidate.values, machine);
      few.push_back({s, &candidate, pipeline::PreparedFrame::needs(machine)});
    }
  Measured measured;
  measured.points = few.size();
  measured.seconds.assign(scenes_.size(), 0);
  std::map<std::string, std::size_t> pictures;
  draw_all(few, [&](std::size_t i, const PointRow& row, const std::vector<std::byte>& png) {
    measured.seconds[few[i].scene] += row.wall_s / static_cast<double>(count);
    measured.bytes_a_point += packed_bytes(row) / static_cast<double>(few.size());
    pictures[row.picture] = png.size();
  });
  for (const auto& [hash, bytes] : pictures) measured.picture_bytes += static_cast<double>(bytes);
  return measured;
}

}  // namespace quadrille::studies::explore
