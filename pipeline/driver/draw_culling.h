/// Frustum culling of whole draws: which draws lie outside the view volume, whatever their triangles are.
///
/// The box of the vertices that a draw reads is carried through the part of its vertex program that makes
/// the position (position_bounds.h). A draw is outside if all positions that its box can lead to are outside
/// of one plane of the view volume. The clipper rejects each of its primitives then, so dropping it changes
/// no picture. A draw whose positions cannot be bounded, or whose vertex program writes buffers, is never
/// dropped.
///
/// It costs the host one look at each vertex and index of a mesh, however many draws have the mesh, and one
/// run of some dozen operations a draw. A machine would keep the boxes beside the draws, 24 bytes for
/// positions in three coordinates, and test them where it takes up draws (`command_processor.cull_draws`).
#pragma once

#include "hw/frame/frame.h"
#include "models/memory/device_memory.h"

namespace quadrille::pipeline {

/// Sets `outside_view` of the frame's draws. `memory` holds its buffers.
void find_draws_outside(hw::Frame& frame, const models::DeviceMemory& memory);

}  // namespace quadrille::pipeline
