/// Experiments: what others measured on real hardware or published of simulators, run on the simulated
/// machine, with the band that the published figures give.
///
/// An experiment is one file of this folder and one line of `experiments()`. It draws its frames, each in a
/// process of its own, and returns a table, verdicts and a plot. A band is never widened so that it holds: a
/// figure that falls outside says FAILS, and the page says why.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/machine/machine_config.h"
#include "traces/command_stream.h"

namespace quadrille::studies::experiments {

/// What every experiment is given.
struct Setting {
  std::vector<std::pair<std::string, std::function<traces::CommandStream()>>>
      scenes;                           ///< name and how to load; empty: the experiment's own
  std::uint32_t width = 0, height = 0;  ///< of frames that an experiment makes itself, pixels
  int jobs = 1;                         ///< processes at a time
  std::function<void(const std::string&)> progress = [](const std::string&) {};
};

struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

/// A figure and the band that it must lie in.
struct Verdict {
  std::string what;
  double value = 0, least = 0, most = 0;
  [[nodiscard]] bool holds() const { return value >= least && value <= most; }
};

struct Result {
  Table table;
  std::vector<Table> further_tables;
  std::vector<Verdict> verdicts;
  std::string plot;                  ///< commands for gnuplot
  std::vector<std::string> remarks;  ///< what a reader would ask
  [[nodiscard]] bool holds() const;
};

struct Experiment {
  const char* name;  ///< on the command line, and of its page
  const char* title;
  const char* published;  ///< what was measured, by whom
  const char* how;        ///< how it runs here
  Result (*run)(const Setting& setting);
  std::vector<const char*> scenes = {};  ///< drawn unless others are given; none: it makes its own frames
  const char* size = "960x540";          ///< of the pictures
};

[[nodiscard]] std::span<const Experiment> experiments();

/// A frame to be drawn on a machine that differs from the default by settings `KEY=VALUE`.
struct Frame {
  const traces::CommandStream* stream = nullptr;
  std::vector<std::string> settings;
};
/// The default machine with settings `KEY=VALUE`. Throws `UserError` for one that is refused.
void apply_settings(pipeline::MachineConfig& machine, const std::vector<std::string>& settings);
/// Figures of a frame, by name: "frame.cycles", and "KIND.COUNTER" summed over the units of a kind
/// ("memory.bus_busy", "memory.cycles").
class Readings {
 public:
  explicit Readings(const std::string& report_json);
  /// Throws `std::out_of_range` for a name that the report does not have.
  [[nodiscard]] double operator[](const std::string& name) const;
  /// The part of the frame that doubling a resource is expected to save; 0 where the report expects nothing.
  [[nodiscard]] double gain(const std::string& resource) const;

 private:
  std::vector<std::pair<std::string, double>> values_;
};
/// Draws all frames, in order. Throws `UserError` as a refused run does.
[[nodiscard]] std::vector<Readings> draw(const std::vector<Frame>& frames, const Setting& setting);

/// The cycles of all frames on all machines: [machine][stream]. Machines by their settings; throws as
/// `draw` does.
[[nodiscard]] std::vector<std::vector<double>> frame_cycles(
    const std::vector<traces::CommandStream>& streams, const std::vector<std::vector<std::string>>& machines,
    const Setting& setting);

/// The result as text, and as a page of documentation that shows `picture`.
[[nodiscard]] std::string result_text(const Experiment& experiment, const Result& result);
[[nodiscard]] std::string result_markdown(const Experiment& experiment, const Result& result,
                                          const std::string& picture);

// The experiments, each in its file.
[[nodiscard]] Result limits(const Setting& setting);
[[nodiscard]] Result parameters(const Setting& setting);
[[nodiscard]] Result memory_scheduling(const Setting& setting);
[[nodiscard]] Result vertex_reuse(const Setting& setting);
[[nodiscard]] Result small_triangles(const Setting& setting);
[[nodiscard]] Result setup_rate(const Setting& setting);
[[nodiscard]] Result quad_overhead(const Setting& setting);
[[nodiscard]] Result hidden_surfaces(const Setting& setting);
[[nodiscard]] Result units(const Setting& setting);
[[nodiscard]] Result engines(const Setting& setting);
[[nodiscard]] Result samples(const Setting& setting);
[[nodiscard]] Result formats(const Setting& setting);
[[nodiscard]] Result color_writes(const Setting& setting);
[[nodiscard]] Result compression(const Setting& setting);
[[nodiscard]] Result traversal(const Setting& setting);
[[nodiscard]] Result raster(const Setting& setting);
[[nodiscard]] Result depth_precision(const Setting& setting);
[[nodiscard]] Result blend_drift(const Setting& setting);
[[nodiscard]] Result transparency(const Setting& setting);
[[nodiscard]] Result texture_cache(const Setting& setting);
[[nodiscard]] Result texture_latency(const Setting& setting);
[[nodiscard]] Result texture_filters(const Setting& setting);
[[nodiscard]] Result compressed_textures(const Setting& setting);

}  // namespace quadrille::studies::experiments
