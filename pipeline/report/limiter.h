/// What limits a frame: the resources whose doubling would shorten it most (sensitivity.h), or else the loop
/// of waiting that its time goes to.
///
/// Where no doubling is expected to gain much, the frame waits: starting at the command processor, which
/// waits for the frame's end, each unit's longest wait leads to the unit that it waited for, until a unit is
/// mostly busy (its work, done by nobody else meanwhile) or the walk comes back to where it was: then the
/// time goes to the latencies around that loop. Where the command processor waited longer for scan-out, which
/// comes after all passes, than for the passes, the frame is scan-out's.
#pragma once

#include "pipeline/report/sensitivity.h"

#include <string>
#include <vector>

namespace quadrille::pipeline {

struct Limiter {
  enum class Kind : std::uint8_t {
    kNothing,  ///< the frame was not simulated
    kUnit,     ///< more of what a unit does a cycle would help most
    kPlaces,   ///< more places for what a unit has under way
    kLink,     ///< a wider and deeper link
    kWork,     ///< no resource is used up; the frame waits for one unit's work at a time
    kLatency   ///< no resource is used up; the frame waits around a loop of latencies
  };
  Kind kind = Kind::kNothing;
  /// the kind of unit, or the key of the link: for `kLatency` that with the longest latency of the loop
  std::string name;
  std::string resource;  ///< "core.issue": for `kUnit`, `kPlaces` and `kLink`
  /// The part of the frame that its doubling is expected to save; for `kWork` and `kLatency` the share of its
  /// cycles that the last unit of the walk was busy or waited so; scan-out's of the frame.
  double share = 0;
  /// kinds of units, from the command processor on: each waited most for the next
  std::vector<std::string> walk;
  /// `walk[loop]` is where a loop begins and, behind the last, comes back to; walk.size() if there is none
  std::size_t loop = 0;
  std::string text;  ///< one line for a person
};

/// A doubling that is expected to gain less than this part of the frame does not limit it.
inline constexpr double kLeastGain = 0.05;
/// Resources that a report names, and the least part of the frame for which it names one.
inline constexpr std::size_t kNamedGains = 3;
inline constexpr double kLeastNamedGain = 0.005;

/// What limits the frame.
[[nodiscard]] Limiter find_limiter(const Figures& figures);
/// The kind for JSON: "nothing", "unit", "places", "link", "work", "latency".
[[nodiscard]] const char* limiter_kind_name(Limiter::Kind kind);

}  // namespace quadrille::pipeline
