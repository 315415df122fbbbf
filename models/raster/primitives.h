/// From the shaded vertices of a primitive to what is set up: the pieces that clipping leaves of a triangle,
/// a line or a point, or of a triangle whose edges or corners are drawn instead (polygon mode).
///
/// Rules without time, which the clipper and the set-up unit share with the functional run.
#pragma once

#include "models/base/pipeline_state.h"
#include "models/raster/clip.h"
#include "models/raster/line_setup.h"
#include "models/raster/point_setup.h"
#include "models/raster/triangle_setup.h"

#include <array>
#include <bit>
#include <cstdint>
#include <span>

namespace quadrille::models {

/// What is set up and rasterised.
enum class PieceKind : std::uint8_t { kTriangle, kLine, kPoint };
/// What the primitives of a topology are.
[[nodiscard]] constexpr PieceKind assembled_kind(Topology topology) {
  switch (topology) {
    case Topology::kPointList: return PieceKind::kPoint;
    case Topology::kLineList:
    case Topology::kLineStrip: return PieceKind::kLine;
    case Topology::kTriangleList:
    case Topology::kTriangleStrip:
    case Topology::kTriangleFan: break;
  }
  return PieceKind::kTriangle;
}

/// State of a draw for the way from vertices to pieces.
struct PrimitiveState {
  PieceKind assembled = PieceKind::kTriangle;  ///< by the topology
  PolygonMode polygon_mode = PolygonMode::kFill;
  int clip_distances = 0, cull_distances = 0;  ///< that the vertex program writes
  bool point_size = false;                     ///< it writes that too; else a point is 1 pixel
  bool viewport_index = false;                 ///< and that; else all take the first viewport
  /// What the draw rasterises.
  [[nodiscard]] PieceKind pieces() const {
    if (assembled != PieceKind::kTriangle || polygon_mode == PolygonMode::kFill) return assembled;
    return polygon_mode == PolygonMode::kLine ? PieceKind::kLine : PieceKind::kPoint;
  }
  [[nodiscard]] std::size_t corners() const {
    return assembled == PieceKind::kTriangle ? 3 : assembled == PieceKind::kLine ? 2 : 1;
  }
};

/// The shaded vertices of a primitive; of a line or a point, the first ones.
struct PrimitiveVertices {
  std::array<glm::vec4, 3> position;
  std::array<float, 3> point_size{1, 1, 1};
  UserDistances user{0, 0};
  /// that the provoking vertex asks for, which is the first
  std::uint32_t viewport = 0;
};

/// What is set up: three vertices of a triangle, two of a line or one of a point.
struct ClippedPiece {
  std::array<WindowVertex, 3> vertices;
  std::array<glm::vec2, 3> weights;  ///< of the primitive's second and third vertex
  float point_size = 1;
  bool front = true;  ///< of a line or point of a triangle
  std::uint8_t viewport = 0;
};

/// All pieces of one primitive.
struct ClippedPrimitive {
  ClipOutcome outcome = ClipOutcome::kRejected;
  int count = 0;
  int cuts = 0;  ///< polygons or lines that were cut
  std::array<ClippedPiece, kMaxClipVertices - 2> pieces;
};

/// Reads the vertices of a primitive; `output(corner, slot)` is what its program wrote there as a float, and
/// `first_extra` the slot behind its varyings.
template <class Output>
void read_vertices(const PrimitiveState& state, int first_extra, const Output& output,
                   PrimitiveVertices& vertices) {
  const std::size_t corners = state.corners();
  for (std::size_t i = 0; i < corners; ++i) {
    for (int c = 0; c < 4; ++c) vertices.position[i][c] = output(i, c);
    if (state.point_size) vertices.point_size[i] = output(i, first_extra);
  }
  const int distances = state.clip_distances + state.cull_distances;
  const int first = first_extra + (state.point_size ? 1 : 0);
  if (state.viewport_index) vertices.viewport = std::bit_cast<std::uint32_t>(output(0, first + distances));
  if (distances == 0) return;
  vertices.user = UserDistances(state.clip_distances, state.cull_distances);
  for (std::size_t i = 0; i < corners; ++i) {
    for (int d = 0; d < distances; ++d)
      vertices.user.set(i, static_cast<std::size_t>(d), output(i, first + d));
  }
}

/// What a viewport and its scissor mean for the clipper and for set-up.
struct ViewState {
  Viewport viewport;
  ClipState clip;
  SetupState setup;
};

/// Clips a primitive and moves what is left to the window. `views` are the draw's, one at least, of which
/// `vertices.viewport` names one; a number beyond them names the first. Set-up's state is for the facing of
/// triangles that are not filled.
void clip_primitive(const PrimitiveVertices& vertices, const PrimitiveState& state,
                    std::span<const ViewState> views, ClippedPrimitive& out);

/// Sets up one piece of a draw.
[[nodiscard]] SetupOutcome setup_piece(const ClippedPiece& piece, const PrimitiveState& state,
                                       const SetupState& setup, TriangleSetup& out);

/// How much of its pixels a smooth line covers.
[[nodiscard]] LineCoverage piece_coverage(const ClippedPiece& piece, const SetupState& setup);

/// How far a piece's pixels may lie beyond the box around its vertices, in units of the sub-pixel grid.
[[nodiscard]] std::int32_t piece_reach(const ClippedPiece& piece, PieceKind kind, const SetupState& setup);

}  // namespace quadrille::models
