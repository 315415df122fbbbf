/// The late port: shaded warps are tested in their order, and its flush ends a pass.
#include "hw/rop/depth_unit.h"

#include "hw/frame/fragment_output.h"

#include "models/raster/quad_place.h"

#include <algorithm>
#include <bit>

namespace quadrille::hw {

Wake DepthUnit::late_take_wake() const {
  if (late_.size() >= static_cast<std::size_t>(params_.tiles_in_flight.value()) || flush_.running())
    return Wake::never(late_out);
  return Wake().input(late_in);
}

Wake DepthUnit::late_test_wake() const {
  if (late_.empty()) return Wake::never(late_in);
  const LateEntry& head = late_.front();
  if (!head.acquired && !stalled_) return Wake(std::max(free_, head.ready));
  // Lines that nobody waits for come before the flush.
  if (head.token.kind == TokenKind::kPassEnd && !cache_.idle()) return Wake::never(port_.response_in[0]);
  if (!head.acquired || head.missing > 0) return Wake::never(port_.response_in[0]);
  return Wake(std::max(free_, head.ready)).output(late_out);
}

bool DepthUnit::late_ready(Tick now) const {
  return !late_.empty() && late_.front().acquired && late_test_wake().at() <= now;
}

void DepthUnit::take_late(Tick now) { late_.push_back({late_in.pop(now), 0, now, false, 0, {}}); }

bool DepthUnit::acquire_late(LateEntry& entry, std::uint32_t number) {
  if (entry.token.kind == TokenKind::kWork) {
    const WarpSlot& warp = warps_[entry.token.slot];
    stats_.working_for(warp.draw);
    const std::uint32_t bytes = frame_.pass(pass_).depth.surface.pixel_bytes;
    int part = 0;
    const bool placed = visit_samples(warp, [&](const WarpSlot::Quad& quad, models::LaneMask, int sample) {
      if (part++ < entry.parts) return true;
      const models::QuadPlace place = models::place_of_quad(quad.x, quad.y);
      const std::uint32_t sectors = sectors_of(std::uint64_t{0xf} << place.first_pixel(), bytes);
      if (!cache_.acquire({0, place.tile_x, place.tile_y, static_cast<std::uint32_t>(sample)},
                          {.read = sectors}, number | kLateBit, entry.missing, entry.done, port_))
        return false;
      ++entry.parts;
      entry.done = {};
      return true;
    });
    if (!placed) return false;
  }
  entry.acquired = true;
  return true;
}

bool DepthUnit::test_late(Tick now) {
  const LateToken token = late_.front().token;
  if (token.kind == TokenKind::kPassEnd) {
    stats_.working_for(kNoDraw);
    cache_.flush(port_);
    flush_.begin();
    late_.pop_front();
    return true;
  }
  WarpSlot& warp = warps_[token.slot];
  stats_.working_for(warp.draw);
  const DrawState& draw = frame_.draw(warp.draw);
  const bool placed =
      !draw.depth_stencil.writes() ||
      visit_samples(warp, [&](const WarpSlot::Quad& quad, std::uint64_t lanes, int sample) {
        const models::QuadPlace place = models::place_of_quad(quad.x, quad.y);
        return cache_.write({0, place.tile_x, place.tile_y, static_cast<std::uint32_t>(sample)},
                            lanes << place.first_pixel(), port_);
      });
  if (!placed) {
    late_.front().acquired = false;
    stalled_ = !cache_.idle();
    return false;
  }
  int quads = 0;
  std::uint64_t samples = 0;
  visit_samples(warp, [&](const WarpSlot::Quad&, models::LaneMask lanes, int) {
    ++quads;
    samples += static_cast<std::uint64_t>(std::popcount(lanes));
    return true;
  });
  stats_.late_tested += samples;
  const models::LaneMask tested = warp.alive;
  models::LaneMask survivors = 0;
  for (int q = 0; q < warp.quads; ++q) survivors |= test_quad(draw, warp, q, now) << (4 * q);
  cache_.pixels_written();
  stats_.late_killed += static_cast<std::uint64_t>(std::popcount(tested & ~survivors));
  warp.alive = survivors;
  stats_.late_killed_samples += samples - warp.alive_samples(draw.samples().count);
  late_out.push(now, token);
  late_.pop_front();
  // A quad whose lanes are all dead takes its place all the same.
  quads = std::max(quads, warp.quads);
  const int cycles = std::max(1, (quads + params_.quads_per_clk - 1) / params_.quads_per_clk);
  free_ = after(now, cycles);
  occupy(now, cycles);
  return true;
}

models::LaneMask DepthUnit::test_quad(const DrawState& draw, WarpSlot& warp, int q, Tick now) {
  const WarpSlot::Quad& quad = warp.quad[static_cast<std::size_t>(q)];
  const QuadOfWarp part{q, models::place_of_quad(quad.x, quad.y), warp.lanes_of(q)};
  const std::uint32_t tx = part.place.tile_x, ty = part.place.tile_y;
  const int samples = draw.samples().count;
  late_in_flight_[tile_number(tx, ty)] -=
      samples == 1 ? 1u : static_cast<std::uint32_t>(std::popcount(quad.planes));
  if (part.lanes == 0) return 0;
  const models::TriangleSetup& triangle = triangles_[quad.triangle].setup;
  const QuadOutcome outcome = test_samples(draw, warp, triangle, part, [&](int sample) {
    return plane(tx, ty, static_cast<std::uint32_t>(sample));
  });
  stats_.stencil_written += static_cast<std::uint64_t>(outcome.stencil_written);
  if (draw.depth_stencil.depth_write && outcome.passed != 0) send_hiz(now, tx, ty);
  return outcome.passed;
}

}  // namespace quadrille::hw
