/// What limits a frame: the one unit, link or loop of waiting that its time goes to, read from the figures alone.
///
/// Every unit and link has a *use*: the part of the frame's time for which it cannot have been doing anything else (busy cycles; for a link, the least time in
/// which its tokens can pass). A use is a lower bound on the frame's time, so a resource that is used nearly all the time holds the frame up. When none is, the
/// frame waits: starting at the command processor, which waits for the frame's end, each unit's longest wait leads to the unit that it waited for, until a unit
/// is mostly busy (its work, done by nobody else meanwhile) or the walk comes back to where it was: then the time goes to the latencies around that loop. Where
/// the command processor waited longer for scan-out, which comes after all passes, than for the passes, the frame is scan-out's.
#pragma once

#include "pipeline/figures.h"

#include <string>
#include <vector>

namespace quadrille::pipeline {

/// How much of the frame's time a resource needs at least.
struct ResourceUse {
  std::string name;    ///< a kind of unit ("core") or the key of a class of links ("link.coarse_to_fine")
  double use = 0;      ///< of the busiest of its kind, 0..1
  std::string detail;  ///< what sets its rate
};

struct Limiter {
  enum class Kind : std::uint8_t {
    kNothing,  ///< the frame was not simulated
    kUnit,     ///< a unit is busy most of the time
    kLink,     ///< a link carries as much as its depth, width and latencies allow
    kWork,     ///< no resource is used up; the frame waits for one unit's work at a time
    kLatency   ///< no resource is used up; the frame waits around a loop of latencies
  };
  Kind kind = Kind::kNothing;
  std::string name;  ///< the kind of unit, or the key of the link: for `kLatency` that with the longest latency of the loop
  double share =
      0;  ///< its use; for `kWork` and `kLatency` the share of its cycles that the last unit of the walk was busy or waited so; scan-out's of the frame
  std::vector<std::string> walk;  ///< kinds of units, from the command processor on: each waited most for the next
  std::size_t loop = 0;           ///< `walk[loop]` is where a loop begins and, behind the last, comes back to; walk.size() if there is none
  std::string text;               ///< one line for a person
};

/// From this use on a resource holds the frame up. [G: below it, more than a third of the time is somebody else's]
inline constexpr double kUsedUp = 0.65;

/// All uses, greatest first.
[[nodiscard]] std::vector<ResourceUse> resource_uses(const Figures& figures);
/// What limits the frame.
[[nodiscard]] Limiter find_limiter(const Figures& figures);
/// The kind for JSON: "nothing", "unit", "link", "work", "latency".
[[nodiscard]] const char* limiter_kind_name(Limiter::Kind kind);

}  // namespace quadrille::pipeline
