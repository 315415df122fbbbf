#include "hw/frame/invocations.h"

namespace quadrille::hw {
namespace {

/// False for a program without buffers.
bool bind(const Frame& frame, DrawId draw, models::ShaderStage stage, models::WarpStorage& storage,
          models::Warp& warp) {
  const ProgramState& state = frame.draw(draw).stage(stage);
  warp.storage = nullptr;
  if (state.buffers.empty()) return false;
  storage.memory = frame.storage;
  storage.buffers = state.buffers.data();
  storage.pass = frame.draw(draw).pass.index();
  storage.updates.fill(0);
  warp.storage = &storage;
  return true;
}

}  // namespace

void bind_storage(const Frame& frame, DrawId draw, const BatchSlot& batch, models::WarpStorage& storage,
                  models::Warp& warp) {
  if (!bind(frame, draw, models::ShaderStage::kVertex, storage, warp)) return;
  storage.live = ~models::LaneMask{0};
  storage.may_repeat = true;
  for (std::size_t lane = 0; lane < static_cast<std::size_t>(batch.lanes); ++lane)
    storage.invocations[lane] = models::invocation_of_vertex(draw.index(), batch.inputs.instance_index[lane],
                                                             batch.inputs.vertex_index[lane]);
}

void bind_storage(const Frame& frame, const WarpSlot& work, const TriangleStore& triangles,
                  models::WarpStorage& storage, models::Warp& warp) {
  if (!bind(frame, work.draw, models::ShaderStage::kFragment, storage, warp)) return;
  storage.live = work.covered;
  storage.may_repeat = false;
  for (std::size_t q = 0; q < static_cast<std::size_t>(work.quads); ++q) {
    const WarpSlot::Quad& quad = work.quad[q];
    const TriangleSlot& triangle = triangles[quad.triangle];
    for (std::size_t pixel = 0; pixel < 4; ++pixel)
      storage.invocations[4 * q + pixel] =
          models::invocation_of_fragment(work.draw.index(), triangle.instance, triangle.primitive,
                                         static_cast<std::uint16_t>(quad.x + (pixel & 1)),
                                         static_cast<std::uint16_t>(quad.y + (pixel >> 1)), quad.sample);
  }
}

}  // namespace quadrille::hw
