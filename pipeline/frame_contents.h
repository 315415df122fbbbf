/// What a frame leaves in its attachments and buffers for the next one. Timing changes neither, so that it is
/// found without a machine.
#pragma once

#include "models/precision.h"
#include "traces/frame_contents.h"

namespace quadrille::pipeline {

/// Renders the stream without time. What passes store in attachments of one sample a pixel is there, and what
/// programs wrote to buffers; what the frame left alone is not. Throws `UserError` for what the stream cannot
/// do.
[[nodiscard]] traces::FrameContents contents_after(const traces::CommandStream& stream,
                                                   const models::Precision& precision);

}  // namespace quadrille::pipeline
