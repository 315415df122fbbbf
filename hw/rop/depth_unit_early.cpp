/// The early port: covered tiles are tested before they are shaded, or go late.
#include "hw/rop/depth_unit.h"

#include "models/raster/interpolate.h"
#include "models/rop/depth_stencil.h"

#include <algorithm>
#include <bit>

namespace quadrille::hw {

namespace {

bool can_raise(const DrawState& draw) {
  const models::DepthStencilState& state = draw.depth_stencil;
  if (!state.depth_test || !state.depth_write) return false;
  switch (state.depth_compare) {
    case models::CompareOp::kNever:
    case models::CompareOp::kLess:
    case models::CompareOp::kEqual:
    case models::CompareOp::kLessOrEqual: return false;
    case models::CompareOp::kGreater:
    case models::CompareOp::kNotEqual:
    case models::CompareOp::kGreaterOrEqual:
    case models::CompareOp::kAlways: return true;
  }
  return true;
}

/// The depth test alone decides, and asks for less.
bool asks_for_less(const DrawState& draw) {
  const models::DepthStencilState& state = draw.depth_stencil;
  return state.depth_test && !state.bounds.test && !state.stencil.test &&
         (state.depth_compare == models::CompareOp::kLess ||
          state.depth_compare == models::CompareOp::kLessOrEqual);
}

int quads_in(std::uint64_t coverage) { return std::popcount(models::quads_of(coverage)); }

}  // namespace

Wake DepthUnit::early_take_wake() const {
  if (early_.size() >= static_cast<std::size_t>(params_.tiles_in_flight.value()))
    return Wake::never(coverage_out);
  return Wake(take_free_).input(coverage_in);
}

Wake DepthUnit::early_test_wake() const {
  if (early_.empty()) return Wake::never(coverage_in);
  const EarlyEntry& head = early_.front();
  if (!head.acquired && !stalled_) return Wake(std::max(free_, head.ready));
  if (!head.acquired || head.missing > 0) return Wake::never(port_.response_in[0]);
  if (some_wait_for_late_ && waits_for_late(head.token)) return Wake::never(late_in);
  return Wake(std::max(free_, head.ready)).output(coverage_out);
}

bool DepthUnit::early_ready(Tick now) const {
  return !early_.empty() && early_.front().acquired && early_test_wake().at() <= now;
}

void DepthUnit::take_early(Tick now) {
  const CoverageToken token = coverage_in.pop(now);
  if (token.kind == TokenKind::kWork) {
    ++stats_.tiles;
    if (token.in_front) ++stats_.tiles_unread;
    stats_.fragments_in += static_cast<std::uint64_t>(std::popcount(token.coverage));
  }
  early_.push_back({token, 0, after(now, 1), false, {}});
  take_free_ = after(now, 1);
}

/// What is in front of all that is there does not ask what that is.
SectorWishes DepthUnit::early_wishes(const CoverageToken& token) const {
  const std::uint32_t bytes = frame_.pass(pass_).depth.surface.pixel_bytes;
  if (!token.in_front) return {.read = sectors_of(token.coverage, bytes)};
  if (!frame_.draw(token.part.draw()).depth_stencil.depth_write) return {};
  return wishes_of_write(token.coverage, bytes, false);
}

bool DepthUnit::acquire_early(EarlyEntry& entry, std::uint32_t number) {
  stats_.working_for(entry.token.part.draw());
  if (entry.token.kind == TokenKind::kWork && frame_.draw(entry.token.part.draw()).uses_depth()) {
    if (!cache_.acquire({0, entry.token.tile_x, entry.token.tile_y, entry.token.sample},
                        early_wishes(entry.token), number, entry.missing, entry.done, port_))
      return false;
  }
  entry.acquired = true;
  return true;
}

/// Fragments before it in this tile are still to be tested, and its own tests may not wait for its shading.
bool DepthUnit::waits_for_late(const CoverageToken& token) const {
  return token.kind == TokenKind::kWork && frame_.draw(token.part.draw()).must_test_early() &&
         late_in_flight_[tile_number(token.tile_x, token.tile_y)] > 0;
}

void DepthUnit::test_early(Tick now) {
  CoverageToken token = early_.front().token;
  if (token.kind == TokenKind::kWork) stats_.working_for(token.part.draw(), token.tile_x, token.tile_y);
  else stats_.working_for(token.part.draw());
  int cycles = 1;
  if (token.kind == TokenKind::kPassBegin) begin_pass(token.part.pass());
  if (token.kind == TokenKind::kWork) {
    cycles = std::max(1, (quads_in(token.coverage) + params_.quads_per_clk - 1) / params_.quads_per_clk);
    if (!test_tile(frame_.draw(token.part.draw()), token, now)) {
      early_.front().acquired = false;  // no place for its lines now: ask again after the next fill
      stalled_ = true;
      return;
    }
    stats_.fragments_out += static_cast<std::uint64_t>(std::popcount(token.coverage));
  }
  if (hands_on(token)) coverage_out.push(now, token);
  early_.pop_front();
  free_ = after(now, cycles);
  occupy(now, cycles);
}

/// A tile's last token goes with those before it, whatever it covers: it says that there are no more.
bool DepthUnit::hands_on(const CoverageToken& token) {
  if (token.kind != TokenKind::kWork) return true;
  if (token.first) tile_passed_on_ = false;
  const bool hand_on = token.coverage != 0 || (token.last && tile_passed_on_);
  tile_passed_on_ |= hand_on;
  return hand_on;
}

bool DepthUnit::test_tile(const DrawState& draw, CoverageToken& token, Tick now) {
  if (can_raise(draw)) lowering_ = false;
  if (!draw.uses_depth()) {
    stats_.untested += static_cast<std::uint64_t>(std::popcount(token.coverage));
    return true;
  }
  std::uint32_t& in_flight = late_in_flight_[tile_number(token.tile_x, token.tile_y)];
  if (token.first) tile_late_ = draw.late_depth || in_flight > 0;
  token.late = tile_late_;
  const bool decidable = !token.late || (lowering_ && asks_for_less(draw) &&
                                         !draw.fragment.program->writes_depth && !draw.shades_hidden());
  models::DepthPlane stored = plane(token.tile_x, token.tile_y, token.sample);
  const std::uint64_t covered = token.coverage;
  alignas(32) float incoming[models::kTilePixels];
  if (decidable) {
    const models::TriangleSetup& triangle = triangles_[token.triangle].setup;
    models::sample_depths(triangle, token.tile_x, token.tile_y, draw.samples(), token.sample, incoming);
    models::round_depths(stored.format(), incoming);
    const models::DepthStencilOutcome outcome =
        models::test_depth_stencil(draw.depth_stencil, triangle.front_facing, stored, incoming, covered);
    if (!token.late && outcome.written() != 0) {
      if (!cache_.write({0, token.tile_x, token.tile_y, token.sample}, outcome.written(), port_))
        return false;
      models::write_depth_stencil(outcome, incoming, stored);
      cache_.pixels_written();
      stats_.stencil_written += static_cast<std::uint64_t>(std::popcount(outcome.stencil_written));
      // What was not read is not known, so that only a tile that is covered whole tells its greatest depth.
      const bool known =
          !token.in_front || (token.coverage == ~std::uint64_t{0} && draw.samples().count == 1);
      if (outcome.depth_written != 0 && known) send_hiz(now, token.tile_x, token.tile_y);
    }
    token.coverage = outcome.passed;
  }
  const auto killed = static_cast<std::uint64_t>(std::popcount(covered & ~token.coverage));
  stats_.early_killed += killed;
  if (token.late) {
    in_flight += static_cast<std::uint32_t>(quads_in(token.coverage));
    stats_.early_tested += killed;  // of a late tile, those alone are settled
    stats_.deferred += static_cast<std::uint64_t>(std::popcount(token.coverage));
  } else {
    stats_.early_tested += static_cast<std::uint64_t>(std::popcount(covered));
  }
  return true;
}

}  // namespace quadrille::hw
