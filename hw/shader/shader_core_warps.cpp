/// Warps come to a core and leave it: their launch, and their results on the way out.
#include "hw/frame/fragment_output.h"
#include "hw/frame/invocations.h"
#include "hw/frame/varyings.h"
#include "hw/shader/shader_core.h"

#include <algorithm>
#include <bit>

namespace quadrille::hw {

void ShaderCore::accept_vertex(Tick now) {
  const Tick arrived = vertex_in.ready();
  const VertexWarpToken token = vertex_in.pop(now);
  accept({arrived, now, vertex_in.number(), true, token.draw}, [&](CoreSlot& slot) {
    slot.stage = models::ShaderStage::kVertex;
    slot.batch = token.slot;
    launch_vertex(slot);
  });
}

void ShaderCore::accept_fragment(Tick now) {
  const Tick arrived = fragment_in.ready();
  const FragmentWarpToken token = fragment_in.pop(now);
  accept({arrived, now, fragment_in.number(), true, token.draw}, [&](CoreSlot& slot) {
    slot.stage = models::ShaderStage::kFragment;
    slot.warp_slot = token.slot;
    slot.partition = token.partition;
    slot.tile_x = token.tile_x;
    slot.tile_y = token.tile_y;
    launch_fragment(slot);
  });
}

template <class Launch>
void ShaderCore::accept(const LegLog::Take& take, const Launch& launch) {
  stats_.working_for(take.draw);
  const std::uint32_t index = free_slots_.back();
  free_slots_.pop_back();
  CoreSlot& slot = slots_[index];
  slot.draw = take.draw;
  give_simd(slot);
  launch(slot);
  free_rows_ -= slot.warp.program->num_regs;
  accept_free_ = after(take.taken, 1);
  ready_.push_back({accept_free_, index});
  slot.leg_take = noted(leg_log(), take);
}

void ShaderCore::launch_vertex(CoreSlot& slot) {
  const DrawState& draw = frame_.draw(slot.draw);
  BatchSlot& batch = batches_[slot.batch];
  const models::LaneMask lanes =
      batch.lanes == models::kWarpLanes ? ~models::LaneMask{0} : (models::LaneMask{1} << batch.lanes) - 1;
  slot.warp.vertex = &batch.inputs;
  slot.warp.fragment = nullptr;
  slot.warp.outputs = batch.outputs.data();
  bind_storage(frame_, slot.draw, batch, slot.storage, slot.warp);
  slot.warp.texture_sizes = draw.vertex.texture_sizes.data();
  slot.warp.launch(*draw.vertex.program, draw.vertex.constants.data(), lanes);
  ++stats_.vertex_warps;
  stats_.vertices += static_cast<std::uint64_t>(batch.lanes);
}

void ShaderCore::launch_fragment(CoreSlot& slot) {
  const DrawState& draw = frame_.draw(slot.draw);
  const WarpSlot& work = (*warps_[slot.partition.index()])[slot.warp_slot];
  const std::uint32_t engine =
      models::engine_of_partition(slot.partition, static_cast<std::uint32_t>(triangles_.size()));
  fill_fragment_inputs(draw, work, *triangles_[engine], slot.fragment);
  const models::LaneMask lanes =
      work.quads == models::kWarpQuads ? ~models::LaneMask{0} : (models::LaneMask{1} << (4 * work.quads)) - 1;
  slot.warp.vertex = nullptr;
  slot.warp.fragment = &slot.fragment;
  slot.warp.outputs = slot.outputs.data();
  bind_storage(frame_, work, *triangles_[engine], slot.storage, slot.warp);
  slot.warp.texture_sizes = draw.fragment.texture_sizes.data();
  slot.warp.launch(*draw.fragment.program, draw.fragment.constants.data(), lanes);
  const auto live = static_cast<std::uint64_t>(std::popcount(work.covered));
  ++stats_.fragment_warps;
  stats_.fragments += live;
  stats_.helper_lanes += 4 * static_cast<std::uint64_t>(work.quads) - live;
}

void ShaderCore::give_simd(CoreSlot& slot) {
  const auto fewest = std::min_element(simd_warps_.begin(), simd_warps_.end());
  ++*fewest;
  slot.simd = static_cast<std::uint16_t>(fewest - simd_warps_.begin());
}

void ShaderCore::retire(Tick now, const Completion& done) {
  CoreSlot& slot = slots_[done.slot];
  if (slot.stage == models::ShaderStage::kVertex) {
    FifoOut<VertexDoneToken>& out = vertex_out_for(slot);
    note_leg(now, done, out);
    out.push(now, {slot.batch});
  } else {
    WarpSlot& work = (*warps_[slot.partition.index()])[slot.warp_slot];
    work.alive = work.covered & ~slot.warp.killed;
    take_outputs(frame_.draw(work.draw), slot.outputs, slot.fragment, work);
    FifoOut<FragmentDoneToken>& out = *fragment_out[slot.partition.index()];
    note_leg(now, done, out, export_free_ >= now);
    out.push(now, {slot.warp_slot});
    export_colors(now, work);
  }
  --simd_warps_[slot.simd];
  free_rows_ += slot.warp.program->num_regs;
  free_slots_.push_back(done.slot);
}

void ShaderCore::export_colors(Tick now, const WarpSlot& work) {
  const int bytes = static_cast<int>(frame_.color_bytes(frame_.draw(work.draw))) * std::popcount(work.alive);
  const int width = params_.export_bytes_per_clk;
  stats_.exported_bytes += static_cast<std::uint64_t>(bytes);
  export_free_ = after(now, std::max(1, (bytes + width - 1) / width));
}

}  // namespace quadrille::hw
