/// What a mesh of triangles asks of the machine, counted from its corners alone: a rasteriser of its own,
/// which tries every pixel, and none of the machine's code. Work over rate is the closed form that an
/// experiment holds the machine to.
#pragma once

#include <cstdint>
#include <span>

#include "studies/experiments/triangle_mesh.h"

namespace quadrille::studies::experiments {

/// Rates of the machine that a mesh is counted for, and limits of its batches of vertices.
struct Rates {
  std::uint32_t fine_quads = 4;  ///< quads a cycle of the fine rasteriser
  std::uint32_t tile_tests = 4;  ///< tile tests a cycle of the coarse rasteriser
  std::uint32_t pack_quads = 4;  ///< quads a cycle of a warp packer
  std::uint32_t launch_clk = 1;  ///< cycles of it a warp that it launches
  std::uint32_t batch_vertices = 32, batch_triangles = 32;
  /// of the triangle store; for each eighth of them a message goes through the rasterisers
  std::uint32_t triangle_slots = 1024;
  /// Of edge walking: rows and crossed tiles a cycle, and cycles a part of a triangle.
  std::uint32_t walk_rows = 1, walk_segments = 2, walk_setup_clk = 2;
};

struct TriangleWork {
  std::uint64_t triangles = 0, batches = 0, vertices = 0;
  std::uint64_t tile_tests = 0;  ///< of the coarse rasteriser, those that fail included
  std::uint64_t tiles = 0;       ///< that pass
  std::uint64_t coarse_clk = 0;  ///< cycles of the coarse rasteriser: a tile out a cycle, tests at their rate
  std::uint64_t fine_clk = 0;    ///< cycles of the fine rasteriser: quads at their rate, at least one a tile
  /// cycles to pack the quads of each tile and launch the warps, summed over partitions
  std::uint64_t pack_clk = 0;
  std::uint64_t quads = 0, fragments = 0;
  /// Of edge walking: parts of triangles, rows, those with a covered pixel, tiles that they cross, and tiles
  std::uint64_t walk_parts = 0, walk_rows = 0, walk_spans = 0, walk_segments = 0, walk_tiles = 0;
  /// cycles of the coarse rasteriser that walks: a row of tiles is walked while the one before leaves, a tile
  /// a cycle
  double walk_clk = 0;
};

/// A place in a pixel, in 1/256 of it.
struct Sample {
  std::int32_t x = kGrid / 2, y = kGrid / 2;
};
struct Coverage {
  std::uint64_t quads = 0;   ///< of a triangle, with a covered sample
  std::uint64_t pixels = 0;  ///< of a triangle, with a covered sample
  std::uint64_t blocks = 0;  ///< of 4x4 pixels, of a triangle, with a covered sample
};
/// Quads, pixels and blocks that the triangles of the mesh touch, each triangle by itself, with these samples
/// a pixel.
[[nodiscard]] Coverage coverage_of(const TriangleMesh& mesh, std::span<const Sample> samples);

/// Counts the mesh with every triangle drawn: none culled, hidden or off screen.
[[nodiscard]] TriangleWork work_of(const TriangleMesh& mesh, const Rates& rates);

}  // namespace quadrille::studies::experiments
