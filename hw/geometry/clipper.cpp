#include "hw/geometry/clipper.h"

#include "hw/frame/detail_counts.h"
#include "hw/frame/laws.h"

#include <bit>
#include <utility>

namespace quadrille::hw {

Clipper::Clipper(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
                 const Store<BatchSlot>& batches, std::vector<Store<models::ClippedPiece>*> pieces)
    : Unit(name, Kind::kFixedOrder, context.clock),
      params_(params),
      frame_(context.frame),
      batches_(batches),
      pieces_(std::move(pieces)),
      ring_(pieces_.size(), 0),
      screen_(context.machine.screen()),
      rate_(context.clock) {
  add_initiation_rate("rate");
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const std::string port = port_name("clipped_out", i, pieces_.size());
    clipped_out.push_back(std::make_unique<FifoOut<ClippedToken>>(*this, port.c_str()));
  }
}

/// Triangles leave in order, so all wait while any engine's link is full.
Wake Clipper::next() const {
  Wake wake = Wake(free_).input(primitive_in);
  for (const auto& out : clipped_out) wake.output(*out);
  return wake;
}

void Clipper::spend(Tick now, std::int64_t cost) {
  free_ = rate_.charge(now, cost);
  occupy(now, rate_.cycles());
}

void Clipper::act(Tick now) {
  const PrimitiveToken& token = primitive_in.front();
  if (!emitting_ && token.kind == TokenKind::kWork) return take_primitive(now);
  if (!emitting_) stats_.working_for(token.part.draw());
  spend(now, WorkRate::cost(params_.triangles_per_clk));
  if (emitting_) return emit_piece(now);
  for (const auto& out : clipped_out) out->push(now, {token.kind, token.part, token.slot, 0, {}, 0});
  (void)primitive_in.pop(now);
}

void Clipper::read_vertices(const PrimitiveToken& token, const DrawState& draw) {
  const auto output = [&](std::size_t i, int slot) {
    const auto& [batch, lane] = token.corner[i];
    return std::bit_cast<float>(batches_[batch].outputs[static_cast<std::size_t>(slot)][lane]);
  };
  models::read_vertices(draw.primitives, models::first_extra_output(*draw.vertex.program), output, vertices_);
}

void Clipper::take_primitive(Tick now) {
  const PrimitiveToken& token = primitive_in.front();
  const DrawState& draw = frame_.draw(token.part.draw());
  read_vertices(token, draw);
  models::clip_primitive(vertices_, draw.primitives, draw.views, clipped_);
  stats_.working_for(token.part.draw());
  tally(draw);
  spend(now, cost(draw));
  next_piece_ = 0;
  emitting_ = clipped_.count > 0;
  if (!emitting_) (void)primitive_in.pop(now);
  else if (clipped_.outcome == models::ClipOutcome::kInside) emit_piece(now);
}

/// A triangle that is not filled is no polygon any more: its edges are cut as lines are.
std::int64_t Clipper::cost(const DrawState& draw) const {
  if (clipped_.outcome != models::ClipOutcome::kClipped) return WorkRate::cost(params_.triangles_per_clk);
  const bool polygon = draw.primitives.pieces() == models::PieceKind::kTriangle;
  const std::int64_t each = polygon ? params_.clip_clk : params_.line_clip_clk;
  return clipped_.cuts * each * WorkRate::kCycle;
}

void Clipper::tally(const DrawState& draw) {
  ++stats_.triangles;
  if (draw.primitives.assembled == models::PieceKind::kLine) ++stats_.lines;
  if (draw.primitives.assembled == models::PieceKind::kPoint) ++stats_.points;
  const bool whole = draw.primitives.pieces() == draw.primitives.assembled;
  switch (clipped_.outcome) {
    case models::ClipOutcome::kInside: ++(whole ? stats_.passed : stats_.outlined); break;
    case models::ClipOutcome::kClipped: ++stats_.clipped; break;
    case models::ClipOutcome::kRejected: ++stats_.rejected; break;
    case models::ClipOutcome::kCulled: ++stats_.culled; break;
    case models::ClipOutcome::kNotFinite: ++stats_.not_finite; break;
  }
  if (!whole || clipped_.outcome == models::ClipOutcome::kClipped)
    stats_.pieces += static_cast<std::uint64_t>(clipped_.count);
}

void Clipper::emit_piece(Tick now) {
  send(now, primitive_in.front(), clipped_.pieces[static_cast<std::size_t>(next_piece_)]);
  emitting_ = ++next_piece_ < clipped_.count;
  if (!emitting_) (void)primitive_in.pop(now);
}

std::uint32_t Clipper::engines_of(const PrimitiveToken& token, const models::ClippedPiece& piece) {
  if (screen_.engines == 1) return 1;
  const DrawState& draw = frame_.draw(token.part.draw());
  const PassState& pass = frame_.pass_of(token.part.draw());
  const std::int32_t reach = models::piece_reach(piece, draw.primitives.pieces(), draw.setup());
  return models::engines_touched(piece.vertices, reach, frame_.precision.subpixel_bits, pass.width,
                                 pass.height, screen_, turn_++);
}

void Clipper::send(Tick now, const PrimitiveToken& token, const models::ClippedPiece& piece) {
  const std::uint32_t engines = engines_of(token, piece);
  for (std::size_t e = 0; e < pieces_.size(); ++e) {
    if ((engines >> e & 1u) == 0) continue;
    (*pieces_[e])[ring_[e]] = piece;
    clipped_out[e]->push(now, {TokenKind::kWork,
                               token.part,
                               token.slot,
                               token.primitive,
                               {token.corner[0], token.corner[1], token.corner[2]},
                               ring_[e]});
    ring_[e] = ring_[e] + 1 == pieces_[e]->size() ? 0 : ring_[e] + 1;
  }
  stats_.copies += static_cast<std::uint64_t>(std::popcount(engines) - 1);
}

void Clipper::audit(Audit& audit) const {
  audit.right(laws::kTrianglesAssembled, stats_.triangles.value());
  audit.both(laws::kTrianglesClipped, stats_.triangles.value(),
             stats_.passed.value() + stats_.clipped.value() + stats_.outlined.value() +
                 stats_.culled.value() + stats_.rejected.value() + stats_.not_finite.value());
  audit.left(laws::kPieces, stats_.passed.value() + stats_.pieces.value() + stats_.copies.value());
}

void Clipper::details(Details& details) const {
  details.by_draw(DrawCount::kTrianglesClipped, stats_.triangles);
  details.by_draw(DrawCount::kPiecesClipped, stats_.passed);
  details.by_draw(DrawCount::kPiecesClipped, stats_.pieces);
}

std::vector<Facet> Clipper::row() const {
  return {share("inside", stats_.passed, stats_.triangles), share("cut", stats_.clipped, stats_.triangles),
          share("outside", stats_.rejected, stats_.triangles), count("pieces", stats_.pieces)};
}

}  // namespace quadrille::hw
