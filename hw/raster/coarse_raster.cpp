#include "hw/raster/coarse_raster.h"

#include "hw/frame/detail_counts.h"
#include "hw/frame/laws.h"

#include "models/raster/interpolate.h"

#include <algorithm>
#include <limits>

namespace quadrille::hw {

namespace {
bool lowers_depth(models::CompareOp op) {
  return op == models::CompareOp::kLess || op == models::CompareOp::kLessOrEqual;
}
}  // namespace

CoarseRaster::CoarseRaster(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
                           const TriangleStore& triangles, WalkedStore& walked)
    : Unit(name, Kind::kChooser, context.clock),
      params_(params),
      frame_(context.frame),
      triangles_(triangles),
      walked_(walked),
      sync_interval_(
          std::max<std::uint64_t>(1, triangles.size() / static_cast<std::uint64_t>(params.reports.value()))),
      traversal_(params.traversal.value().make(
          {params.order.value(), params.walk_setup_clk, params.rows_per_clk, params.segments_per_clk,
           context.machine.screen(), static_cast<std::uint32_t>(context.number)})),
      rate_(context.clock) {
  add_initiation_rate(traversal_->limited_by());
  for (int i = 0; i < context.machine.partitions_of_engine(); ++i) {
    hiz_in.add(*this, fmt::format("hiz_in_{}", i).c_str(), LinkRole::kReply);
  }
}

std::string CoarseRaster::state_text() const {
  return fmt::format("triangle {} of draw {}", triangle_, draw_.index());
}

Wake CoarseRaster::work_wake() const {
  if (walking_ || sync_due_) return Wake(free_).output(tile_out);
  Wake wake = Wake(free_).input(triangle_in);
  if (triangle_in.ready() != kNever && triangle_in.front().kind == TokenKind::kWork) return wake;
  return wake.output(tile_out);
}

Wake CoarseRaster::next() const { return Wake::sooner(work_wake(), hiz_in.earliest()); }

void CoarseRaster::act(Tick now) {
  take_updates(now);
  if (work_wake().at() <= now) work(now);
}

void CoarseRaster::take_updates(Tick now) {
  hiz_in.take_ready(now, [&](std::size_t, const HiZToken& update) {
    ++stats_.hiz_updates;
    if (update.pass != pass_ || hiz_.empty()) return;
    float& held = hiz_[std::size_t{update.tile_y} * frame_.pass(pass_).depth.surface.tiles_x + update.tile_x];
    held = std::min(held, update.max_depth);
  });
}

void CoarseRaster::work(Tick now) {
  if (walking_) return walk(now);
  if (sync_due_) {
    tile_out.push(now, {TokenKind::kSync, false, 0, 0, draw_, triangle_ + 1});
    sync_due_ = false;
    since_sync_ = 0;
    return spend(now, WorkRate::kCycle);
  }
  take_token(now);
}

void CoarseRaster::spend(Tick now, std::int64_t cost) {
  free_ = rate_.charge(now, cost);
  occupy(now, rate_.cycles());
}

void CoarseRaster::take_token(Tick now) {
  const Tick visible = clock().align(triangle_in.ready());
  const TriangleToken token = triangle_in.pop(now);
  stats_.working_for(token.part.draw());
  if (token.kind == TokenKind::kWork) {
    if (stats_.triangles.value() == 0 || token.part.draw() != draw_)
      note_direction(frame_.draw(token.part.draw()));
    return begin_triangle(now, visible, token);
  }
  walked_until_ = std::max(walked_until_, now);
  if (token.kind == TokenKind::kPassBegin) begin_pass(token.part.pass());
  tile_out.push(now, {token.kind, false, 0, 0, token.part, token.triangle});
  spend(now, WorkRate::kCycle);
}

/// The walk began when the triangle was there and the one before it was walked, be it that tiles of that one
/// were still leaving. The first tile may leave in the very cycle in which the walk, if any, is done.
void CoarseRaster::begin_triangle(Tick now, Tick visible, const TriangleToken& token) {
  draw_ = token.part.draw();
  triangle_ = token.triangle;
  const std::int64_t clk = traversal_->begin(triangles_[triangle_].setup, frame_.draw(draw_).samples());
  walked_until_ = after(std::max(walked_until_, visible), clk);
  free_ = std::max(now, walked_until_);
  occupy(now, clock().cycles(now, free_));
  look_ahead();
  walking_ = true;
  ++stats_.triangles;
}

void CoarseRaster::begin_pass(PassId pass) {
  pass_ = pass;
  const PassState& state = frame_.pass(pass);
  hiz_trusted_ = true;
  hiz_.clear();
  hiz_min_.clear();
  const bool tests = state.has_depth && std::ranges::any_of(frame_.draws_of(state), [](const DrawState& d) {
                       return d.uses_depth();
                     });
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::size_t tiles = std::size_t{state.depth.surface.tiles_x} * state.depth.surface.tiles_y;
  if (tests && params_.hiz) hiz_.assign(tiles, state.loads_depth() ? kInfinity : state.clear_depth);
  if (tests && params_.hiz_min) hiz_min_.assign(tiles, state.loads_depth() ? -kInfinity : state.clear_depth);
}

void CoarseRaster::note_direction(const DrawState& draw) {
  const models::DepthStencilState& state = draw.depth_stencil;
  if (state.depth_test && state.depth_write && !lowers_depth(state.depth_compare) &&
      state.depth_compare != models::CompareOp::kNever && state.depth_compare != models::CompareOp::kEqual) {
    hiz_trusted_ = false;
  }
  // A program that writes depth moves fragments away from the triangle's plane; its tiles cannot be judged by
  // it. One that writes memory does so for hidden fragments too, and so may a stencil test.
  hiz_usable_ = hiz_trusted_ && !hiz_.empty() && state.depth_test && lowers_depth(state.depth_compare) &&
                state.keeps_when_hidden() && !draw.fragment.program->writes_depth && !draw.shades_hidden();
}

bool CoarseRaster::hidden(const models::TileHit& tile) const {
  if (!hiz_usable_) return false;
  const float held = hiz_[tile_number(tile)];
  const DrawState& draw = frame_.draw(draw_);
  const float nearest = models::round_depth(
      frame_.pass(pass_).depth.format,
      models::tile_depth_bounds(triangles_[triangle_].setup, tile.tile_x, tile.tile_y, draw.samples()).min);
  return draw.depth_stencil.depth_compare == models::CompareOp::kLess ? nearest >= held : nearest > held;
}

std::size_t CoarseRaster::tile_number(const models::TileHit& tile) const {
  return static_cast<std::size_t>(tile.tile_y) * frame_.pass(pass_).depth.surface.tiles_x +
         static_cast<std::size_t>(tile.tile_x);
}

/// Tiles are handed on in API order, so that what is noted here is all that can be stored when this one is
/// tested, be it that some of it fails its own test.
bool CoarseRaster::passes_in_front(const models::TileHit& tile) {
  const DrawState& draw = frame_.draw(draw_);
  const models::DepthStencilState& state = draw.depth_stencil;
  if (hiz_min_.empty() || !state.depth_test) return false;
  const models::Format format = frame_.pass(pass_).depth.format;
  models::DepthBounds depths =
      models::tile_depth_bounds(triangles_[triangle_].setup, tile.tile_x, tile.tile_y, draw.samples());
  depths = {models::round_depth(format, depths.min), models::round_depth(format, depths.max)};
  float& held = hiz_min_[tile_number(tile)];
  const bool nearer =
      state.depth_compare == models::CompareOp::kLess ? depths.max < held : depths.max <= held;
  const bool in_front = nearer && lowers_depth(state.depth_compare) && !state.bounds.test &&
                        !state.stencil.test && !draw.late_depth && !draw.fragment.program->writes_depth;
  if (state.depth_write)
    held = draw.fragment.program->writes_depth ? -std::numeric_limits<float>::infinity()
                                               : std::min(held, depths.min);
  return in_front;
}

void CoarseRaster::look_ahead() {
  if (!ahead_) ahead_.emplace();
  if (!traversal_->next(*ahead_)) ahead_.reset();
}

void CoarseRaster::walk_ahead(Tick now) {
  walked_until_ = after(now, ahead_->next_row_clk);
  occupy(now, ahead_->next_row_clk);
  ahead_->next_row_clk = Traversal::Tile::kNoRow;
}

void CoarseRaster::drop(const models::TileHit& tile) {
  stats_.working_for(draw_, static_cast<std::uint32_t>(tile.tile_x), static_cast<std::uint32_t>(tile.tile_y));
  ++stats_.tiles_hidden;
}

std::optional<Traversal::Tile> CoarseRaster::visible_tile(Tick now) {
  std::optional<Traversal::Tile> found;
  while (ahead_ && !found) {
    if (ahead_->begins_row()) {
      if (walked_until_ > now) break;
      walk_ahead(now);
    }
    if (hidden(ahead_->hit)) drop(ahead_->hit);
    else found = ahead_;
    look_ahead();
  }
  return found;
}

void CoarseRaster::walk(Tick now) {
  const std::optional<Traversal::Tile> found = visible_tile(now);
  const Traversal::Work work = traversal_->take_work();
  count(work);
  spend(now, std::max(WorkRate::cost(params_.tiles_per_clk),
                      WorkRate::cost_of(static_cast<std::int64_t>(work.tests), params_.tests_per_clk)));
  if (found) hand_on(now, *found);
  walking_ = ahead_.has_value();
  if (!walking_) sync_due_ = ++since_sync_ >= sync_interval_;
  else if (ahead_->begins_row()) free_ = std::max(free_, walked_until_);
}

void CoarseRaster::hand_on(Tick now, const Traversal::Tile& tile) {
  ++stats_.tiles_kept;
  const bool in_front = passes_in_front(tile.hit);
  if (in_front) ++stats_.tiles_in_front;
  tile_out.push(now, {TokenKind::kWork, tile.hit.fully_covered, static_cast<std::uint16_t>(tile.hit.tile_x),
                      static_cast<std::uint16_t>(tile.hit.tile_y), draw_, triangle_,
                      tile.walked ? walked_.put(tile.coverage) : TileToken::kNotWalked, in_front});
}

void CoarseRaster::count(const Traversal::Work& work) {
  stats_.tiles_tested += work.tests;
  stats_.walked_parts += work.parts;
  stats_.rows += work.rows;
  stats_.spans += work.spans;
  stats_.segments += work.segments;
}

void CoarseRaster::audit(Audit& audit) const {
  audit.right(laws::kTrianglesWalked, stats_.triangles.value());
  audit.left(laws::kTiles, stats_.tiles_kept.value());
}

void CoarseRaster::details(Details& details) const {
  details.by_draw(DrawCount::kTrianglesWalked, stats_.triangles);
  details.by_tile(TileCount::kTilesHidden, stats_.tiles_hidden);
}

std::vector<Facet> CoarseRaster::row() const {
  return {rate("tile tests", stats_.tiles_tested, params_.tests_per_clk),
          mean("tiles/triangle", stats_.tiles_kept, stats_.triangles),
          share("kept", stats_.tiles_kept, stats_.tiles_tested),
          share("Hi-Z hid", stats_.tiles_hidden, stats_.tiles_kept.value() + stats_.tiles_hidden.value())};
}

}  // namespace quadrille::hw
