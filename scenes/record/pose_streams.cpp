#include "scenes/record/pose_streams.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include <fmt/format.h>

namespace quadrille::scenes {
namespace {

constexpr std::array<const char*, kSemantics> kNames{"POSITION", "NORMAL", "TANGENT", "UV0", "UV1", "COLOR"};
constexpr std::size_t kShaderSemantics = 3;  ///< positions, normals and tangents are what the shader morphs
/// blocks are of 16, 32, 64 ... joints, so that skins share shaders
constexpr std::size_t kLeastJoints = 16;

std::vector<std::size_t> targets_with_weight(const Primitive& primitive, const Pose& pose) {
  std::vector<std::size_t> active;
  for (std::size_t t = 0; t < std::min(primitive.targets.size(), pose.weights.size()); ++t) {
    if (pose.weights[t] != 0) active.push_back(t);
  }
  return active;
}

bool moves(const MorphTarget& target, std::size_t semantic, const std::array<bool, kSemantics>& attributes) {
  return attributes[semantic] && target.deltas[semantic] >= 0;
}

/// Do the deltas that are read fit the locations that are left?
bool fits(const Primitive& primitive, const std::vector<std::size_t>& active,
          const std::array<bool, kSemantics>& attributes, std::size_t locations) {
  std::size_t needed = 0;
  for (const std::size_t t : active) {
    for (std::size_t s = 0; s < kSemantics; ++s) {
      if (!moves(primitive.targets[t], s, attributes)) continue;
      if (s >= kShaderSemantics) return false;
      ++needed;
    }
  }
  return needed <= locations;
}

class Chooser {
 public:
  Chooser(const Primitive& primitive, const Pose& pose, const std::array<bool, kSemantics>& attributes)
      : primitive_(primitive), pose_(pose), attributes_(attributes) {}

  PoseStreams run(bool on_host) {
    const bool skinned = !pose_.joints.empty();
    const std::vector<std::size_t> active = targets_with_weight(primitive_, pose_);
    const std::size_t sets = !skinned ? 0 : primitive_.joint_sets[1].joints >= 0 ? 2 : 1;
    out_.skin_on_host = skinned && (on_host || pose_.joints.size() > kMaxShaderJoints);
    // A skin comes after the morphing, so a skin on the host takes the morphing along.
    out_.morph_on_host =
        !active.empty() &&
        (on_host || out_.skin_on_host || !fits(primitive_, active, attributes_, kPoseLocations - 2 * sets));
    if (skinned && !out_.skin_on_host) add_joints(sets);
    if (!active.empty() && !out_.morph_on_host) add_morphs(active);
    // The weights are first in the block.
    out_.block.insert(out_.block.end(), joints_.begin(), joints_.end());
    return std::move(out_);
  }

 private:
  void add_joints(std::size_t sets) {
    for (std::size_t i = 0; i < sets; ++i) {
      out_.streams.push_back({location_++, primitive_.joint_sets[i].joints});
      out_.streams.push_back({location_++, primitive_.joint_sets[i].weights});
    }
    const std::size_t room = std::bit_ceil(std::max(kLeastJoints, pose_.joints.size()));
    joints_.resize(room * sizeof(JointMatrix));
    std::memcpy(joints_.data(), pose_.joints.data(), pose_.joints.size() * sizeof(JointMatrix));
    out_.defines.push_back(fmt::format("POSE_JOINTS {}", room));
    if (sets == 2) out_.defines.emplace_back("POSE_EIGHT_JOINTS");
  }

  /// The shader's text for the sum is made here, because GLSL has no loop over inputs.
  void add_morphs(const std::vector<std::size_t>& active) {
    std::string inputs;
    std::array<std::string, kShaderSemantics> sums;
    for (std::size_t i = 0; i < active.size(); ++i) {
      for (std::size_t s = 0; s < kShaderSemantics; ++s) {
        const MorphTarget& target = primitive_.targets[active[i]];
        if (!moves(target, s, attributes_)) continue;
        inputs += fmt::format("layout(location = {0}) in vec3 delta_{0}; ", location_);
        sums[s] += fmt::format("{}pose.weights[{}][{}] * delta_{}", sums[s].empty() ? "" : " + ", i / 4,
                               i % 4, location_);
        out_.streams.push_back({location_++, target.deltas[s]});
      }
    }
    if (inputs.empty()) return;
    out_.defines.push_back("POSE_DELTAS " + inputs);
    out_.defines.push_back(fmt::format("POSE_WEIGHTS {}", (active.size() + 3) / 4));
    for (std::size_t s = 0; s < kShaderSemantics; ++s) {
      if (!sums[s].empty()) out_.defines.push_back(fmt::format("POSE_{} {}", kNames[s], sums[s]));
    }
    out_.block.resize((active.size() + 3) / 4 * sizeof(glm::vec4));
    for (std::size_t i = 0; i < active.size(); ++i)
      std::memcpy(&out_.block[i * sizeof(float)], &pose_.weights[active[i]], sizeof(float));
  }

  const Primitive& primitive_;
  const Pose& pose_;
  const std::array<bool, kSemantics>& attributes_;
  PoseStreams out_;
  std::vector<std::byte> joints_;
  std::uint32_t location_ = kFirstPoseLocation;
};

}  // namespace

PoseStreams choose_pose_streams(const Primitive& primitive, const Pose& pose,
                                const std::array<bool, kSemantics>& attributes, bool on_host) {
  return Chooser(primitive, pose, attributes).run(on_host);
}

}  // namespace quadrille::scenes
