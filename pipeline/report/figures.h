/// The figures of one frame: what each unit did and where its time went, who moved how many bytes, and the
/// laws they must obey.
#pragma once

#include "pipeline/functional/fates.h"
#include "pipeline/machine/machine.h"
#include "pipeline/report/critical_path.h"
#include "pipeline/report/detail.h"
#include "pipeline/report/flow.h"
#include "pipeline/report/miss_kinds.h"
#include "pipeline/report/queries.h"
#include "pipeline/report/texture_use.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace quadrille::pipeline {

struct CounterFigure {
  std::string name, unit, definition;
  std::uint64_t value = 0;
};

/// How often a quantity had which size: bucket 0 counts zeros, bucket k > 0 sizes from 2^(k-1) to 2^k - 1.
/// Ends with the last bucket that is not empty.
struct HistogramFigure {
  std::string name, unit, definition;
  std::vector<std::uint64_t> buckets;
  std::uint64_t sum = 0;
};

/// Cycles that a unit waited for one of its ports.
struct WaitFigure {
  std::string port;
  bool input = true;
  std::int64_t cycles = 0;
  std::string link = {};  ///< path of the link at the port
};

/// A link and what went through it. A slot is taken for a round trip at least, so what a link carries bounds
/// the frame's time from below.
struct LinkFigures {
  /// "coarse_to_fine"; the key of its class in a machine file, "link.coarse_to_fine"
  std::string path, key;
  std::string producer, consumer;  ///< paths of units
  int depth = 0, width = 0;
  int latency = 0, credit_latency = 0;  ///< cycles of the receiving side, a clock crossing's cost included
  std::uint64_t tokens = 0;
  double use = 0;  ///< least time in which the link can carry its tokens, over the frame's time: 0..1
  std::uint64_t held_ticks = 0;  ///< tokens that it held, summed over ticks until nothing moved any more
};

/// "coarse_to_fine" of "link.coarse_to_fine".
[[nodiscard]] constexpr std::string_view class_of(std::string_view link_key) {
  return link_key.substr(link_key.find('.') + 1);
}

/// What a unit took of one of its resources (hw/base/resource.h): cycles of its clock, and what they had come
/// to at the end of each slice of the frame.
struct ResourceFigure {
  std::string name, serial;
  hw::Resource::Kind kind = hw::Resource::Kind::kRate;
  double cycles = 0;
  std::vector<double> at_end_of = {};
  bool memory = false;  ///< kPlaces: of what is under way to memory
};

struct UnitFigures {
  std::string path;
  std::int64_t cycles = 0, busy = 0, waiting = 0, starved = 0, blocked = 0,
               idle = 0;  ///< of the unit's clock; the last five add up to the first
  std::vector<ResourceFigure> resources;
  std::vector<WaitFigure> waits;  ///< longest first, ports that cost nothing left out
  std::vector<CounterFigure> counters;
  std::vector<HistogramFigure> histograms;
  std::vector<hw::Facet> row;  ///< what it shows of itself
};

struct ClientFigures {
  std::string name;
  std::uint64_t read_bytes = 0, write_bytes = 0;
};

/// A law: two counts of the same thing, taken from different events in different units.
struct Check {
  std::string law;
  std::string left_name, right_name;
  std::uint64_t left = 0, right = 0;
  [[nodiscard]] bool holds() const { return left == right; }
};

struct FrameFigures {
  /// of the GPU clock, from the first command to the last pixel read by scan-out
  std::int64_t cycles = 0;
  std::int64_t render_cycles = 0;  ///< until the last pass was flushed
  double clock_mhz = 0;
  std::uint64_t draws = 0, triangles = 0, vertices = 0;
  std::uint64_t fragments_covered = 0;  ///< before any depth test; what Hi-Z dropped is not among them
  std::uint64_t fragments_shaded = 0;   ///< live lanes
  std::uint64_t helper_lanes = 0, fragment_warps = 0, fragments_written = 0;
  Fates fates;
  /// Of `cycles`, those after the last pass was flushed: scan-out alone.
  [[nodiscard]] std::int64_t scan_out_cycles() const { return cycles - render_cycles; }
  /// Cycles from one frame to the next of an endless row of this frame where scan-out of each overlaps the
  /// drawing of the next.
  [[nodiscard]] std::int64_t period_cycles() const { return std::max(render_cycles, scan_out_cycles()); }
};

struct HostFigures {
  double load_s = 0, build_s = 0, simulate_s = 0, wall_s = 0;
  /// unpacking and tiling the textures that something sampled, which interrupts the simulation; in none of
  /// the others but `wall_s`
  double unpack_s = 0;
  /// processor time of the simulation: what `simulate_s` is on a machine with nothing else to do
  double simulate_cpu_s = 0;
  double fragments_per_s = 0, cycles_per_s = 0, peak_rss_mib = 0;
  std::uint64_t actions = 0;
};

struct Figures {
  std::string scene, fidelity = "exact";
  /// how far beyond the exact bound units were simulated ahead; above 0 the cycles are approximate
  std::int64_t window_cycles = 0;
  /// Kinds of units that ran faster than the machine has them, and how many times.
  std::vector<std::pair<std::string, double>> faster;
  FrameFigures frame;
  double slice_cycles = 0;       ///< of the GPU clock; 0: there are no slices
  bool report_timeline = false;  ///< the JSON has the slices of every resource
  std::vector<UnitFigures> units;
  std::vector<LinkFigures> links;
  /// of the GPU clock: from the first command until nothing moved any more, which write-backs do longest
  std::int64_t moving_cycles = 0;
  std::optional<FlowFigures> flow = {};   ///< only where the timeline was asked for
  std::optional<CriticalPath> path = {};  ///< only where it was asked for
  /// by texture unit, only where it was asked for
  std::optional<std::vector<MissKindFigures>> texture_misses = {};
  /// in the order in which draws name them first, only where it was asked for
  std::optional<std::vector<TextureFigures>> textures = {};
  std::vector<ClientFigures> bandwidth;
  std::vector<Check> checks;
  std::vector<LeftOut> left_out;
  /// Programs whose outputs follow values that atomic operations returned: timing may change what they draw.
  std::vector<std::string> order_dependent;
  std::optional<Detail> detail;            ///< only where it was asked for, or the frame has queries
  std::vector<QueryFigures> queries = {};  ///< in the order in which they begin
  HostFigures host;
  [[nodiscard]] bool checks_hold() const;
};

/// Bytes that the memory channels moved, read and written. 0 when not simulated.
[[nodiscard]] std::uint64_t memory_bytes(const Figures& figures);

/// Reads the figures of a machine that has run, with the detail that was kept. `host` is left to the caller.
[[nodiscard]] Figures collect_figures(const Machine& machine, const DeviceFrame& frame,
                                      std::optional<Detail> detail = {});

}  // namespace quadrille::pipeline
