/// Frames of several passes with shaders of their own: what a scene needs that a pass over its materials does
/// not give, such as a shadow map or deferred shading.
///
/// All vertices come in world space through one model matrix a draw. Programs see `Frame`, which is put
/// before their text.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "scenes/data/scene_data.h"
#include "scenes/data/scene_options.h"
#include "scenes/view/camera.h"
#include "traces/command_stream.h"

namespace quadrille::scenes {

/// `Frame` of the shaders, at set 0, binding 0.
struct PassFrame {
  glm::mat4 view_projection{1}, inverse_view_projection{1};
  glm::mat4 light{1};  ///< world to the clip space of a shadow map
  glm::vec4 eye{0}, right{1, 0, 0, 0}, up{0, 1, 0, 0};
  glm::vec4 sun{0, 1, 0, 0};  ///< the way to it
};

/// Which of a scene's vertex streams a pipeline reads, in the order of its locations.
using PassStreams = std::vector<Semantic>;

class PassRecorder {
 public:
  PassRecorder(const SceneData& scene, const SceneOptions& options);
  [[nodiscard]] const View& view() const { return view_; }
  [[nodiscard]] traces::CommandStream& stream() { return stream_; }

  /// GLSL without its version line; `Frame frame` and `Draw draw` are there.
  [[nodiscard]] traces::Index shader(traces::ShaderStage stage, const std::string& name,
                                     std::string_view text);
  /// A triangle list of the scene's streams that tests and writes depth, or of the vertices' numbers alone.
  [[nodiscard]] traces::Pipeline scene_pipeline(const std::string& name, const PassStreams& streams,
                                                std::string_view vertex, std::string_view fragment);
  [[nodiscard]] traces::Pipeline screen_pipeline(const std::string& name, std::string_view fragment);
  [[nodiscard]] traces::Index add(traces::Pipeline pipeline);
  /// An attachment; later passes may sample it.
  [[nodiscard]] traces::Index attachment(const std::string& name, traces::Format format, std::uint32_t width,
                                         std::uint32_t height);
  [[nodiscard]] traces::Index buffer(const std::string& name, const void* data, std::size_t bytes);
  /// Attachments of earlier passes as textures of set 1, from binding 0 on, without a filter.
  [[nodiscard]] traces::Index textures(const std::vector<traces::Index>& images);

  void set_frame(const PassFrame& frame);
  void begin(const traces::BeginPass& pass);
  void end() { stream_.commands.emplace_back(traces::EndPass{}); }
  void bind(traces::Index pipeline, traces::Index textures = traces::kNone);
  /// All instances of the scene by a `scene_pipeline` of these streams.
  void draw_scene(traces::Index pipeline, const PassStreams& streams, traces::Index textures = traces::kNone);
  /// A triangle that holds the picture by a `screen_pipeline`.
  void draw_screen(traces::Index pipeline, traces::Index textures, const std::string& label);
  [[nodiscard]] traces::CommandStream finish();

 private:
  const SceneData& scene_;
  View view_;
  traces::CommandStream stream_;
  std::vector<traces::Index> arrays_;  ///< buffers of the scene's arrays
  traces::Index frame_set_ = traces::kNone;
};

}  // namespace quadrille::scenes
