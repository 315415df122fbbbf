/// The trace file (`.qtrace`): one `CommandStream` on disk, with version and checksums.
///
/// A header (magic, version, number of chunks) is followed by chunks, one for each object table and one for
/// the commands. A chunk names itself and its version, says its stored and its decoded size, carries an XXH3
/// checksum of what is stored and holds a zstd-compressed payload. docs/trace_format.md has every field. A
/// file is written whole or not at all; a file that is damaged anywhere is refused with the chunk and the
/// reason.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "traces/command_stream.h"

namespace quadrille::traces {

/// Of the container and its list of chunks. Version 1 is read too: it had a table of render targets.
inline constexpr std::uint32_t kTraceVersion = 2;
/// The most that one decoded trace may take; declared sizes above it are refused before anything is
/// allocated.
inline constexpr std::uint64_t kMaxTraceBytes = std::uint64_t{2} << 30;

/// The bytes of a trace file that holds `stream`. Same stream, same bytes.
[[nodiscard]] std::vector<std::byte> encode_trace(const CommandStream& stream);
/// Reads what `encode_trace` wrote and validates it. `name` is used in errors. Throws `UserError` with name,
/// chunk and reason on any defect.
[[nodiscard]] CommandStream decode_trace(std::span<const std::byte> bytes, const std::string& name);

/// Writes `stream` to `path` by way of a temporary file beside it. Throws `UserError` when the file cannot be
/// written.
void write_trace(const CommandStream& stream, const std::string& path);
/// Reads and validates the trace at `path`. Throws `UserError` with file, chunk and reason.
[[nodiscard]] CommandStream read_trace(const std::string& path);

/// A summary for a person: objects and their bytes, passes, draws, primitives.
[[nodiscard]] std::string trace_info(const CommandStream& stream);

/// What a stream asks for, counted from its commands.
struct StreamTotals {
  std::uint64_t buffer_bytes = 0, image_bytes = 0;
  std::uint64_t passes = 0, draws = 0, queries = 0;
  /// of all draws and instances, degenerate ones included; without regard to indices that end a strip
  std::uint64_t triangles = 0, lines = 0, points = 0;
  std::uint64_t vertices = 0;  ///< vertex references, before any reuse
};
[[nodiscard]] StreamTotals stream_totals(const CommandStream& stream);

}  // namespace quadrille::traces
