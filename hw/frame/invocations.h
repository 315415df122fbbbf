/// Gives a warp what it needs to access storage buffers: rules without time, which the functional run uses
/// too. Warps of programs without buffers are left alone.
#pragma once

#include "hw/frame/stores.h"
#include "models/shader/warp.h"

namespace quadrille::hw {

/// For the vertices of a batch, lanes 0 to before `batch.lanes`.
void bind_storage(const Frame& frame, DrawId draw, const BatchSlot& batch, models::WarpStorage& storage,
                  models::Warp& warp);
/// For the fragments of a warp.
void bind_storage(const Frame& frame, const WarpSlot& work, const TriangleStore& triangles,
                  models::WarpStorage& storage, models::Warp& warp);

}  // namespace quadrille::hw
