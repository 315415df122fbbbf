/// A frame in a machine's memory, ready to be drawn: scene, compiled shaders, decoded textures, addresses.
///
/// What most machines have alike is made once, and processes forked from this one each draw it on a machine
/// of their own. The cycles and the picture are those of `render_exact`.
#pragma once

#include <memory>
#include <string>

#include "pipeline/render.h"

namespace quadrille::pipeline {

class PreparedFrame {
 public:
  /// Builds the frame for machines like `config`, with the texels of every texture that a draw may sample.
  /// The stream must live as long. Throws `UserError` as `render_exact` does.
  PreparedFrame(const traces::CommandStream& stream, const MachineConfig& config);
  ~PreparedFrame();

  /// What of a machine the frame depends on, as text: the size of memory, precisions, and what the shader
  /// compiler knows of the cores. Machines that agree in it share a frame.
  [[nodiscard]] static std::string needs(const MachineConfig& config);
  /// Draws it; once, since memory holds the picture afterwards, and once a process. `config` has the needs
  /// that it was built for. Otherwise as `render_exact`.
  [[nodiscard]] RenderedFrame render(const MachineConfig& config, const MachineOptions& options = {},
                                     const hw::RunLimits& limits = {});

 private:
  const traces::CommandStream& stream_;
  std::string needs_;
  std::unique_ptr<DeviceFrame> frame_;
};

}  // namespace quadrille::pipeline
