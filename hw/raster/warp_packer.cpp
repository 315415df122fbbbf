#include "hw/raster/warp_packer.h"

#include "hw/frame/detail_counts.h"
#include "hw/frame/laws.h"

#include "models/raster/tile.h"

#include <bit>

namespace quadrille::hw {

WarpPacker::WarpPacker(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
                       WarpStore& warps)
    : Unit(name, Kind::kChooser, context.clock),
      params_(params),
      frame_(context.frame),
      warps_(warps),
      partition_(context.partition()) {
  add_initiation_rate("quads_per_clk");
  add_places("warp_slots", [this] { return opened_ - retired_ >= warps_.size(); });
}

std::string WarpPacker::state_text() const {
  return fmt::format("{} of {} warp slots in use", opened_ - retired_, warps_.size());
}

Wake WarpPacker::launch_wake(Tick own) const { return Wake(own).output(warp_out).output(order_out); }

bool WarpPacker::full() const { return open_ && warps_[slot_of(opened_ - 1)].quads == models::kWarpQuads; }

bool WarpPacker::must_launch_first() const {
  if (!open_) return false;
  const WarpSlot& warp = warps_[slot_of(opened_ - 1)];
  const CoverageToken& token = coverage_in.front();
  if (token.kind == TokenKind::kWork) return token.part.draw() != warp.draw || token.late != warp.late;
  return token.kind != TokenKind::kSync;
}

Wake WarpPacker::input_wake() const {
  Wake wake = Wake(free_).input(coverage_in);
  if (coverage_in.ready() == kNever) return wake;
  const CoverageToken& token = coverage_in.front();
  if (must_launch_first()) return wake.output(warp_out).output(order_out);
  if (token.kind == TokenKind::kSync && open_) return wake;
  if (token.kind != TokenKind::kWork) return wake.output(order_out);
  return !open_ && opened_ - retired_ >= warps_.size() ? Wake::never(release_in) : wake;
}

Wake WarpPacker::work_wake() const {
  if (full()) return launch_wake(free_);
  if (!open_) return input_wake();
  // The patience counts whatever is on its way: what is not visible yet must not change what is done now.
  return Wake::sooner(input_wake(), launch_wake(std::max(free_, after(last_input_, params_.patience_clk))));
}

Wake WarpPacker::next() const { return Wake::sooner(work_wake(), Wake().input(release_in)); }

void WarpPacker::act(Tick now) {
  while (release_in.ready_at(now)) {
    (void)release_in.pop(now);
    ++retired_;
  }
  if (work_wake().at() <= now) work(now);
}

void WarpPacker::work(Tick now) {
  if (full()) return launch(now);
  if (!coverage_in.ready_at(now)) {
    ++stats_.timeouts;
    return launch(now);
  }
  if (must_launch_first()) return launch(now);
  while (more_samples(now)) take_sample(now);
  if (!coverage_in.ready_at(now)) return;
  if (coverage_in.front().kind == TokenKind::kWork) take_quads(now);
  else take_boundary(now);
}

void WarpPacker::take_boundary(Tick now) {
  const CoverageToken token = coverage_in.pop(now);
  stats_.working_for(token.part.draw());
  if (token.kind == TokenKind::kSync && open_) {
    sync_ = token.triangle;
  } else {
    order_out.push(now, {token.kind, token.part, {}, token.kind == TokenKind::kSync ? token.triangle : 0});
  }
  free_ = after(now, 1);
  occupy(now, 1);
}

bool WarpPacker::more_samples(Tick now) const {
  return coverage_in.ready_at(now) && coverage_in.front().kind == TokenKind::kWork &&
         !coverage_in.front().last && !frame_.draw(coverage_in.front().part.draw()).by_sample;
}

void WarpPacker::take_sample(Tick now) {
  const CoverageToken token = coverage_in.pop(now);
  stats_.working_for(token.part.draw(), token.tile_x, token.tile_y);
  planes_[token.sample] = token.coverage;
  covered_ |= token.coverage;
  last_input_ = now;
}

void WarpPacker::open_warp(const CoverageToken& token) {
  WarpSlot& warp = warps_[slot_of(opened_++)];
  open_ = true;
  sync_ = 0;
  warp.draw = token.part.draw();
  warp.late = token.late;
  warp.quads = 0;
  warp.covered = 0;
  warp.packed_samples = 0;
}

void WarpPacker::add_quad(WarpSlot& warp, const CoverageToken& token, int q) {
  const auto lanes = static_cast<std::uint32_t>((covered_ | token.coverage) >> (4 * q)) & 0xfu;
  const auto first = 4 * static_cast<std::size_t>(warp.quads);
  warp.covered |= lanes << first;
  warp.quad[static_cast<std::size_t>(warp.quads++)] = {
      token.triangle, static_cast<std::uint16_t>(8 * token.tile_x + 2 * (q & 3)),
      static_cast<std::uint16_t>(8 * token.tile_y + 2 * (q >> 2))};
  stats_.fragments += static_cast<std::uint64_t>(std::popcount(lanes));
  const DrawState& draw = frame_.draw(warp.draw);
  const int samples = draw.samples().count;
  if (samples == 1) {
    warp.packed_samples += static_cast<std::uint64_t>(std::popcount(lanes));
    stats_.samples += static_cast<std::uint64_t>(std::popcount(lanes));
    return;
  }
  WarpSlot::Quad& quad = warp.quad[static_cast<std::size_t>(warp.quads - 1)];
  if (draw.by_sample) quad.sample = token.sample;
  for (std::size_t i = 0; i < 4; ++i) {
    std::uint8_t& of_pixel = warp.samples[first + i];
    of_pixel = 0;
    for (std::size_t s = 0; s < static_cast<std::size_t>(samples); ++s) {
      const std::uint64_t plane = s == token.sample ? token.coverage : planes_[s];
      of_pixel =
          static_cast<std::uint8_t>(of_pixel | (plane >> (4 * static_cast<std::size_t>(q) + i) & 1u) << s);
    }
    quad.planes = static_cast<std::uint8_t>(quad.planes | of_pixel);
    warp.packed_samples += static_cast<std::uint64_t>(std::popcount(of_pixel));
    stats_.samples += static_cast<std::uint64_t>(std::popcount(of_pixel));
  }
}

void WarpPacker::take_quads(Tick now) {
  const CoverageToken& token = coverage_in.front();
  stats_.working_for(token.part.draw(), token.tile_x, token.tile_y);
  if (taken_quads_ == 0 && token.last) ++stats_.tiles;
  std::uint32_t left = models::quads_of(covered_ | token.coverage) & ~taken_quads_;
  if (!open_ && left != 0) open_warp(token);
  int packed = 0;
  for (; left != 0 && !full(); ++packed) {
    const int q = std::countr_zero(left);
    left &= left - 1;
    taken_quads_ |= 1u << q;
    add_quad(warps_[slot_of(opened_ - 1)], token, q);
  }
  stats_.quads += static_cast<std::uint64_t>(packed);
  if (left == 0) {
    taken_quads_ = 0;
    if (!token.first) {
      planes_.fill(0);
      covered_ = 0;
    }
    (void)coverage_in.pop(now);
  }
  last_input_ = now;
  const int cycles = std::max(1, (packed + params_.quads_per_clk - 1) / params_.quads_per_clk);
  free_ = after(now, cycles);
  occupy(now, cycles);
}

void WarpPacker::launch(Tick now) {
  const WarpSlotId slot = slot_of(opened_ - 1);
  WarpSlot& warp = warps_[slot];
  warp.alive = warp.covered;
  ++stats_.warps;
  if (warp.quads < models::kWarpQuads) ++stats_.partial_warps;
  warp_out.push(now, {warp.draw, slot, partition_, static_cast<std::uint16_t>(warp.quad[0].x / 8),
                      static_cast<std::uint16_t>(warp.quad[0].y / 8)});
  order_out.push(now, {TokenKind::kWork, warp.draw, slot, sync_});
  open_ = false;
  free_ = params_.launch_clk == 0 ? now : after(now, params_.launch_clk);
  occupy(now, params_.launch_clk);
}

void WarpPacker::audit(Audit& audit) const {
  audit.right(laws::kFragmentsPassed, stats_.samples.value());
  audit.left(laws::kSamplesRetired, stats_.samples.value());
  audit.left(laws::kFragmentsPacked, stats_.fragments.value());
  audit.left(laws::kWarpsPacked, stats_.warps.value());
}

void WarpPacker::details(Details& details) const {
  details.by_draw(DrawCount::kSamplesPacked, stats_.samples);
  details.by_draw(DrawCount::kPacked, stats_.fragments);
  details.by_tile(TileCount::kShaded, stats_.fragments);
}

std::vector<Facet> WarpPacker::row() const {
  return {rate("quads", stats_.quads, params_.quads_per_clk),
          mean("live lanes/warp", stats_.fragments, stats_.warps),
          share("partial warps", stats_.partial_warps, stats_.warps)};
}

}  // namespace quadrille::hw
