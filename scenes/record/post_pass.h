/// A second pass over the picture of the first: its colours and depths become textures that a fragment shader
/// reads, pixel by pixel.
#pragma once

#include <string>

#include "traces/command_stream.h"

namespace quadrille::scenes {

/// Adds a pass that draws one triangle over the whole picture. Its fragment shader, GLSL, sees:
///
///     layout(location = 0) in vec2 uv;                       // 0..1, from the top left
///     layout(set = 0, binding = 0) uniform sampler2D color;  // linear values, filtered
///     layout(set = 0, binding = 1) uniform sampler2D depth;  // red, nearest; if the pass has depths
///     layout(location = 0) out vec4 result;                  // linear values
///
/// The picture that it makes has the format of the first. Throws `UserError` for a shader that does not
/// compile. The stream has a pass.
void add_post_pass(traces::CommandStream& stream, const std::string& fragment_shader);

}  // namespace quadrille::scenes
