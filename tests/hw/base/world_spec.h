/// Small synthetic machines as plain data: what the kernel's units (worlds.h) and the clocked reference
/// simulator (tests/clocked) are both built from.
///
/// Nothing here knows of time or of the kernel; behaviour is written in words at `Role` and programmed twice.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace quadrille::hw::world {

struct Token {
  std::uint32_t id = 0;
  std::uint32_t hops = 0;
};

/// What a unit does. An action takes place on an edge of the unit's clock; at most `rate` actions share an
/// edge, and the one that fills the edge keeps the unit for `cost(key)` cycles. In0, Out0, ... are ports by
/// index.
enum class Role : std::uint8_t {
  kSource,    ///< pushes `count` tokens to Out0; cost by token number
  kStage,     ///< In0 -> Out0, one action a token
  kSerial,    ///< pops In0, which keeps it for `service(id)` cycles; then pushes to Out0
  kFork,      ///< In0 -> every output at once
  kRoute,     ///< In0 -> the output that the token's id names
  kRecycle,   ///< In0 -> Out1 (once more round) or Out0 (done), by id and hops
  kJoin,      ///< one token of every input -> Out0
  kExpand,    ///< pops In0, then pushes 1..`count` tokens to Out0, one an action
  kPack,      ///< pops `count` tokens one an action, then pushes one
  kArbiter,   ///< chooser: round robin over ready inputs -> Out0
  kPriority,  ///< chooser: the lowest ready input -> Out0
  kSpread,    ///< chooser: In0 -> round robin over outputs with room
  /// chooser: In0 -> a free context -> `count` requests on Out1, replies on In1 -> Out0; prefers reply, emit,
  /// request, accept
  kCore,
  /// chooser: InI -> a free slot -> after `service(id)` cycles OutI; first done first among those with room;
  /// prefers to reply; accepts round robin
  kMemory,
  kSink,  ///< pops In0; cost by token number
};

struct UnitSpec {
  std::string name{};
  Role role = Role::kStage;
  int clock = 0;                ///< index in WorldSpec::clocks_hz
  int rate = 1;                 ///< actions an edge
  int period = 1, jitter = 1;   ///< cost in cycles: period + hash % jitter
  int service = 1, spread = 1;  ///< service in cycles: service + hash % spread
  int count = 1;                ///< see Role
  int slots = 1;                ///< contexts of a core, slots of a memory
  std::uint32_t seed = 0;
  bool declared_fixed = false;  ///< lie about the kind: a chooser that says it is fixed-order
  int inputs = 0, outputs = 0;  ///< number of ports
};

struct LinkEnd {
  int unit = 0, port = 0;
};

struct WireSpec {
  LinkEnd from{}, to{};
  int depth = 4, width = 1, latency = 1, credit = 1;
  bool reply = false;
};

struct WorldSpec {
  std::vector<std::int64_t> clocks_hz{1'000'000'000};
  std::vector<UnitSpec> units;
  std::vector<WireSpec> wires;

  int add(UnitSpec unit);
  void wire(LinkEnd from, LinkEnd to, WireSpec spec = {});
};

[[nodiscard]] constexpr std::uint32_t mix(std::uint32_t a, std::uint32_t b) {
  std::uint32_t h = a * 0x9E3779B1u ^ (b + 0x7F4A7C15u) * 0x85EBCA77u;
  h ^= h >> 15;
  h *= 0xC2B2AE3Du;
  return h ^ (h >> 13);
}
/// Cycles that the action with this key (token number or id) keeps the unit.
[[nodiscard]] constexpr int cost(const UnitSpec& u, std::uint32_t key) {
  return u.jitter == 1 ? u.period
                       : u.period + static_cast<int>(mix(u.seed, key) % static_cast<std::uint32_t>(u.jitter));
}
[[nodiscard]] constexpr int service(const UnitSpec& u, std::uint32_t id) {
  return u.spread == 1
             ? u.service
             : u.service + static_cast<int>(mix(u.seed + 1, id) % static_cast<std::uint32_t>(u.spread));
}
[[nodiscard]] bool is_chooser(Role role);
[[nodiscard]] const char* role_name(Role role);

/// One action of a unit, as both simulators record it.
struct Event {
  std::int64_t at = 0;  ///< femtoseconds
  char what = ' ';      ///< '>' push, '<' pop, 'x' pop and push, 'a' accept, 'r' request, 'y' reply, 'e' emit
  std::uint8_t port = 0;
  std::uint32_t id = 0;
  friend bool operator==(const Event&, const Event&) = default;
};
using Trace = std::vector<std::vector<Event>>;  ///< by unit of the spec

/// A random machine: sources, then random operators on open streams (with arbiters, feedback loops, shared
/// memories), then sinks. Some of them deadlock.
[[nodiscard]] WorldSpec random_world(std::uint64_t seed);
/// 50 units with arbiters and feedback on one clock, for the benchmark: 8 lanes of stages and cores, one
/// shared memory, merged and recycled. `tokens` a source; every link is shaped like `link`.
[[nodiscard]] WorldSpec benchmark_world(int tokens, WireSpec link = {.depth = 8, .latency = 2, .credit = 1});

}  // namespace quadrille::hw::world
