/// Places what a pass keeps of its order-independent draws.
///
/// Of an A-buffer the pool of nodes is as large as its pixels can need: each holds no more nodes than the
/// pass allows, nor more than there are triangles that could cover it. So it is never used up, and no picture
/// depends on who took the last node.
#pragma once

#include "hw/frame/frame.h"
#include "pipeline/driver/device_resources.h"

namespace quadrille::pipeline {

/// A pass without such draws keeps nothing. Throws `UserError` when memory does not hold it.
void place_transparency(const models::TransparencyState& wanted, std::span<const hw::DrawState> draws,
                        DeviceResources& resources, hw::PassState& pass);

}  // namespace quadrille::pipeline
