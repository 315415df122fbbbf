/// What leaving out saves: every scene drawn with and without what it does not need, taking turns, each run a
/// process of its own from the file to the picture.
///
/// Three claims are checked on every pair of runs: the same picture and depths, the same cycles and counts in
/// every unit that both have, and no work at all in units that only the complete machine has. Host time and
/// memory are measured. docs/leave_out.md reads the result.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/driver/frame_builder.h"
#include "pipeline/machine/machine_config.h"
#include "studies/statistics.h"
#include "traces/command_stream.h"

namespace quadrille::studies {

inline constexpr std::string_view kLeaveOutSchema = "quadrille-leave-out-2";

struct LoadedScene {
  traces::CommandStream stream;
  std::vector<pipeline::LeftOut> left_out;  ///< by loading
};

struct LeaveOutScene {
  std::string name;                                 ///< as given by the user
  std::function<LoadedScene(bool leave_out)> load;  ///< reads it, in the child
};

/// One run: what it cost the host, and a witness of what it computed.
struct LeaveOutRun {
  /// processor time of its phases; `build` compiles, uploads and elaborates
  double load_s = 0, build_s = 0, simulate_s = 0;
  double total_s = 0;  ///< processor time of the child
  double peak_rss_mib = 0;
  std::int64_t cycles = 0;
  std::string image;    ///< hash of colours and depths
  std::string figures;  ///< the figures as JSON, without what differs from host to host
  std::vector<pipeline::LeftOut> left_out;
};

struct LeaveOutResult {
  std::string name;
  /// all units built and images read; only what the frame needs
  std::vector<LeaveOutRun> everything, needed;
  /// one line on how two runs disagree; empty when every claim holds
  std::string contradiction;
  /// Over the runs of each side, in seconds and MiB.
  Spread everything_s, needed_s, everything_simulate_s, needed_simulate_s, everything_mib, needed_mib;
  [[nodiscard]] double speed_up() const { return everything_s.median / needed_s.median; }
  /// Slower beyond doubt: what disturbs a run makes it longer, so the fastest runs are compared, with a
  /// twentieth for what is left.
  [[nodiscard]] bool slower() const { return needed_s.least > 1.05 * everything_s.least; }
};

/// How two runs of a frame disagree, in one line; empty when they do not. `complete` may have units and
/// clients that `reduced` lacks, if they did nothing.
[[nodiscard]] std::string disagreement(const LeaveOutRun& complete, const LeaveOutRun& reduced);

/// Runs both sides `repeat` times, taking turns. Throws `UserError` with what a run was refused for,
/// `std::runtime_error` when one failed.
[[nodiscard]] LeaveOutResult measure_leave_out(const LeaveOutScene& scene,
                                               const pipeline::MachineConfig& machine, int repeat,
                                               const std::function<void(const std::string&)>& progress = {});

/// The table, a row a scene and below it what was left out.
[[nodiscard]] std::string leave_out_table(const std::vector<LeaveOutResult>& results,
                                          const pipeline::MachineConfig& machine);
/// Everything, schema `kLeaveOutSchema`.
[[nodiscard]] std::string leave_out_json(const std::vector<LeaveOutResult>& results,
                                         const pipeline::MachineConfig& machine);

}  // namespace quadrille::studies
