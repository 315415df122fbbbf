/// Command streams to test with: the smallest that draws, and random ones that use every field.
#pragma once

#include <cstdint>

#include "traces/command_stream.h"

namespace quadrille::traces {

/// One valid pass with one indexed and one plain draw; every object table has an element.
[[nodiscard]] CommandStream small_stream();
/// A valid stream whose tables, fields and commands depend on the seed.
[[nodiscard]] CommandStream random_stream(std::uint32_t seed);

}  // namespace quadrille::traces
