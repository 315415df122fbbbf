/// A frame, or several, to render: what `render` and `trace replay` do with their arguments.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/frame_sequence.h"
#include "cli/machine_arguments.h"
#include "cli/scene_arguments.h"
#include "hw/base/clock.h"
#include "pipeline/render.h"
#include "pipeline/report/energy.h"
#include "pipeline/report/report.h"

namespace quadrille::cli {

struct RenderJob {
  SceneArguments scene;
  MachineArguments machine;
  FrameArguments frames;  ///< of `render` alone
  std::optional<std::string> out, depth, stats, csv, report, timeline, vcd, max_cycles, window;
  std::string fidelity = "exact", leave_out = "auto", driver = "dispatcher", units = "folded";
  std::optional<std::string> detail;  ///< words, with commas between them
  std::optional<std::string> energy;  ///< a file of costs, or its name
  std::vector<std::string> faster;    ///< "texture=1.1"
  bool alpha = false, quiet = false;

  /// Adds every option but those of the scene.
  void add_to(CLI::App& command);
  /// Checks all arguments, loads, renders, writes the files and prints the table. Returns the exit code;
  /// throws `UserError`.
  int run();

 private:
  /// What the arguments say of the run, checked.
  struct Setting {
    const pipeline::MachineConfig& config;
    hw::RunLimits limits;
    hw::Clock clock;
    hw::Tick window = 0;
    pipeline::DetailOptions detail;
    std::vector<std::pair<std::string, double>> faster = {};  ///< kinds of units, how many times
    std::optional<pipeline::CostFile> costs = {};             ///< of energy
  };
  /// Where one frame's files go.
  struct Outputs {
    std::optional<std::string> out, depth;
  };

  void check_outputs() const;
  /// Throws `UserError` for an option that would change nothing.
  void check_options_meant() const;
  /// The window in cycles; 0 for an exact run. Throws `UserError` when it does not go with the other
  /// arguments.
  [[nodiscard]] std::int64_t window_cycles() const;
  /// Throws `UserError` for a word that is none, and for details that nothing would show.
  [[nodiscard]] pipeline::DetailOptions details() const;
  /// Throws `UserError` for a unit that there is none of.
  [[nodiscard]] std::vector<std::pair<std::string, double>> faster_kinds() const;
  [[nodiscard]] Setting setting(const pipeline::MachineConfig& config) const;
  /// A frame, and the energy that it takes where that was asked for.
  struct DrawnJob {
    pipeline::RenderedFrame frame;
    std::optional<pipeline::EnergyFigures> energy = {};
    pipeline::KeptCounters kept = {};
    /// All figures as JSON.
    [[nodiscard]] std::string figures_json(const pipeline::MachineConfig& config) const;
  };
  /// Draws a frame and writes its pictures.
  [[nodiscard]] DrawnJob draw(const SceneArguments::Loaded& loaded, const Setting& setting,
                              const Outputs& outputs) const;
  [[nodiscard]] DrawnJob simulate(const traces::CommandStream& stream, const Setting& setting,
                                  const hw::RunLimits& limits) const;
  /// Writes the documents that were asked for.
  void write_figures(const DrawnJob& drawn, const Setting& setting,
                     const traces::CommandStream& stream) const;
  [[nodiscard]] int run_one(const Setting& setting) const;
  [[nodiscard]] int run_frames(const Setting& setting) const;

  const CLI::Option* units_option_ = nullptr;
  const CLI::Option* driver_option_ = nullptr;
  /// of the machine's units and cycles, which a functional run has none of
  std::vector<const CLI::Option*> machine_options_;
};

}  // namespace quadrille::cli
