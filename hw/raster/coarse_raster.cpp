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
                           const TriangleStore& triangles)
    : Unit(name, Kind::kChooser, context.clock),
      params_(params),
      frame_(context.frame),
      triangles_(triangles),
      screen_(context.machine.screen()),
      engine_(static_cast<std::uint32_t>(context.number)),
      sync_interval_(
          std::max<std::uint64_t>(1, triangles.size() / static_cast<std::uint64_t>(params.reports.value()))),
      order_(params.order.value().make()),
      rate_(context.clock) {
  add_initiation_rate("tests_per_clk");
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
  const TriangleToken token = triangle_in.pop(now);
  stats_.working_for(token.part.draw());
  if (token.kind == TokenKind::kWork) {
    if (stats_.triangles.value() == 0 || token.part.draw() != draw_)
      note_direction(frame_.draw(token.part.draw()));
    draw_ = token.part.draw();
    triangle_ = token.triangle;
    walk_ = models::TileWalk(triangles_[triangle_].setup, frame_.draw(draw_).samples());
    charged_tests_ = touched_ = owned_ = 0;
    if (!order_->as_walked()) sort_tiles();
    look_ahead();
    walking_ = true;
    ++stats_.triangles;
    free_ = now;  // the first tile may leave in this very cycle
    return;
  }
  if (token.kind == TokenKind::kPassBegin) begin_pass(token.part.pass());
  tile_out.push(now, {token.kind, false, 0, 0, token.part, token.triangle});
  spend(now, WorkRate::kCycle);
}

void CoarseRaster::begin_pass(PassId pass) {
  pass_ = pass;
  const PassState& state = frame_.pass(pass);
  hiz_trusted_ = true;
  hiz_.clear();
  const bool tests = state.has_depth && std::ranges::any_of(frame_.draws_of(state), [](const DrawState& d) {
                       return d.uses_depth();
                     });
  if (tests && params_.hiz)
    hiz_.assign(std::size_t{state.depth.surface.tiles_x} * state.depth.surface.tiles_y,
                state.loads_depth() ? std::numeric_limits<float>::infinity() : state.clear_depth);
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
  const float held = hiz_[static_cast<std::size_t>(tile.tile_y) * frame_.pass(pass_).depth.surface.tiles_x +
                          static_cast<std::size_t>(tile.tile_x)];
  const DrawState& draw = frame_.draw(draw_);
  const float nearest = models::round_depth(
      frame_.pass(pass_).depth.format,
      models::tile_depth_bounds(triangles_[triangle_].setup, tile.tile_x, tile.tile_y, draw.samples()).min);
  return draw.depth_stencil.depth_compare == models::CompareOp::kLess ? nearest >= held : nearest > held;
}

void CoarseRaster::look_ahead() {
  models::TileHit tile;
  ahead_.reset();
  while (!ahead_ && next_tile(tile)) {
    ++touched_;
    if (!owns(tile)) continue;
    ++owned_;
    ahead_ = tile;
  }
}

void CoarseRaster::sort_tiles() {
  sorted_.clear();
  next_sorted_ = 0;
  models::TileHit tile;
  while (walk_.next(tile))
    sorted_.emplace_back(
        order_->place(static_cast<std::uint32_t>(tile.tile_x), static_cast<std::uint32_t>(tile.tile_y)),
        tile);
  std::ranges::sort(sorted_, {}, [](const auto& entry) { return entry.first; });
}

bool CoarseRaster::next_tile(models::TileHit& tile) {
  if (order_->as_walked()) return walk_.next(tile);
  if (next_sorted_ == sorted_.size()) return false;
  tile = sorted_[next_sorted_++].second;
  return true;
}

bool CoarseRaster::owns(const models::TileHit& tile) const {
  return screen_.engines == 1 || screen_.engine_of_tile(static_cast<std::uint32_t>(tile.tile_x),
                                                        static_cast<std::uint32_t>(tile.tile_y)) == engine_;
}

std::uint64_t CoarseRaster::tests() const {
  const std::uint64_t kept = order_->as_walked() ? touched_ : sorted_.size();
  return owned_ + (walk_.tests() - kept) / screen_.engines;
}

void CoarseRaster::drop(const models::TileHit& tile) {
  stats_.working_for(draw_, static_cast<std::uint32_t>(tile.tile_x), static_cast<std::uint32_t>(tile.tile_y));
  ++stats_.tiles_hidden;
}

void CoarseRaster::walk(Tick now) {
  std::optional<models::TileHit> found;
  while (ahead_ && !found) {
    if (hidden(*ahead_)) drop(*ahead_);
    else found = ahead_;
    look_ahead();
  }
  const std::uint64_t tests = this->tests() - charged_tests_;
  charged_tests_ += tests;
  stats_.tiles_tested += tests;
  spend(now, std::max(WorkRate::cost(params_.tiles_per_clk),
                      WorkRate::cost_of(static_cast<std::int64_t>(tests), params_.tests_per_clk)));
  if (found) {
    ++stats_.tiles_kept;
    tile_out.push(now, {TokenKind::kWork, found->fully_covered, static_cast<std::uint16_t>(found->tile_x),
                        static_cast<std::uint16_t>(found->tile_y), draw_, triangle_});
  }
  if (ahead_) return;
  walking_ = false;
  sync_due_ = ++since_sync_ >= sync_interval_;
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
