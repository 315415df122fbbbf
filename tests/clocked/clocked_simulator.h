/// The ruler of the kernel: a plain clocked simulator of the machines in tests/hw/base/world_spec.h, written
/// separately (it includes nothing of hw/).
///
/// It visits every edge of every clock in order of time and ticks every unit on every one of its edges. FIFOs
/// are delay lines that count the receiver's edges; there are no time stamps, no look-ahead and no events.
/// Slow, and simple enough to be believed.
///
/// A link of latency L: a token pushed on some edge of the producer is noticed by the consumer's clock on its
/// first edge at or after that moment and can be popped L consumer edges after it. A freed slot comes back
/// the same way after `credit` edges of the producer. A link between two clock domains pays two more edges
/// each way for its synchronisers. At most `width` pushes share an edge.
#pragma once

#include "tests/hw/base/world_spec.h"

#include <memory>

namespace quadrille::clocked {

using hw::world::Token;
using hw::world::Trace;
using hw::world::WorldSpec;

/// Femtosecond at which edge `k` of a clock of `hz` falls: the floor of k periods.
[[nodiscard]] std::int64_t edge_time(std::int64_t hz, std::int64_t k);

struct Result {
  Trace trace;                       ///< by unit
  std::vector<int> tokens_in_links;  ///< by wire, when the simulation stopped
};

/// Simulates all edges before `end` (femtoseconds).
[[nodiscard]] Result simulate(const WorldSpec& spec, std::int64_t end);

}  // namespace quadrille::clocked
