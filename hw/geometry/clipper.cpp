#include "hw/geometry/clipper.h"

#include "hw/frame/detail_counts.h"
#include "hw/frame/laws.h"

#include <bit>
#include <utility>

namespace quadrille::hw {

Clipper::Clipper(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
                 const Store<BatchSlot>& batches, std::vector<Store<ClippedPiece>*> pieces)
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
    const std::string port = pieces_.size() == 1 ? "clipped_out" : fmt::format("clipped_out_{}", i);
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
  if (next_piece_ == 0 && token.kind == TokenKind::kWork) return take_triangle(now);
  if (next_piece_ == 0) stats_.working_for(token.part.draw());
  spend(now, WorkRate::cost(params_.triangles_per_clk));
  if (next_piece_ > 0) return emit_piece(now, next_piece_);
  for (const auto& out : clipped_out) out->push(now, {token.kind, token.part, token.slot, 0, {}, 0});
  (void)primitive_in.pop(now);
}

void Clipper::take_triangle(Tick now) {
  const PrimitiveToken& token = primitive_in.front();
  std::array<glm::vec4, 3> position;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& [slot, lane] = token.corner[i];
    for (int c = 0; c < 4; ++c)
      position[i][c] = std::bit_cast<float>(batches_[slot].outputs[static_cast<std::size_t>(c)][lane]);
  }
  stats_.working_for(token.part.draw());
  ++stats_.triangles;
  const models::ClipOutcome outcome =
      models::clip_triangle(position, frame_.draw(token.part.draw()).clip, polygon_);
  spend(now, outcome == models::ClipOutcome::kClipped ? params_.clip_clk * WorkRate::kCycle
                                                      : WorkRate::cost(params_.triangles_per_clk));
  switch (outcome) {
    case models::ClipOutcome::kInside: ++stats_.passed; return emit_piece(now, 1);
    case models::ClipOutcome::kClipped:
      ++stats_.clipped;
      stats_.pieces += static_cast<std::uint64_t>(polygon_.count - 2);
      next_piece_ = 1;
      return;
    case models::ClipOutcome::kRejected: ++stats_.rejected; break;
    case models::ClipOutcome::kNotFinite: ++stats_.not_finite; break;
  }
  (void)primitive_in.pop(now);
}

void Clipper::emit_piece(Tick now, int i) {
  const PrimitiveToken token = primitive_in.front();
  const DrawState& draw = frame_.draw(token.part.draw());
  ClippedPiece piece;
  const std::array<int, 3> corner{0, i, i + 1};
  bool valid = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const models::ClipVertex& v = polygon_.vertices[static_cast<std::size_t>(corner[k])];
    valid = models::to_window(v.position, draw.viewport, frame_.precision.subpixel_bits, piece.vertices[k]) &&
            valid;
    piece.weights[k] = {v.b1, v.b2};
  }
  QUADRILLE_CHECK(valid, "{}: a clipped vertex of draw {} has no window position", name(),
                  token.part.draw().index());
  send(now, token, piece);
  next_piece_ = i + 2 < polygon_.count ? i + 1 : 0;
  if (next_piece_ == 0) (void)primitive_in.pop(now);
}

std::uint32_t Clipper::engines_of(const PrimitiveToken& token, const ClippedPiece& piece) {
  if (screen_.engines == 1) return 1;
  const PassState& pass = frame_.pass_of(token.part.draw());
  return models::engines_touched(piece.vertices, frame_.precision.subpixel_bits, pass.width, pass.height,
                                 screen_, turn_++);
}

void Clipper::send(Tick now, const PrimitiveToken& token, const ClippedPiece& piece) {
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
  audit.both(
      laws::kTrianglesClipped, stats_.triangles.value(),
      stats_.passed.value() + stats_.clipped.value() + stats_.rejected.value() + stats_.not_finite.value());
  audit.left(laws::kPieces, stats_.passed.value() + stats_.pieces.value() + stats_.copies.value());
}

void Clipper::details(Details& details) const {
  details.by_draw(DrawCount::kTrianglesClipped, stats_.triangles);
}

std::vector<Facet> Clipper::row() const {
  return {share("inside", stats_.passed, stats_.triangles), share("cut", stats_.clipped, stats_.triangles),
          share("outside", stats_.rejected, stats_.triangles), count("pieces", stats_.pieces)};
}

}  // namespace quadrille::hw
