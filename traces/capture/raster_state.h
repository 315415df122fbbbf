/// Everything that a draw is drawn with but its buffers and descriptors: what Vulkan spreads over a pipeline
/// and some sixty commands, of which the pipeline says which count.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "traces/capture/objects.h"
#include "traces/command_stream.h"

namespace quadrille::capture {

struct RasterState {
  traces::Pipeline pipeline;  ///< without its shaders
  std::vector<traces::SetViewport> viewports;
  std::vector<traces::SetScissor> scissors;
  std::array<bool, models::kMaxColorAttachments> color_write{true, true, true, true, true, true, true, true};
  bool negative_one_to_one = false;  ///< clip space is -w <= z <= w, as OpenGL's
  bool last_vertex = false;          ///< the last vertex of a primitive is the provoking one
  bool discard = false;              ///< nothing is rasterised
  bool alpha_to_one = false, stippled = false;
  /// Formats of attributes that have to be expanded (attributes.h), VkFormat by location.
  std::map<std::uint32_t, std::uint32_t> expanded;
  std::uint32_t samples = 1;
};

/// What a VkGraphicsPipelineCreateInfo fixes; what it leaves to commands has any value. Throws `UserError`.
[[nodiscard]] RasterState fixed_state(const Value& info);

/// Carries out a command that sets dynamic state; false if it is another command. Throws `UserError`.
bool set_dynamic_state(RasterState& dynamic, const Call& call);

/// The state of a draw: what the pipeline fixes, and of what it leaves to commands what they set. Throws
/// `UserError` for a dynamic state that this program does not know.
[[nodiscard]] RasterState combined_state(const Value& info, const RasterState& fixed,
                                         const RasterState& dynamic);

}  // namespace quadrille::capture
