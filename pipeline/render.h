/// One frame from a command stream to an image and, when timed, its figures. What the program, the tests and
/// the comparisons call.
#pragma once

#include "pipeline/functional/functional.h"
#include "pipeline/machine/machine_config.h"
#include "pipeline/report/figures.h"
#include "traces/command_stream.h"

#include <functional>
#include <vector>

namespace quadrille::pipeline {

struct FrameImage {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint32_t> color;  ///< RGBA8, red in the low byte; rows top to bottom
  /// the numbers as stored, of a target of floats; else empty
  std::vector<std::array<float, 4>> linear{};
  std::vector<float> depth;  ///< rows top to bottom; empty when the target has no depth
};

/// What a buffer that programs wrote held at the end of the frame.
struct BufferContents {
  traces::Index buffer = traces::kNone;
  std::vector<std::byte> data;
  friend bool operator==(const BufferContents&, const BufferContents&) = default;
};

struct RenderedFrame {
  FrameImage image;
  std::vector<BufferContents> buffers;  ///< in order of the stream's buffers
  Figures figures;
};

/// Values only, no time: the same image as `render_exact`, bit for bit. `figures` holds the frame's counts,
/// the host times and what was left out.
[[nodiscard]] RenderedFrame render_functional_frame(const traces::CommandStream& stream,
                                                    const models::Precision& precision,
                                                    const PieceObserver& observer = {});

/// Simulates the machine. Once per process (SystemC elaborates once). Throws `UserError` for what the stream
/// or the machine cannot do. `detail`: what the figures tell of single draws and parts of the screen; it
/// changes nothing else.
[[nodiscard]] RenderedFrame render_exact(const traces::CommandStream& stream, const MachineConfig& config,
                                         const MachineOptions& options = {}, const hw::RunLimits& limits = {},
                                         DetailOptions detail = {});

}  // namespace quadrille::pipeline
