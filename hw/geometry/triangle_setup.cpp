#include "hw/geometry/triangle_setup.h"

#include "hw/frame/detail_counts.h"
#include "hw/frame/laws.h"
#include "hw/frame/varyings.h"

#include <algorithm>
#include <bit>

namespace quadrille::hw {

namespace {

bool ends_batch(TokenKind kind) { return kind == TokenKind::kBatchEnd || kind == TokenKind::kRangeEnd; }

}  // namespace

TriangleSetupUnit::TriangleSetupUnit(sc_core::sc_module_name name, const UnitContext& context,
                                     const Params& params, const Stores& stores)
    : Unit(name, Kind::kChooser, context.clock),
      params_(params),
      frame_(context.frame),
      batches_(stores.batches),
      pieces_(stores.pieces),
      triangles_(stores.triangles),
      retired_by_(static_cast<std::size_t>(context.machine.partitions_of_engine())),
      rate_(context.clock) {
  add_initiation_rate("rate");
  for (int f = 0; f < context.machine.front_ends; ++f) {
    clipped_in.add(*this, context.front_end_port("clipped_in", f).c_str());
    release_out.push_back(std::make_unique<FifoOut<ReleaseToken>>(
        *this, context.front_end_port("release_out", f).c_str(), LinkRole::kReply));
  }
  add_places("triangle_slots", [this] { return sequence_ - retired_ >= triangles_.size(); });
  for (int i = 0; i < context.machine.partitions_of_engine(); ++i) {
    sync_in.add(*this, fmt::format("sync_in_{}", i).c_str(), LinkRole::kReply);
  }
}

std::string TriangleSetupUnit::state_text() const {
  return fmt::format("{} of {} triangle slots in use", sequence_ - retired_, triangles_.size());
}

Wake TriangleSetupUnit::work_wake() const {
  if (sequence_ - retired_ >= triangles_.size()) return Wake::never(sync_in[0]);
  const FifoIn<ClippedToken>& in = clipped_in[turn_];
  Wake wake = Wake(free_).input(in);
  if (in.ready() == kNever) return wake;
  return ends_batch(in.front().kind) ? wake.output(*release_out[turn_]) : wake.output(triangle_out);
}

Wake TriangleSetupUnit::next() const { return Wake::sooner(work_wake(), sync_in.earliest()); }

void TriangleSetupUnit::act(Tick now) {
  take_syncs(now);
  if (work_wake().at() <= now) work(now);
}

void TriangleSetupUnit::take_syncs(Tick now) {
  bool any = false;
  sync_in.take_ready(now, [&](std::size_t partition, const ReleaseToken& token) {
    retired_by_[partition] = token.sequence;
    any = true;
  });
  if (any) retired_ = *std::min_element(retired_by_.begin(), retired_by_.end());
}

void TriangleSetupUnit::work(Tick now) {
  const ClippedToken token = clipped_in[turn_].pop(now);
  std::int64_t cost = WorkRate::cost(params_.culled_per_clk);
  if (token.kind == TokenKind::kWork) {
    if (set_up(now, token)) cost = this->cost(frame_.draw(token.part.draw()));
  } else if (ends_batch(token.kind)) {
    release_out[turn_]->push(now, {token.slot, 0});
  } else {
    triangle_out.push(now, {token.kind, token.part, sequence_});
  }
  if (token.kind != TokenKind::kWork) {
    stats_.working_for(token.part.draw());
    cost = std::min(cost, WorkRate::kCycle);
    if (token.kind == TokenKind::kRangeEnd || token.kind == TokenKind::kDrawEnd)
      turn_ = turn_ + 1 == clipped_in.size() ? 0 : turn_ + 1;
  }
  free_ = rate_.charge(now, cost);
  occupy(now, rate_.cycles());
}

std::int64_t TriangleSetupUnit::cost(const DrawState& draw) const {
  switch (draw.primitives.pieces()) {
    case models::PieceKind::kTriangle: return WorkRate::cost(params_.drawn_per_clk);
    case models::PieceKind::kLine: return WorkRate::cost(params_.lines_per_clk);
    case models::PieceKind::kPoint: return WorkRate::cost(params_.points_per_clk);
  }
  return 0;
}

bool TriangleSetupUnit::set_up(Tick now, const ClippedToken& token) {
  const DrawState& draw = frame_.draw(token.part.draw());
  const ClippedPiece& piece = (*pieces_[turn_])[token.piece];
  TriangleSlot& slot = triangles_[sequence_];
  stats_.working_for(token.part.draw());
  ++stats_.triangles;
  switch (models::setup_piece(piece, draw.primitives, draw.views[piece.viewport].setup, slot.setup)) {
    case models::SetupOutcome::kKept: break;
    case models::SetupOutcome::kCulledFace: ++stats_.culled; return false;
    case models::SetupOutcome::kZeroArea: ++stats_.zero_area; return false;
    case models::SetupOutcome::kOffscreen: ++stats_.offscreen; return false;
    case models::SetupOutcome::kNoSample: ++stats_.no_sample; return false;
  }
  ++stats_.kept;
  const models::PieceKind kind = draw.primitives.pieces();
  if (kind == models::PieceKind::kLine) ++stats_.lines;
  if (kind == models::PieceKind::kPoint) ++stats_.points;
  if (draw.smooth_lines()) slot.line = models::piece_coverage(piece, draw.setup());
  slot.draw = token.part.draw();
  slot.primitive = token.primitive;
  slot.instance = batches_[token.corner[0].slot].inputs.instance_index[token.corner[0].lane];
  std::array<CornerOutputs, 3> corners;
  for (std::size_t i = 0; i < 3; ++i)
    corners[i] = {&batches_[token.corner[i].slot].outputs, token.corner[i].lane};
  gather_varyings(corners, draw.varyings(), slot.varyings);
  triangle_out.push(now, {TokenKind::kWork, token.part, sequence_++});
  return true;
}

void TriangleSetupUnit::audit(Audit& audit) const {
  audit.right(laws::kPieces, stats_.triangles.value());
  audit.both(laws::kTrianglesSetUp, stats_.triangles.value(),
             stats_.kept.value() + stats_.culled.value() + stats_.zero_area.value() +
                 stats_.offscreen.value() + stats_.no_sample.value());
  audit.left(laws::kTrianglesWalked, stats_.kept.value());
}

void TriangleSetupUnit::details(Details& details) const {
  details.by_draw(DrawCount::kTrianglesDrawn, stats_.kept);
}

std::vector<Facet> TriangleSetupUnit::row() const {
  return {share("kept", stats_.kept, stats_.triangles), share("culled", stats_.culled, stats_.triangles),
          share("no area", stats_.zero_area, stats_.triangles),
          share("off screen", stats_.offscreen, stats_.triangles),
          share("no sample", stats_.no_sample, stats_.triangles)};
}

}  // namespace quadrille::hw
