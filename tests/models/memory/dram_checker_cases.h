/// Traces of commands on a toy channel that keep a rule by a hair, and break it by one cycle or one step.
#pragma once

#include "tests/models/memory/dram_checker.h"

#include <functional>
#include <string>
#include <vector>

namespace quadrille::models::dram_cases {

using Kind = DramCommandKind;
using Trace = std::vector<DramCommand>;

/// A place in the toy channel below.
struct Place {
  std::uint8_t channel = 0, rank = 0;
  std::uint16_t group = 0, bank = 0;
};
inline constexpr Place kHere{};
inline constexpr Place kBeside{.bank = 1};  // another bank of the group
inline constexpr Place kGroup{.group = 1};  // another group of the rank
inline constexpr Place kGroupBeside{.group = 1, .bank = 1};
inline constexpr Place kRank{.rank = 1};
inline constexpr Place kChannel{.channel = 1};

[[nodiscard]] inline DramCommand at(std::int64_t cycle, Kind kind, Place place = kHere, std::int32_t row = 0,
                                    std::int32_t column = 0) {
  return {cycle, kind, place.channel, place.rank, place.group, place.bank, row, column};
}

/// A channel in which nearly nothing has to wait, so that a rule shows alone when its number is raised: two
/// pseudo-channels, ranks, groups and banks a group; rows of eight bursts; data 4 cycles after the command
/// for 1 cycle.
[[nodiscard]] DramNumbers toy();

/// A trace whose last command is legal at its cycle and breaks `rule`, and no other, one cycle earlier.
struct ExactCase {
  std::string rule;
  std::function<void(DramNumbers&)> set;
  Trace trace;
};

/// For every rule of time.
[[nodiscard]] std::vector<ExactCase> exact_cases();

/// A trace that breaks `rule` and no other, and one beside it that is legal.
struct StateCase {
  std::string rule;
  Trace illegal, legal;
};

[[nodiscard]] const std::vector<StateCase>& state_cases();

}  // namespace quadrille::models::dram_cases
