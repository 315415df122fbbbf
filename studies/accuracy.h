/// Error against run time: what each setting of the fidelity dial costs the host, and how far off its figures
/// and its picture are.
///
/// Every run is a process of its own; the settings take turns, so that a drift of the host meets all of them.
/// Figures do not vary between runs of a setting (that is checked), host times do, so they are given as order
/// statistics of processor time. docs/accuracy.md reads the result.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "studies/accuracy_error.h"
#include "studies/timed_run.h"

namespace quadrille::studies {

struct StudyScene {
  std::string name;  ///< as given by the user
  traces::CommandStream stream;
  /// the same frame in the colours of its triangles; a trace has none
  std::optional<traces::CommandStream> visibility;
};

struct AccuracyOptions {
  std::vector<std::int64_t> windows{1, 4, 16, 64, 256, 1024, 4096};  ///< cycles, each above 0
  int repeat = 5;                                                    ///< runs of each setting
  bool precision = true;                                             ///< also vary the precisions
  std::function<void(const std::string&)> progress;                  ///< called before each piece of work
};

struct SettingResult {
  RunSetting setting;
  std::vector<double> cpu_s, wall_s;  ///< of each run, in the order of the rounds
  double speed_up = 0;                ///< exact median / this median, of processor time
  std::optional<MachineCost> cost;    ///< none of `functional`
  std::optional<CostError> error;     ///< against exact
  std::size_t image = 0;              ///< index into `SceneAccuracy::images`
};

/// One precision varied, the others as the machine has them. Functional runs: timing never changes pixels.
struct PrecisionResult {
  std::string parameter;  ///< "subpixel_bits", "subtexel_bits", "lod_bits"
  int bits = 0;
  std::vector<double> cpu_s;
  ImageError all;                           ///< against the ideal reference, all pixels
  std::optional<ImageError> same_triangle;  ///< only those that show the same triangle as the reference
  /// of all pixels: they show another triangle, or one of the two shows none
  std::optional<double> other_triangle_percent;
};

struct SceneAccuracy {
  std::string name;
  std::uint32_t width = 0, height = 0;
  std::vector<SettingResult> settings;  ///< functional, exact, then the windows as given
  /// of each distinct picture, against the ideal reference; the first is that of `exact`
  std::vector<ImageError> images;
  std::vector<PrecisionResult> precision;  ///< empty when not asked for
};

/// Measures one scene. Throws what `run_timed` and the reference throw.
[[nodiscard]] SceneAccuracy measure_accuracy(const StudyScene& scene, const pipeline::MachineConfig& machine,
                                             const AccuracyOptions& options);

}  // namespace quadrille::studies
