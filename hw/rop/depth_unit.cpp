#include "hw/rop/depth_unit.h"

#include "hw/frame/detail_counts.h"
#include "hw/frame/fragment_output.h"
#include "hw/frame/laws.h"

#include "models/raster/interpolate.h"
#include "models/raster/quad_place.h"
#include "models/rop/depth.h"
#include "models/rop/tile_in_frame.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace quadrille::hw {

namespace {

constexpr std::uint32_t kFenceTag = 0xffffffffu;
constexpr std::uint32_t kLateBit = 0x80000000u;

bool can_raise(const DrawState& draw) {
  if (!draw.depth_test || !draw.depth_write) return false;
  switch (draw.depth_compare) {
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

bool asks_for_less(const DrawState& draw) {
  return draw.depth_compare == models::CompareOp::kLess ||
         draw.depth_compare == models::CompareOp::kLessOrEqual;
}

int quads_in(std::uint64_t coverage) { return std::popcount(models::quads_of(coverage)); }

/// Of the tile's pixels in the frame. Those outside keep the clear depth for ever; with them no tile that the
/// frame cuts would be hidden.
float greatest_depth(const float* depths, const models::SurfaceLayout& surface, std::uint32_t tile_x,
                     std::uint32_t tile_y) {
  const auto left = [](std::uint32_t size, std::uint32_t tile) {
    return static_cast<int>(size) - static_cast<int>(tile) * models::kTileSize;
  };
  const int width = left(surface.width, tile_x), height = left(surface.height, tile_y);
  const bool whole = width >= models::kTileSize && height >= models::kTileSize;
  return whole ? models::tile_max(depths)
               : models::tile_max_within(depths, models::pixels_within(width, height));
}

}  // namespace

DepthUnit::DepthUnit(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
                     const TriangleStore& triangles, Store<WarpSlot>& warps)
    : Unit(name, Kind::kChooser, context.clock),
      params_(params),
      frame_(context.frame),
      device_(context.memory),
      triangles_(triangles),
      warps_(warps),
      partition_(static_cast<std::uint32_t>(context.number)),
      partitions_(static_cast<std::uint32_t>(context.machine.partitions)),
      port_(*this, stats_, context.machine.channels),
      cache_(stats_, params.cache_lines, params.cache_ways, params.cache_misses, context.memory,
             surface_writer(SurfaceKind::kDepth, context.number)) {
  add_initiation_rate("quads_per_clk");
  some_wait_for_late_ = std::ranges::any_of(frame_.draws, &DrawState::shades_visible_only);
  add_places("tiles_in_flight",
             [this] { return early_.size() >= static_cast<std::size_t>(params_.tiles_in_flight.value()); });
  add_memory_places("cache_misses", [this] { return cache_.full(); });
}

std::string DepthUnit::state_text() const {
  return fmt::format("{} tiles in the early port, {} warps in the late port", early_.size(), late_.size());
}

std::size_t DepthUnit::tile_number(std::uint32_t tile_x, std::uint32_t tile_y) const {
  return std::size_t{tile_y} * frame_.passes[pass_].depth.surface.tiles_x + tile_x;
}

float* DepthUnit::depths(std::uint32_t tile_x, std::uint32_t tile_y) {
  return reinterpret_cast<float*>(
      device_.write(frame_.passes[pass_].depth.surface.tile_address(tile_x, tile_y), models::kTileBytes)
          .data());
}

// --- When ---

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

Wake DepthUnit::late_take_wake() const {
  if (late_.size() >= static_cast<std::size_t>(params_.tiles_in_flight.value()) || flush_ != Flush::kNone)
    return Wake::never(late_out);
  return Wake().input(late_in);
}

Wake DepthUnit::late_test_wake() const {
  if (late_.empty()) return Wake::never(late_in);
  const LateEntry& head = late_.front();
  if (!head.acquired && !stalled_) return Wake(std::max(free_, head.ready));
  if (!head.acquired || head.missing > 0) return Wake::never(port_.response_in[0]);
  return Wake(std::max(free_, head.ready)).output(late_out);
}

Wake DepthUnit::flush_wake() const {
  if (flush_ != Flush::kFenced || fences_ > 0) return Wake(kNever);
  return Wake(free_).output(late_out);
}

Wake DepthUnit::next() const {
  Wake wake = Wake::sooner(early_test_wake(), early_take_wake());
  wake = Wake::sooner(wake, late_test_wake());
  wake = Wake::sooner(wake, late_take_wake());
  wake = Wake::sooner(wake, flush_wake());
  wake = Wake::sooner(wake, port_.receive_wake());
  if (!port_.queue_empty()) wake = Wake::sooner(wake, port_.send_wake());
  return wake;
}

// --- What ---

void DepthUnit::act(Tick now) {
  take_answers(now);
  if (flush_wake().at() <= now) {
    late_out.push(now, {TokenKind::kPassEnd, 0});
    flush_ = Flush::kNone;
  }
  if (late_take_wake().at() <= now) take_late(now);
  if (early_take_wake().at() <= now) take_early(now);
  if (!stalled_) acquire_waiting(now);
  const bool late_done = late_ready(now) && test_late(now);
  if (!late_done && early_ready(now)) test_early(now);
  port_.send(now);
  advance_flush(now);
}

bool DepthUnit::early_ready(Tick now) const {
  return !early_.empty() && early_.front().acquired && early_test_wake().at() <= now;
}

bool DepthUnit::late_ready(Tick now) const {
  return !late_.empty() && late_.front().acquired && late_test_wake().at() <= now;
}

void DepthUnit::take_answers(Tick now) {
  port_.receive(now, [&](const MemoryResponse& answer) {
    if (answer.tag == kFenceTag) {
      --fences_;
      return;
    }
    stalled_ = false;
    cache_.fill(answer, [&](std::uint32_t waiter) {
      if ((waiter & kLateBit) != 0) {
        LateEntry& entry = late_[(waiter & ~kLateBit) - first_late_];
        --entry.missing;
        entry.ready = std::max(entry.ready, now);
      } else {
        EarlyEntry& entry = early_[waiter - first_early_];
        --entry.missing;
        entry.ready = std::max(entry.ready, now);
      }
    });
  });
}

void DepthUnit::take_early(Tick now) {
  const CoverageToken token = coverage_in.pop(now);
  if (token.kind == TokenKind::kWork) {
    ++stats_.tiles;
    stats_.fragments_in += static_cast<std::uint64_t>(std::popcount(token.coverage));
  }
  early_.push_back({token, 0, after(now, 1), false});
  take_free_ = after(now, 1);
}

void DepthUnit::take_late(Tick now) { late_.push_back({late_in.pop(now), 0, now, false}); }

void DepthUnit::acquire_waiting(Tick now) {
  for (std::size_t i = 0; i < late_.size(); ++i) {
    if (late_[i].acquired) continue;
    if (!acquire_late(late_[i], first_late_ + static_cast<std::uint32_t>(i))) {
      stalled_ = !cache_.idle();
      return;
    }
    late_[i].ready = std::max(late_[i].ready, now);
  }
  // The pass's first token sets up the surface; what follows it must not touch the cache before that.
  for (std::size_t i = 0; i < early_.size(); ++i) {
    if (early_[i].acquired) continue;
    if (i > 0 && early_[i - 1].token.kind == TokenKind::kPassBegin) return;
    if (!acquire_early(early_[i], first_early_ + static_cast<std::uint32_t>(i))) {
      stalled_ = !cache_.idle();
      return;
    }
    early_[i].ready = std::max(early_[i].ready, now);
  }
}

bool DepthUnit::acquire_early(EarlyEntry& entry, std::uint32_t number) {
  stats_.working_for(draw_of(entry.token.kind, entry.token.index));
  if (entry.token.kind == TokenKind::kWork && frame_.draw(entry.token.index).depth_test) {
    const std::uint8_t sectors = sectors_of_quads(models::quads_of(entry.token.coverage));
    if (!cache_.acquire({0, entry.token.tile_x, entry.token.tile_y}, {.read = sectors}, number & ~kLateBit,
                        entry.missing, entry.done, port_))
      return false;
  }
  entry.acquired = true;
  return true;
}

bool DepthUnit::acquire_late(LateEntry& entry, std::uint32_t number) {
  if (entry.token.kind == TokenKind::kWork) {
    const WarpSlot& warp = warps_[entry.token.slot];
    stats_.working_for(warp.draw);
    for (int q = 0; q < warp.quads; ++q) {
      if (((warp.alive >> (4 * q)) & 0xf) == 0) continue;
      const WarpSlot::Quad& quad = warp.quad[static_cast<std::size_t>(q)];
      const models::QuadPlace place = models::place_of_quad(quad.x, quad.y);
      const std::uint8_t sector = sectors_of_quads(1u << place.quad);
      if (!cache_.acquire({0, place.tile_x, place.tile_y}, {.read = sector}, (number & ~kLateBit) | kLateBit,
                          entry.missing, entry.done[static_cast<std::size_t>(q)], port_)) {
        return false;
      }
    }
  }
  entry.acquired = true;
  return true;
}

void DepthUnit::begin_pass(std::uint32_t pass) {
  pass_ = pass;
  lowering_ = true;
  const PassState& state = frame_.passes[pass];
  if (!state.has_depth) return;
  cache_.begin_pass({&state.depth, 1}, partition_, partitions_);
  const std::size_t tiles = std::size_t{state.depth.surface.tiles_x} * state.depth.surface.tiles_y;
  late_in_flight_.assign(tiles, 0);
  known_max_.assign(tiles, state.loads_depth() ? std::numeric_limits<float>::infinity() : state.clear_depth);
}

/// Fragments before it in this tile are still to be tested, and it may not be shaded before it is known to be
/// visible.
bool DepthUnit::waits_for_late(const CoverageToken& token) const {
  return token.kind == TokenKind::kWork && frame_.draw(token.index).shades_visible_only() &&
         late_in_flight_[tile_number(token.tile_x, token.tile_y)] > 0;
}

void DepthUnit::test_early(Tick now) {
  CoverageToken token = early_.front().token;
  if (token.kind == TokenKind::kWork) stats_.working_for(token.index, token.tile_x, token.tile_y);
  else stats_.working_for(draw_of(token.kind, token.index));
  int cycles = 1;
  if (token.kind == TokenKind::kPassBegin) begin_pass(token.index);
  if (token.kind == TokenKind::kWork) {
    cycles = std::max(1, (quads_in(token.coverage) + params_.quads_per_clk - 1) / params_.quads_per_clk);
    if (!test_tile(frame_.draw(token.index), token, now)) {
      early_.front().acquired = false;  // no place for its lines now: ask again after the next fill
      stalled_ = true;
      return;
    }
    stats_.fragments_out += static_cast<std::uint64_t>(std::popcount(token.coverage));
  }
  if (token.kind != TokenKind::kWork || token.coverage != 0) coverage_out.push(now, token);
  early_.pop_front();
  ++first_early_;
  free_ = after(now, cycles);
  occupy(now, cycles);
}

bool DepthUnit::test_tile(const DrawState& draw, CoverageToken& token, Tick now) {
  if (can_raise(draw)) lowering_ = false;
  if (!draw.depth_test) {
    stats_.untested += static_cast<std::uint64_t>(std::popcount(token.coverage));
    return true;
  }
  std::uint32_t& in_flight = late_in_flight_[tile_number(token.tile_x, token.tile_y)];
  token.late = draw.late_depth || in_flight > 0;
  const bool decidable = !token.late || (lowering_ && asks_for_less(draw) &&
                                         !draw.fragment.program->writes_depth && !draw.shades_hidden());
  float* const stored = depths(token.tile_x, token.tile_y);
  const std::uint64_t covered = token.coverage;
  alignas(32) float incoming[models::kTilePixels];
  if (decidable) {
    models::tile_depths(triangles_[token.triangle].setup, token.tile_x, token.tile_y, incoming);
    token.coverage = models::depth_test(draw.depth_compare, stored, incoming, covered);
  }
  if (!token.late && draw.depth_write && token.coverage != 0) {
    if (!cache_.write({0, token.tile_x, token.tile_y}, std::bit_cast<SectorPixels>(token.coverage), port_))
      return false;
    models::depth_write(stored, incoming, token.coverage);
    send_hiz(now, token.tile_x, token.tile_y);
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

void DepthUnit::send_hiz(Tick now, std::uint32_t tile_x, std::uint32_t tile_y) {
  if (!lowering_) return;
  float& known = known_max_[tile_number(tile_x, tile_y)];
  const float greatest =
      greatest_depth(depths(tile_x, tile_y), frame_.passes[pass_].depth.surface, tile_x, tile_y);
  if (!(greatest < known)) return;
  if (!hiz_out.room_at(now)) {
    ++stats_.hiz_dropped;
    return;
  }
  known = greatest;
  ++stats_.hiz_sent;
  hiz_out.push(now,
               {static_cast<std::uint16_t>(tile_x), static_cast<std::uint16_t>(tile_y), pass_, greatest});
}

bool DepthUnit::test_late(Tick now) {
  const LateToken token = late_.front().token;
  if (token.kind == TokenKind::kPassEnd) {
    stats_.working_for(kNoDraw);
    cache_.flush(port_);
    flush_ = Flush::kDraining;
    late_.pop_front();
    ++first_late_;
    return true;
  }
  WarpSlot& warp = warps_[token.slot];
  stats_.working_for(warp.draw);
  const DrawState& draw = frame_.draw(warp.draw);
  for (int q = 0; q < warp.quads && draw.depth_write; ++q) {
    const std::uint64_t lanes = (warp.alive >> (4 * q)) & 0xf;
    if (lanes == 0) continue;
    const WarpSlot::Quad& quad = warp.quad[static_cast<std::size_t>(q)];
    const models::QuadPlace place = models::place_of_quad(quad.x, quad.y);
    if (!cache_.write({0, place.tile_x, place.tile_y},
                      std::bit_cast<SectorPixels>(lanes << place.first_pixel()), port_)) {
      late_.front().acquired = false;
      stalled_ = !cache_.idle();
      return false;
    }
  }
  const models::LaneMask tested = warp.alive;
  models::LaneMask survivors = 0;
  for (int q = 0; q < warp.quads; ++q) survivors |= test_quad(draw, warp, q, now) << (4 * q);
  stats_.late_tested += static_cast<std::uint64_t>(std::popcount(tested));
  stats_.late_killed += static_cast<std::uint64_t>(std::popcount(tested & ~survivors));
  warp.alive = survivors;
  late_out.push(now, token);
  late_.pop_front();
  ++first_late_;
  const int cycles = std::max(1, (warp.quads + params_.quads_per_clk - 1) / params_.quads_per_clk);
  free_ = after(now, cycles);
  occupy(now, cycles);
  return true;
}

models::LaneMask DepthUnit::test_quad(const DrawState& draw, const WarpSlot& warp, int q, Tick now) {
  const WarpSlot::Quad& quad = warp.quad[static_cast<std::size_t>(q)];
  const QuadOfWarp part{q, models::place_of_quad(quad.x, quad.y), (warp.alive >> (4 * q)) & 0xf};
  const std::uint32_t tx = part.place.tile_x, ty = part.place.tile_y;
  --late_in_flight_[tile_number(tx, ty)];
  if (part.lanes == 0) return 0;
  const models::LaneMask passed = test_depth(draw, warp, part, depths(tx, ty));
  if (draw.depth_write && passed != 0) send_hiz(now, tx, ty);
  return passed;
}

void DepthUnit::advance_flush(Tick now) {
  if (flush_ != Flush::kDraining || !port_.queue_empty()) return;
  if (frame_.passes[pass_].has_depth) {  // without depths nothing was written that others could miss
    port_.fence(kFenceTag);
    fences_ = port_.slices();
  }
  flush_ = Flush::kFenced;
  free_ = after(now, 1);
}

void DepthUnit::audit(Audit& audit) const {
  audit.right(laws::kFragmentsCovered, stats_.fragments_in.value());
  audit.both(laws::kFragmentsTested, stats_.fragments_in.value(),
             stats_.early_killed.value() + stats_.fragments_out.value());
  audit.right(laws::kFragmentsDeferredOrNot,
              stats_.early_tested.value() + stats_.deferred.value() + stats_.untested.value());
  audit.both(laws::kFragmentsDeferred, stats_.deferred.value(), stats_.late_tested.value());
  audit.left(laws::kFragmentsPassed, stats_.fragments_out.value());
  audit.right(laws::kKilledLate, stats_.late_killed.value());
  cache_.stats().audit(audit, laws::kDepthCache);
  port_.audit(audit);
}

void DepthUnit::details(Details& details) const {
  details.by_draw(DrawCount::kKilledEarly, stats_.early_killed);
  details.by_tile(TileCount::kKilledEarly, stats_.early_killed);
  details.by_draw(DrawCount::kKilledLate, stats_.late_killed);
  port_.details(details, DrawCount::kDepthBytes, TileCount::kBytes);
}

std::vector<Facet> DepthUnit::row() const {
  return {rate("fragments", stats_.fragments_in, params_.quads_per_clk * models::kQuadPixels),
          share("killed early", stats_.early_killed, stats_.fragments_in),
          share("tested late", stats_.late_tested, stats_.fragments_in),
          count("killed late", stats_.late_killed),
          share("cache hit", cache_.stats().hits, cache_.stats().requests)};
}

}  // namespace quadrille::hw
