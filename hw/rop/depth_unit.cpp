#include "hw/rop/depth_unit.h"

#include "hw/frame/detail_counts.h"
#include "hw/frame/fragment_output.h"
#include "hw/frame/laws.h"

#include "models/rop/depth.h"
#include "models/rop/tile_in_frame.h"

#include <algorithm>
#include <limits>

namespace quadrille::hw {

namespace {

/// Of the tile's pixels in the frame. Those outside keep the clear depth for ever; with them no tile that the
/// frame cuts would be hidden.
float greatest_of(const float* depths, const models::SurfaceLayout& surface, std::uint32_t tile_x,
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
                     const TriangleStore& triangles, WarpStore& warps)
    : Unit(name, Kind::kChooser, context.clock),
      params_(params),
      frame_(context.frame),
      device_(context.memory),
      triangles_(triangles),
      warps_(warps),
      partition_(context.partition()),
      partitions_(static_cast<std::uint32_t>(context.machine.partitions)),
      port_(*this, stats_, context.machine.channels),
      cache_(stats_, params.cache_lines, params.cache_ways, params.cache_misses, context.memory,
             surface_writer(SurfaceKind::kDepth, context.partition()),
             SurfaceCompression::of(params.compression)) {
  add_initiation_rate("quads_per_clk");
  some_wait_for_late_ = std::ranges::any_of(frame_.draws, &DrawState::must_test_early);
  add_places("tiles_in_flight",
             [this] { return early_.size() >= static_cast<std::size_t>(params_.tiles_in_flight.value()); });
  add_memory_places("cache_misses", [this] { return cache_.full(); });
}

std::string DepthUnit::state_text() const {
  return fmt::format("{} tiles in the early port, {} warps in the late port", early_.size(), late_.size());
}

std::size_t DepthUnit::tile_number(std::uint32_t tile_x, std::uint32_t tile_y) const {
  return std::size_t{tile_y} * frame_.pass(pass_).depth.surface.tiles_x + tile_x;
}

models::DepthPlane DepthUnit::plane(std::uint32_t tile_x, std::uint32_t tile_y, std::uint32_t sample) {
  return depth_plane(frame_.pass(pass_).depth, device_, tile_x, tile_y, sample);
}

float DepthUnit::greatest_depth(std::uint32_t tile_x, std::uint32_t tile_y) {
  const models::SurfaceLayout& surface = frame_.pass(pass_).depth.surface;
  float greatest = greatest_of(plane(tile_x, tile_y, 0).depths(), surface, tile_x, tile_y);
  for (std::uint32_t s = 1; s < surface.samples; ++s)
    greatest = std::max(greatest, greatest_of(plane(tile_x, tile_y, s).depths(), surface, tile_x, tile_y));
  return greatest;
}

// --- When ---

Wake DepthUnit::flush_wake() const { return flush_.done() ? Wake(free_).output(late_out) : Wake(kNever); }

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
    late_out.push(now, {TokenKind::kPassEnd, {}});
    flush_.end();
  }
  if (late_take_wake().at() <= now) take_late(now);
  if (early_take_wake().at() <= now) take_early(now);
  if (!stalled_) acquire_waiting(now);
  const bool late_done = late_ready(now) && test_late(now);
  if (!late_done && early_ready(now)) test_early(now);
  port_.send(now);
  // Without depths nothing was written that others could miss.
  if (flush_.running() && flush_.advance(frame_.pass(pass_).has_depth)) free_ = after(now, 1);
}

void DepthUnit::take_answers(Tick now) {
  port_.receive(now, [&](const MemoryResponse& answer) {
    if (flush_.take(answer)) return;
    stalled_ = false;
    cache_.fill(answer, [&](std::uint32_t waiter) {
      if ((waiter & kLateBit) != 0) late_.answer(waiter & ~kLateBit, now);
      else early_.answer(waiter, now);
    });
  });
}

void DepthUnit::acquire_waiting(Tick now) {
  for (std::size_t i = 0; i < late_.size(); ++i) {
    if (late_[i].acquired) continue;
    if (!acquire_late(late_[i], late_.number(i))) {
      stalled_ = !cache_.idle();
      return;
    }
    late_[i].ready = std::max(late_[i].ready, now);
  }
  // The pass's first token sets up the surface; what follows it must not touch the cache before that.
  for (std::size_t i = 0; i < early_.size(); ++i) {
    if (early_[i].acquired) continue;
    if (i > 0 && early_[i - 1].token.kind == TokenKind::kPassBegin) return;
    if (!acquire_early(early_[i], early_.number(i))) {
      stalled_ = !cache_.idle();
      return;
    }
    early_[i].ready = std::max(early_[i].ready, now);
  }
}

void DepthUnit::begin_pass(PassId pass) {
  pass_ = pass;
  lowering_ = true;
  const PassState& state = frame_.pass(pass);
  if (!state.has_depth) return;
  cache_.begin_pass({&state.depth, 1}, partition_, partitions_);
  const std::size_t tiles = std::size_t{state.depth.surface.tiles_x} * state.depth.surface.tiles_y;
  late_in_flight_.assign(tiles, 0);
  known_max_.assign(tiles, state.loads_depth() ? std::numeric_limits<float>::infinity() : state.clear_depth);
}

void DepthUnit::send_hiz(Tick now, std::uint32_t tile_x, std::uint32_t tile_y) {
  if (!lowering_) return;
  float& known = known_max_[tile_number(tile_x, tile_y)];
  const float greatest = greatest_depth(tile_x, tile_y);
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

void DepthUnit::audit(Audit& audit) const {
  audit.right(laws::kFragmentsCovered, stats_.fragments_in.value());
  audit.both(laws::kFragmentsTested, stats_.fragments_in.value(),
             stats_.early_killed.value() + stats_.fragments_out.value());
  audit.right(laws::kFragmentsDeferredOrNot,
              stats_.early_tested.value() + stats_.deferred.value() + stats_.untested.value());
  audit.both(laws::kFragmentsDeferred, stats_.deferred.value(), stats_.late_tested.value());
  audit.left(laws::kFragmentsPassed, stats_.fragments_out.value());
  audit.right(laws::kKilledLate, stats_.late_killed.value());
  audit.right(laws::kSamplesRetired, stats_.late_killed_samples.value());
  cache_.audit(audit, laws::kDepthCache, port_);
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
