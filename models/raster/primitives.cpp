#include "models/raster/primitives.h"

#include "models/base/error.h"

namespace quadrille::models {
namespace {

/// One primitive on its way to its pieces.
class Work {
 public:
  Work(const PrimitiveVertices& vertices, const PrimitiveState& state, const ViewState& view,
       ClippedPrimitive& out)
      : vertices_(vertices),
        state_(state),
        clip_(view.clip),
        setup_(view.setup),
        viewport_(view.viewport),
        out_(out) {}

  void run() {
    out_.count = out_.cuts = 0;
    if (user() != nullptr && user()->cull(state_.corners())) {
      out_.outcome = ClipOutcome::kRejected;
      return;
    }
    switch (state_.assembled) {
      case PieceKind::kTriangle: return triangle();
      case PieceKind::kLine: out_.outcome = line(0, 1); return;
      case PieceKind::kPoint: out_.outcome = point(0); return;
    }
  }

 private:
  [[nodiscard]] const UserDistances* user() const {
    return state_.clip_distances + state_.cull_distances > 0 ? &vertices_.user : nullptr;
  }

  /// A vertex of the primitive with its weights.
  [[nodiscard]] ClipVertex corner(std::size_t i) const {
    return {vertices_.position[i], i == 1 ? 1.0F : 0.0F, i == 2 ? 1.0F : 0.0F};
  }

  void place(const ClipVertex& v, std::size_t i, ClippedPiece& piece) const {
    const bool valid = to_window(v.position, viewport_, setup_.subpixel_bits, piece.vertices[i]);
    QUADRILLE_CHECK(valid, "a clipped vertex has no window position");
    piece.weights[i] = {v.b1, v.b2};
  }

  void triangle() {
    ClippedPolygon polygon;
    out_.outcome = clip_triangle(vertices_.position, clip_, polygon, user());
    if (out_.outcome != ClipOutcome::kInside && out_.outcome != ClipOutcome::kClipped) return;
    out_.cuts = out_.outcome == ClipOutcome::kClipped ? 1 : 0;
    for (int i = 1; i + 1 < polygon.count; ++i) {
      ClippedPiece& piece = out_.pieces[static_cast<std::size_t>(out_.count++)];
      place(polygon.vertices[0], 0, piece);
      place(polygon.vertices[static_cast<std::size_t>(i)], 1, piece);
      place(polygon.vertices[static_cast<std::size_t>(i + 1)], 2, piece);
    }
    if (state_.polygon_mode != PolygonMode::kFill) unfilled();
  }

  /// Puts the triangle's edges or corners in the place of its pieces. Edges that clipping has made are not
  /// drawn.
  void unfilled() {
    std::int64_t area = 0;
    for (int i = 0; i < out_.count; ++i)
      area += doubled_area(out_.pieces[static_cast<std::size_t>(i)].vertices);
    front_ = is_front(area, setup_);
    out_.count = out_.cuts = 0;
    if (area == 0 || culls(front_, setup_)) {
      out_.outcome = ClipOutcome::kCulled;
      return;
    }
    if (state_.polygon_mode == PolygonMode::kLine) {
      for (const auto& [from, to] : {std::pair{2u, 0u}, std::pair{0u, 1u}, std::pair{1u, 2u}})
        (void)line(from, to);
    } else {
      for (const std::size_t i : {0u, 1u, 2u}) (void)point(i);
    }
    if (out_.count == 0) out_.outcome = ClipOutcome::kRejected;
    else out_.outcome = out_.cuts > 0 ? ClipOutcome::kClipped : ClipOutcome::kInside;
  }

  ClipOutcome line(std::size_t from, std::size_t to) {
    ClippedLine line;
    const ClipOutcome outcome = clip_line({corner(from), corner(to)}, clip_, line, user());
    if (outcome != ClipOutcome::kInside && outcome != ClipOutcome::kClipped) return outcome;
    out_.cuts += outcome == ClipOutcome::kClipped ? 1 : 0;
    ClippedPiece& piece = out_.pieces[static_cast<std::size_t>(out_.count++)];
    place(line.ends[0], 0, piece);
    place(line.ends[1], 1, piece);
    piece.vertices[2] = piece.vertices[1];
    piece.weights[2] = piece.weights[1];
    piece.front = front_;
    return outcome;
  }

  ClipOutcome point(std::size_t i) {
    const ClipOutcome outcome = clip_point(corner(i), clip_, user());
    if (outcome != ClipOutcome::kInside) return outcome;
    ClippedPiece& piece = out_.pieces[static_cast<std::size_t>(out_.count++)];
    place(corner(i), 0, piece);
    piece.vertices[1] = piece.vertices[2] = piece.vertices[0];
    piece.weights[1] = piece.weights[2] = piece.weights[0];
    piece.point_size = state_.point_size ? point_size(vertices_.point_size[i]) : 1.0F;
    piece.front = front_;
    return outcome;
  }

  const PrimitiveVertices& vertices_;
  const PrimitiveState& state_;
  const ClipState& clip_;
  const SetupState& setup_;
  const Viewport& viewport_;
  ClippedPrimitive& out_;
  bool front_ = true;
};

}  // namespace

void clip_primitive(const PrimitiveVertices& vertices, const PrimitiveState& state,
                    std::span<const ViewState> views, ClippedPrimitive& out) {
  const std::size_t view = vertices.viewport < views.size() ? vertices.viewport : 0;
  Work(vertices, state, views[view], out).run();
  for (int i = 0; i < out.count; ++i)
    out.pieces[static_cast<std::size_t>(i)].viewport = static_cast<std::uint8_t>(view);
}

namespace {

std::array<LineEnd, 2> ends_of(const ClippedPiece& piece) {
  return {LineEnd{piece.vertices[0], piece.weights[0]}, {piece.vertices[1], piece.weights[1]}};
}

}  // namespace

SetupOutcome setup_piece(const ClippedPiece& piece, const PrimitiveState& state, const SetupState& setup,
                         TriangleSetup& out) {
  SetupOutcome outcome = SetupOutcome::kKept;
  switch (state.pieces()) {
    case PieceKind::kTriangle: return setup_triangle(piece.vertices, piece.weights, setup, out);
    case PieceKind::kLine: outcome = setup_line(ends_of(piece), setup, out); break;
    case PieceKind::kPoint:
      outcome = setup_point(
          {piece.vertices[0], piece.point_size, state.assembled == PieceKind::kTriangle, piece.weights[0]},
          setup, out);
      break;
  }
  out.front_facing = piece.front;
  return outcome;
}

LineCoverage piece_coverage(const ClippedPiece& piece, const SetupState& setup) {
  return line_coverage(ends_of(piece), setup);
}

std::int32_t piece_reach(const ClippedPiece& piece, PieceKind kind, const SetupState& setup) {
  switch (kind) {
    case PieceKind::kTriangle: return 0;
    case PieceKind::kLine: return line_reach(setup);
    case PieceKind::kPoint: return point_reach(piece.point_size, setup.subpixel_bits);
  }
  return 0;
}

}  // namespace quadrille::models
