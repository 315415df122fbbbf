/// Streams whose programs read and write storage buffers, and what their buffers hold afterwards.
#pragma once

#include "traces/command_stream.h"

#include <cstdint>
#include <string>

namespace quadrille::pipeline::test {

/// What a stream of `storage_stream` is made of.
struct StorageShape {
  std::uint32_t width = 88, height = 56;
  std::string fragment_declarations, fragment_body;  ///< reads `vec4 v_color`, writes `vec4 o`
  std::string vertex_declarations, vertex_body;      ///< reads `uint vertex`
  std::string second_body;  ///< of a second pass over the whole picture; none if empty
  bool depth_test = true, depth_write = true;
  int triangles = 24;
  std::uint32_t words = 8192;  ///< of the buffer at set 0, binding 0
};
/// Random triangles, in one pass; the same seed gives the same stream. It is validated. Buffer 0 is that of
/// set 0, binding 0, and zero.
[[nodiscard]] traces::CommandStream storage_stream(std::uint64_t seed, const StorageShape& shape);

/// Adds a draw to the last pass of a stream that draws: its last one again, with a fragment program that
/// reads, writes and counts in a storage buffer of its own.
void add_storage_draw(traces::CommandStream& stream);

/// A pass that keeps for each pixel which triangle was drawn there last, counts fragments by triangle, and
/// gathers bounds of what was covered; and a pass that draws these.
[[nodiscard]] StorageShape kept_by_pixel();

}  // namespace quadrille::pipeline::test
