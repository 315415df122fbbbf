/// A trace file taken apart and put together again, checksums and all, from docs/trace_format.md: what a
/// hostile writer of traces would have.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "tests/fuzz/targets.h"

namespace quadrille::fuzz {

struct TraceChunk {
  std::array<char, 4> tag{};
  std::uint32_t version = 0;
  Buffer payload;  ///< decoded
};

/// The chunks of a file; nothing when it cannot be taken apart.
[[nodiscard]] std::optional<std::vector<TraceChunk>> take_trace_apart(Bytes file);
/// A file of these chunks, with sizes and checksums that hold.
[[nodiscard]] Buffer put_trace_together(const std::vector<TraceChunk>& chunks);

}  // namespace quadrille::fuzz
