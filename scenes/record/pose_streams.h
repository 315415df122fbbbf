/// What a posed mesh gives the materials' vertex shader besides its attributes: joints and weights, morph
/// targets, and the block with the pose itself.
///
/// Locations 6 to 15 are shared: a set of joints takes two, each delta of a morph target that has weight
/// takes one. What does not fit is posed on the host (scenes/record/host_pose.h), so that nothing is refused.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scenes/data/scene_data.h"
#include "scenes/material/material_variant.h"

namespace quadrille::scenes {

/// A vertex stream beyond the attributes; it is bound at the binding of its location.
struct PoseStream {
  std::uint32_t location = 0;
  int array = -1;  ///< into `SceneData::arrays`
};

struct PoseStreams {
  bool morph_on_host = false, skin_on_host = false;
  std::vector<PoseStream> streams;
  std::vector<std::string> defines;  ///< of the vertex shader
  /// `Pose` of scenes/material/shaders/material.vert, std140; empty: nothing is posed by the shader
  std::vector<std::byte> block;
};

inline constexpr std::uint32_t kFirstPoseLocation = kSemantics, kPoseLocations = 16 - kSemantics;
inline constexpr std::size_t kMaxShaderJoints = 1024;  ///< 48 KiB of a block's 64 KiB

/// How a primitive is posed. `attributes` are those that the shaders read; `on_host`: the vertex shader is
/// the user's, and knows no poses.
[[nodiscard]] PoseStreams choose_pose_streams(const Primitive& primitive, const Pose& pose,
                                              const std::array<bool, kSemantics>& attributes, bool on_host);

}  // namespace quadrille::scenes
