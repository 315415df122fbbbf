/// Random legal machines, from comfortable to absurd: depths of one, latencies up to 10^5 cycles, one-line
/// caches, one to eight of each unit.
#pragma once

#include "pipeline/machine/machine_config.h"

#include <cstdint>

namespace quadrille::pipeline::test {

/// Sets every structural parameter of `config` at random; the same seed gives the same machine.
void randomize(MachineConfig& config, std::uint64_t seed);

}  // namespace quadrille::pipeline::test
