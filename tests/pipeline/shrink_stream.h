/// Makes a stream that shows a fault as small as it can be while it shows it.
#pragma once

#include "traces/command_stream.h"

#include <functional>

namespace quadrille::pipeline::test {

/// Drops passes, then draws, in halves and one by one, then instances and primitives, and sets states of
/// pipelines to what they are by default, as long as `fails` says that the fault is still there. `fails` is
/// asked of valid streams alone; what it throws as `UserError` counts as another fault.
[[nodiscard]] traces::CommandStream shrink(traces::CommandStream stream,
                                           const std::function<bool(const traces::CommandStream&)>& fails);

/// The states of the pipelines that draws use, those that are not the default's.
[[nodiscard]] std::string states_of(const traces::CommandStream& stream);

/// How many draws a stream has.
[[nodiscard]] std::size_t draws_of(const traces::CommandStream& stream);

}  // namespace quadrille::pipeline::test
