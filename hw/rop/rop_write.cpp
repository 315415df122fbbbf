/// What a ROP does with the colours of a warp that retires: takes their places in its cache, writes them, and
/// counts the turns.
#include "hw/frame/fragment_output.h"
#include "hw/rop/rop.h"

#include <algorithm>
#include <bit>
#include <span>

namespace quadrille::hw {

namespace {

/// Of a quad of these pixels, which the unit's path to its cache takes at once up to 4 bytes each.
int path_turns(const AttachmentState& color) {
  return std::max(1, static_cast<int>(color.surface.pixel_bytes) / 4);
}

}  // namespace

bool Rop::claim_colors(const WarpSlot& warp) {
  const DrawState& draw = frame_.draw(warp.draw);
  if (draw.order_independent) return transparency_.claim(warp, draw.samples().count);
  const TouchedTiles touched(warp, draw.samples().count);
  bool placed = true;
  draw.visit_colors([&](std::size_t color) {
    const std::span<const TileTouch> tiles = touched.all();
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      // Later samples first: where all of them are overwritten, no copy has to be saved from its original.
      const TileTouch& touch = tiles[cache_.keeps_copies() ? tiles.size() - 1 - i : i];
      placed = placed && cache_.write(touch.tile_of(color), touch.pixels, port_);
    }
  });
  return placed;
}

int Rop::write_colors(const WarpSlot& warp) {
  const DrawState& draw = frame_.draw(warp.draw);
  const int quads = write_quads(warp);
  int turns = 0;
  if (draw.order_independent) turns = transparency_.put(draw, warp);
  else draw.visit_colors([&](std::size_t color) { turns += quads * quad_turns(draw, color); });
  return std::max(1, (turns + params_.quads_per_clk - 1) / params_.quads_per_clk);
}

/// Returns the quads of one sample.
int Rop::write_quads(const WarpSlot& warp) {
  const DrawState& draw = frame_.draw(warp.draw);
  const int samples = draw.samples().count;
  int quads = 0;
  for (int q = 0; q < warp.quads; ++q) {
    if (warp.lanes_of(q) == 0) continue;
    const WarpSlot::Quad& quad = warp.quad[static_cast<std::size_t>(q)];
    QuadOfWarp part{q, models::place_of_quad(quad.x, quad.y)};
    stats_.working_at(part.place.tile_x, part.place.tile_y);
    stats_.written += static_cast<std::uint64_t>(std::popcount(warp.lanes_of(q)));
    for (part.sample = 0; part.sample < samples; ++part.sample) {
      part.lanes = warp.lanes_of(q, samples, part.sample);
      if (part.lanes == 0) continue;
      ++quads;
      write_samples(draw, warp, part);
    }
  }
  return quads;
}

void Rop::write_samples(const DrawState& draw, const WarpSlot& warp, const QuadOfWarp& part) {
  const auto pixels = static_cast<std::uint64_t>(std::popcount(part.lanes));
  stats_.samples_written += pixels;
  if (draw.order_independent) return;
  draw.visit_colors([&](std::size_t color) {
    stats_.pixels_written += pixels;
    if (draw.reads_color(color)) stats_.blended += pixels;
    write_color(draw, frame_.pass(pass_), color, warp, part, device_);
  });
}

int Rop::quad_turns(const DrawState& draw, std::size_t color) const {
  const AttachmentState& attachment = frame_.pass(pass_).color[color];
  const int path = path_turns(attachment);
  if (!draw.reads_color(color)) return path;
  const models::FormatInfo& format = models::format_info(attachment.format);
  const bool floats = format.numeric == models::Numeric::kFloat || format.numeric == models::Numeric::kUfloat;
  if (!draw.blend[color].enable || !floats) return 2 * path;
  const bool wide = format.component[0].bits == 32;
  return std::max(2 * path, wide ? params_.float_blend_turns * format.channels : params_.half_blend_turns);
}

}  // namespace quadrille::hw
