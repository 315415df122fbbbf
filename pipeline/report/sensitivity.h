/// What a frame would gain if a resource were doubled, estimated from the figures of the one run.
///
/// Every unit says how much of each of its resources the frame took, slice by slice (hw/base/resource.h). In
/// a slice, a rate that was used for a part `u` of the time is a bound of `u` on the slice's length. What the
/// bounds together leave of the slice is waiting. Bounds that are nearly as long as the greatest one add to
/// it, since work does not overlap perfectly: the time of a slice is the p-norm of its bounds and its
/// waiting, with one p for all frames. Doubling a rate halves its bound. Doubling a number of places halves
/// the waiting of the slices in which all places were taken, and those of nobody further downstream: who
/// waits for a full place downstream is full himself. What is not waiting for memory is in part waiting for
/// warps, which faster cores shorten. docs/limit.md has the table of what doubling sets, and
/// how often the estimate is right.
#pragma once

#include "pipeline/report/figures.h"

#include <string>
#include <vector>

namespace quadrille::pipeline {

/// A parameter that a doubling changes.
struct DoublingStep {
  const char* parameter;
  double factor;  ///< 2, or 0.5 where less is more
};
/// What doubles one resource and nothing else.
struct Doubling {
  const char* resource;  ///< "core.issue"
  const char* words;     ///< for a person: "plain and special lanes of the SIMDs"
  std::vector<DoublingStep> steps;
};
[[nodiscard]] const std::vector<Doubling>& doublings();
/// The doubling of a resource; nullptr when no parameter sets it.
[[nodiscard]] const Doubling* doubling_of(std::string_view resource);
/// The settings that it means on a machine, within the legal values: "core.simd_lanes=16". Empty when they
/// change nothing.
[[nodiscard]] std::vector<std::string> settings_of(const Doubling& doubling, const MachineConfig& machine);

/// How much of the frame's time a resource needs at least.
struct ResourceUse {
  std::string name;  ///< "core.issue"; the key of a class of links
  /// of the busiest of its kind: least time of its work over the frame's, 0..1; of places the part of the
  /// time they were all taken
  double use = 0;
  bool places = false;
};
struct Gain {
  std::string resource;
  double cycles = 0;  ///< that the frame would be shorter
  double share = 0;   ///< of the frame
};
struct Sensitivity {
  std::vector<Gain> gains;        ///< greatest first
  std::vector<ResourceUse> uses;  ///< greatest first, rates and links before places
  double waiting = 0;             ///< the part of the frame's time that no rate and no full place explains
};
[[nodiscard]] Sensitivity sensitivity(const Figures& figures);

/// The least time of the frame's counted work, in cycles of the GPU clock: that of its most used rate.
struct SpeedOfLight {
  double cycles = 0;
  std::string resource;
};
[[nodiscard]] SpeedOfLight speed_of_light(const Figures& figures);
/// A unit's use: of its most used rate.
[[nodiscard]] double use_of(const UnitFigures& unit);

}  // namespace quadrille::pipeline
