/// The whole machine for the contract harness: random stream, random machine, rendered in any driver and
/// order.
#pragma once

#include "pipeline/machine/machine.h"
#include "tests/hw/contract.h"
#include "traces/command_stream.h"

#include <string>

namespace quadrille::pipeline::test {

/// Checksum of colour and depth.
[[nodiscard]] std::uint64_t image_digest(const DeviceFrame& frame);
/// The same for the functional rendering of a stream, in such precisions.
[[nodiscard]] std::uint64_t functional_digest(const traces::CommandStream& stream,
                                              const models::Precision& precision = {});

/// What is said of a stream that is not valid, or that cannot be drawn functionally; empty if it can.
[[nodiscard]] std::string refusal(const traces::CommandStream& stream);

/// Builds the machine of `machine_seed` (0: the default one) for the stream; without `leave_out` with every
/// unit, needed or not.
[[nodiscard]] hw::contract::Builder machine_builder(const traces::CommandStream& stream,
                                                    std::uint64_t machine_seed, bool leave_out = true);

/// What is wrong with a run that should have left this digest and kept all laws; empty: nothing.
[[nodiscard]] std::string faults_of(const hw::contract::Outcome& outcome, std::uint64_t digest);
/// The same of the machine of `machine_seed`, which should draw what the functional rendering draws.
[[nodiscard]] std::string machine_faults(const traces::CommandStream& stream, std::uint64_t machine_seed,
                                         const hw::contract::Variation& variation = {});

}  // namespace quadrille::pipeline::test
