/// Attachments of integers: a pass that writes them, by hashes, masks and logic operations, and one that
/// samples them all and shows a hash of what they hold.
#pragma once

#include "traces/command_stream.h"

#include <cstdint>
#include <vector>

namespace quadrille::pipeline::test {

/// Formats of colour attachments that hold integers.
[[nodiscard]] std::vector<traces::Format> integer_formats();

/// Of random triangles; the same seed gives the same stream. Formats are those of the first pass's
/// attachments, 1 to 8. It is validated.
[[nodiscard]] traces::CommandStream integers_stream(std::uint64_t seed,
                                                    const std::vector<traces::Format>& formats,
                                                    std::uint32_t samples = 1);

}  // namespace quadrille::pipeline::test
