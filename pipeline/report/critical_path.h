/// The chain of waits that a frame's end hangs on.
///
/// From the last cycle of the frame on it is followed back: a unit that was busy is on the path for as long
/// as it was; one that waited for a token hands on to the unit that sent it, at the time when it did, and one
/// that waited for room to the unit that made it. What lies between the two is the link's latency. A core has
/// many warps in hand, so there the path is that of a warp: from what it sent back to the answer that it had
/// waited for, or to its coming in, and to the warp before that left it the place; so it is of the requests
/// of texture units, load-store units and memory channels. Every tick of the frame is on the path once, and
/// the parts add up to the frame.
///
/// A part tells how long the frame waited for that, not what it would gain: what runs beside the path takes
/// its place as soon as it is shorter. It bounds the gain from above, as far as the order of things stays.
/// [P: Fields 2001]
#pragma once

#include "hw/base/charge_log.h"
#include "hw/base/leg_log.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::pipeline {

class Machine;

/// What a stretch of the path is.
enum class PathPart : std::uint8_t {
  kBusy,     ///< a unit's initiation slot was in use
  kWaiting,  ///< a unit waited for its own latency, or a timer
  kLink,     ///< a token, or the room that one left, was on its way
};
[[nodiscard]] std::string_view name_of(PathPart part);

/// All stretches of the same sort.
struct PathShare {
  std::string of;  ///< kind of unit ("core"), or key of a class of links ("link.coarse_to_fine")
  PathPart part = PathPart::kBusy;
  std::string by;  ///< kind of unit that spent it, or that waited for the link; latencies are in its cycles
  hw::Tick ticks = 0;
};

struct CriticalPath {
  hw::Tick ticks = 0;            ///< from the frame's end back to its start
  std::uint64_t stretches = 0;   ///< changes from one unit to another
  std::size_t log_bytes = 0;     ///< that were kept to follow it
  std::vector<PathShare> parts;  ///< longest first
  struct OfDraw {
    hw::DrawId draw = hw::kNoDraw;  ///< `kNoDraw`: what no draw's work is
    hw::Tick ticks = 0;
    std::vector<PathShare> parts;  ///< longest first
  };
  /// Those on the path, longest first. One alone, of no draw, where units do not say for whom they work.
  std::vector<OfDraw> draws;
  /// By draw, in API order, where asked for: what its own end waited for, back to its issue; longest first.
  /// The parts add up to its time in flight.
  std::vector<std::vector<PathShare>> of_each;
};

/// The parts as a table, in cycles of a clock; those that are next to nothing are left out.
[[nodiscard]] std::string path_table(const CriticalPath& path, double clock_mhz);
/// All of it as a JSON object, in cycles of a clock (docs/figures.md).
[[nodiscard]] nlohmann::ordered_json path_json(const CriticalPath& path, double clock_mhz);

/// The parts of a draw's own path by unit or link, without what is next to nothing: a JSON object.
[[nodiscard]] nlohmann::ordered_json draw_path_json(const std::vector<PathShare>& parts, double clock_mhz);

/// Keeps, while a machine runs, what its units' time goes to; afterwards, the path.
class CriticalPathLog {
 public:
  /// Before the run. The machine is not run any more once this is gone.
  explicit CriticalPathLog(const Machine& machine);
  ~CriticalPathLog();
  CriticalPathLog(const CriticalPathLog&) = delete;
  CriticalPathLog& operator=(const CriticalPathLog&) = delete;

  /// After the run. `each_draw`: the path of each draw too.
  [[nodiscard]] CriticalPath follow(bool each_draw);

 private:
  class Walk;
  const Machine& machine_;
  struct Logs {
    hw::ChargeLog charges;
    hw::LegLog legs = {};
  };
  std::vector<std::unique_ptr<Logs>> logs_;  ///< by unit of the machine
};

}  // namespace quadrille::pipeline
