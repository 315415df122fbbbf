/// Where a frame's time would go if it went elsewhere: the frame drawn again with each kind of unit a tenth
/// faster, and so much faster that its time hardly counts.
///
/// What is measured holds whatever limits the frame. Each run is a process of its own; all of them must draw
/// the same picture. The resources that the one run's report names are doubled too, and what it expected is
/// set beside what that gains. docs/why.md says what "faster" means.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "pipeline/machine/machine_config.h"
#include "traces/command_stream.h"

namespace quadrille::studies {

inline constexpr std::string_view kWhySchema = "quadrille-why-1";

/// How many times as fast; the last stands for infinitely fast.
inline constexpr std::array<double, 2> kSpeedUps{1.1, 100};

/// A kind of units, all of them faster at once.
struct FasterUnits {
  std::string kind;
  double use = 0, busy = 0;  ///< in the machine as it is: of the most used one, and the mean; 0..1
  double path = 0;           ///< cycles of the critical path, with those of links that they waited for
  /// by speed-up: cycles of the GPU clock that the frame is shorter; negative where it is longer
  std::array<std::int64_t, kSpeedUps.size()> gain{};
};

/// A resource that the report names as the limit, doubled.
struct DoubledResource {
  std::string resource, words;
  double expected = 0;  ///< by the report of the one run, cycles
  std::int64_t gain = 0;
};

struct WhyResult {
  std::string scene;
  std::int64_t cycles = 0;
  std::string limit;                     ///< what the report of the one run says, a line
  std::string path, path_table;          ///< the critical path of the one run: its parts as JSON; as a table
  std::vector<FasterUnits> units;        ///< greatest gain of infinitely fast units first
  std::vector<DoubledResource> doubled;  ///< as the report names them
};

struct WhySetting {
  std::vector<std::string> kinds;  ///< those to make faster; empty: all that the machine builds
  int jobs = 1;                    ///< processes at a time
  std::function<void(const std::string&)> progress = [](const std::string&) {};
};

/// `machine` is changed in the runs' own processes alone. Throws `UserError` with what a run was refused for,
/// or for a kind of which the frame needs none;
/// `std::runtime_error` when one failed, or drew another picture than the machine as it is.
[[nodiscard]] WhyResult measure_why(const traces::CommandStream& stream, pipeline::MachineConfig& machine,
                                    const WhySetting& setting);

[[nodiscard]] std::string why_table(const WhyResult& result, const pipeline::MachineConfig& machine);
/// Everything, schema `kWhySchema`.
[[nodiscard]] std::string why_json(const WhyResult& result, const pipeline::MachineConfig& machine);

}  // namespace quadrille::studies
