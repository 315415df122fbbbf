#include "hw/rop/transparency_buffer.h"

#include "hw/frame/laws.h"

#include <algorithm>
#include <bit>

namespace quadrille::hw {

void TransparencyBuffer::begin_pass(const PassState& pass, PartitionId partition, std::uint32_t partitions) {
  pass_ = &pass;
  if (!pass.transparency.on()) return;
  hidden_ = cache_.add_cleared(pass.transparency.hidden, partition, partitions);
  if (!pass.transparency.lists()) return;
  pool_surface_ = cache_.add_pool(pass.transparency.pool);
  pool_ = node_pool_of(pass, partition, partitions);
}

bool TransparencyBuffer::claim(const WarpSlot& warp, int samples) {
  const TransparencyPass& transparency = pass_->transparency;
  const TouchedTiles touched(warp, transparency.lists() ? 1 : samples);
  for (const TileTouch& touch : touched.all())
    for (std::uint32_t l = 0; l < planes(); ++l)
      if (!cache_.write(head_tile(touch.tile_x, touch.tile_y, touch.sample * planes() + l), touch.pixels,
                        port_))
        return false;
  if (!transparency.lists()) return true;
  plan_ = plan_append(*pass_, warp, memory_);
  const std::uint32_t end = pool_.next + plan_.nodes;
  for (std::uint32_t node = pool_.next; node < end;) {
    const std::uint32_t first = node % models::kTilePixels;
    const std::uint32_t count = std::min(models::kTilePixels - first, end - node);
    if (!cache_.write(block_of(node), ((std::uint64_t{1} << count) - 1) << first, port_)) return false;
    node += count;
  }
  return true;
}

int TransparencyBuffer::put(const DrawState& draw, const WarpSlot& warp) {
  if (!pass_->transparency.lists()) return put_layers_of(draw, warp);
  append_nodes(draw, *pass_, warp, plan_, pool_, memory_);
  stats_.nodes += plan_.counts.offered;
  stats_.lost += plan_.counts.overflowed;
  int quads = 0;
  for (int q = 0; q < warp.quads; ++q) quads += warp.lanes_of(q) != 0 ? 1 : 0;
  return quads * (2 * kHeadTurns + kNodeTurns);
}

int TransparencyBuffer::put_layers_of(const DrawState& draw, const WarpSlot& warp) {
  const int samples = draw.samples().count;
  int quads = 0;
  for (int q = 0; q < warp.quads; ++q) {
    const WarpSlot::Quad& quad = warp.quad[static_cast<std::size_t>(q)];
    QuadOfWarp part{q, models::place_of_quad(quad.x, quad.y)};
    for (part.sample = 0; part.sample < samples; ++part.sample) {
      part.lanes = warp.lanes_of(q, samples, part.sample);
      if (part.lanes == 0) continue;
      ++quads;
      const NodeCounts counts = put_layers(draw, *pass_, warp, part, memory_);
      stats_.nodes += counts.offered;
      stats_.merged += counts.overflowed;
    }
  }
  return quads * 2 * kNodeTurns * pass_->transparency.layers;
}

void TransparencyBuffer::audit(Audit& audit) const {
  audit.both(laws::kNodes, stats_.nodes.value(),
             stats_.merged.value() + stats_.lost.value() + stats_.composed.value());
}

}  // namespace quadrille::hw
