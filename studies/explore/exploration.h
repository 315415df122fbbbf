/// Running a sweep: its points, each a process, into a file of results.
///
/// A point that crashes, hangs or runs out of memory is a row with the reason and what it said; the others go
/// on. Scene, shaders, decoded textures and the frame's memory are made once and inherited by the processes.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "pipeline/prepared_frame.h"
#include "studies/explore/objectives.h"
#include "studies/explore/results.h"
#include "studies/explore/space.h"
#include "studies/explore/sweep.h"
#include "traces/command_stream.h"

namespace quadrille::studies::explore {

struct LoadedScene {
  SceneEntry entry;
  traces::CommandStream stream;
  std::string hash;  ///< of the stream
};
/// The scene with its hash.
[[nodiscard]] LoadedScene with_hash(SceneEntry entry, traces::CommandStream stream);

/// How far a sweep is.
struct ExploreProgress {
  std::size_t done = 0, total = 0;  ///< points that had to be drawn
  std::size_t failed = 0;
  double seconds_left = 0;
  std::string last;  ///< scene and machine of the point that ended last
};

struct ExploreSetting {
  std::string version;  ///< of the program, with its build
  int jobs = 1;         ///< processes at a time
  bool retry_failed = false, mix_versions = false;
  std::optional<std::set<PointKey>> only = std::nullopt;  ///< no other point is drawn
  std::function<void(const ExploreProgress&)> progress = [](const ExploreProgress&) {};
  /// called in the process of a point before it draws: tests make points fail with it
  std::function<void(const SceneEntry&, const Candidate&)> in_process = {};
};

/// What a few points cost.
struct Measured {
  std::size_t points = 0;                       ///< that were drawn for it
  std::vector<double> seconds;                  ///< a point, by scene
  double bytes_a_point = 0, picture_bytes = 0;  ///< of a row, and of all pictures
};

class Exploration {
 public:
  /// Everything must outlive it. Throws `UserError` when another version of the program drew points of the
  /// results, unless the setting lets versions mix. `window`: another one than the sweep's, in cycles.
  Exploration(const Sweep& sweep, const Space& space, std::span<const LoadedScene> scenes, Results& results,
              const ExploreSetting& setting, std::optional<std::int64_t> window = std::nullopt);

  /// Throws `UserError` when an objective asks for what is no figure; draws a tiny frame on the first machine
  /// to know.
  void check_formulas(const Candidate& candidate) const;
  /// How many points of these are known, and are not to be drawn again.
  [[nodiscard]] std::size_t known(std::span<const Candidate> candidates) const;
  /// The points of these that are to be drawn. `retry_failed`: those that are known to fail too.
  [[nodiscard]] std::vector<PointKey> missing(std::span<const Candidate> candidates, bool retry_failed) const;
  /// Draws every other point of these machines. `later`: so many machines may follow; the progress counts
  /// their points. Throws `UserError` when points could not be saved at last.
  void run(std::span<const Candidate> candidates, std::size_t later = 0);
  /// Draws a few of them, and saves nothing.
  [[nodiscard]] Measured measure(std::span<const Candidate> candidates);

  [[nodiscard]] PointKey key(std::size_t scene, const Candidate& candidate) const;
  /// What is known of a point.
  [[nodiscard]] std::optional<PointRow> point(std::size_t scene, const Candidate& candidate) const;
  /// Its objectives over the scenes; none when a point of it is not done.
  [[nodiscard]] std::optional<std::vector<double>> objectives(const Candidate& candidate) const;
  [[nodiscard]] std::span<const LoadedScene> scenes() const { return scenes_; }

 private:
  /// A point that is to be drawn.
  struct Task {
    std::size_t scene = 0;
    const Candidate* candidate = nullptr;
    std::string needs;  ///< of the machine, as `PreparedFrame::needs`
  };
  /// A point that could not be saved yet.
  struct Unsaved {
    PointRow row;
    std::vector<std::byte> png;
  };
  class Preparation;

  [[nodiscard]] std::vector<Task> tasks(std::span<const Candidate> candidates, bool retry_failed) const;
  [[nodiscard]] std::string draw(const Task& task, pipeline::PreparedFrame* prepared) const;
  void draw_all(const std::vector<Task>& tasks,
                const std::function<void(std::size_t, PointRow, std::vector<std::byte>)>& done);
  void save(std::vector<Unsaved>& unsaved) const;

  const Sweep& sweep_;
  const Space& space_;
  std::span<const LoadedScene> scenes_;
  Results& results_;
  const ExploreSetting& setting_;
  std::int64_t window_;
  /// hashes of pictures that a process has sent
  std::set<std::string> pictures_;
  ExploreProgress progress_;
  double seconds_ = 0;  ///< that earlier runs took
};

}  // namespace quadrille::studies::explore
