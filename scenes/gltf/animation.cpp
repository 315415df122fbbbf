#include "scenes/gltf/animation.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "models/base/error.h"
#include "scenes/data/named_choice.h"
#include "scenes/gltf/accessor.h"

namespace quadrille::scenes {
namespace {

constexpr std::size_t kMaxValues = std::size_t{1} << 26;  // floats of all samplers of an animation: 256 MiB
constexpr const char* kAll = "all";

/// Reads one animation, with the words for its errors.
class Reader {
 public:
  Reader(const GltfFile& file, std::size_t index)
      : file_(file), source_(file.model.animations[index]), place_(fmt::format("animations[{}]", index)) {}

  Animation read() {
    animation_.name = source_.name;
    for (std::size_t i = 0; i < source_.channels.size(); ++i) read_channel(i);
    for (const Keyframes& keys : animation_.keyframes)
      animation_.length = std::max(animation_.length, static_cast<double>(keys.times.back()));
    return std::move(animation_);
  }

 private:
  [[noreturn]] void fail(const std::string& place, const std::string& reason) const {
    throw user_error("{}: {}.{}: {}", file_.path, place_, place, reason);
  }

  static std::optional<TrackTarget> target_of(const std::string& path) {
    if (path == "translation") return TrackTarget::kTranslation;
    if (path == "rotation") return TrackTarget::kRotation;
    if (path == "scale") return TrackTarget::kScale;
    if (path == "weights") return TrackTarget::kWeights;
    return std::nullopt;
  }

  /// Morph targets of the mesh that a node shows.
  std::size_t weights_of(int node, const std::string& place) const {
    const int mesh = file_.model.nodes[static_cast<std::size_t>(node)].mesh;
    const bool exists = mesh >= 0 && static_cast<std::size_t>(mesh) < file_.model.meshes.size();
    const auto* primitives =
        exists ? &file_.model.meshes[static_cast<std::size_t>(mesh)].primitives : nullptr;
    const std::size_t targets =
        primitives == nullptr || primitives->empty() ? 0 : primitives->front().targets.size();
    if (targets == 0) fail(place, fmt::format("weights of node {}, which has no morph targets", node));
    return targets;
  }

  void read_channel(std::size_t index) {
    const tinygltf::AnimationChannel& channel = source_.channels[index];
    const std::string place = fmt::format("channels[{}]", index);
    const std::optional<TrackTarget> target = target_of(channel.target_path);
    if (!target) {
      if (channel.target_path == "pointer") return;  // said once for the file
      fail(place, fmt::format("path '{}' is not translation, rotation, scale or weights",
                              channel.target_path.substr(0, 40)));
    }
    if (channel.target_node < 0) return;  // to be ignored [glTF2.0 #animations: target.node]
    if (static_cast<std::size_t>(channel.target_node) >= file_.model.nodes.size())
      fail(place, fmt::format("node {} does not exist (the file has {})", channel.target_node,
                              file_.model.nodes.size()));
    if (channel.sampler < 0 || static_cast<std::size_t>(channel.sampler) >= source_.samplers.size())
      fail(place, fmt::format("sampler {} does not exist (the animation has {})", channel.sampler,
                              source_.samplers.size()));
    if (*target != TrackTarget::kWeights &&
        !file_.model.nodes[static_cast<std::size_t>(channel.target_node)].matrix.empty())
      fail(place, fmt::format("it moves node {}, which has a matrix", channel.target_node));
    const std::size_t width = *target == TrackTarget::kRotation  ? 4
                              : *target == TrackTarget::kWeights ? weights_of(channel.target_node, place)
                                                                 : 3;
    animation_.tracks.push_back({channel.target_node, *target, keyframes(channel.sampler, width, *target)});
  }

  /// A sampler as keyframes of this width, read once for each use that it is put to.
  std::size_t keyframes(int sampler, std::size_t width, TrackTarget target) {
    const bool rotation = target == TrackTarget::kRotation;
    const auto [entry, added] = read_.try_emplace({sampler, width, rotation}, animation_.keyframes.size());
    if (added) animation_.keyframes.push_back(read_sampler(sampler, width, target));
    return entry->second;
  }

  Keyframes read_sampler(int index, std::size_t width, TrackTarget target) {
    const tinygltf::AnimationSampler& source = source_.samplers[static_cast<std::size_t>(index)];
    const std::string place = fmt::format("samplers[{}]", index);
    Keyframes keys;
    keys.width = width;
    keys.rotation = target == TrackTarget::kRotation;
    keys.interpolation = interpolation(source.interpolation, place);
    read_times(keys, source.input, place);
    read_values(keys, source.output, place, target == TrackTarget::kWeights);
    return keys;
  }

  Interpolation interpolation(const std::string& name, const std::string& place) const {
    if (name == "LINEAR" || name.empty()) return Interpolation::kLinear;
    if (name == "STEP") return Interpolation::kStep;
    if (name == "CUBICSPLINE") return Interpolation::kCubicSpline;
    fail(place, fmt::format("interpolation '{}' is not STEP, LINEAR or CUBICSPLINE", name.substr(0, 40)));
  }

  void charge(std::size_t values, const std::string& place) {
    values_ += values;
    if (values_ > kMaxValues)
      fail(place, fmt::format("the animation holds more than {} numbers", kMaxValues));
  }

  void read_times(Keyframes& keys, int accessor, const std::string& place) {
    const Elements e = read_accessor(file_, accessor, fmt::format("{}.{}.input", place_, place));
    if (e.components != 1 || e.component != Component::kFloat)
      fail(place, fmt::format("input: accessor {} is not of float scalars", accessor));
    charge(e.count, place);
    keys.times.resize(e.count);
    for (std::size_t i = 0; i < e.count; ++i) {
      const float time = keys.times[i] = component_value(e, i, 0);
      if (!std::isfinite(time) || time < 0)
        fail(place, fmt::format("input: key {} is at {} s, which is no time", i, time));
      if (i > 0 && !(time > keys.times[i - 1]))
        fail(place, fmt::format("input: key {} at {} s is not after the one before it, at {} s", i, time,
                                keys.times[i - 1]));
    }
  }

  void read_values(Keyframes& keys, int accessor, const std::string& place, bool scalars) {
    const Elements e = read_accessor(file_, accessor, fmt::format("{}.{}.output", place_, place));
    const std::size_t components = scalars ? 1 : keys.width;
    const bool numbers =
        e.component == Component::kFloat || (e.normalized && e.component != Component::kUint32);
    if (e.components != components || !numbers)
      fail(place, fmt::format("output: accessor {} is not of {} floats or normalized integers an element",
                              accessor, components));
    const std::size_t parts = keys.interpolation == Interpolation::kCubicSpline ? 3 : 1;
    const std::size_t due = keys.times.size() * parts * (keys.width / components);
    if (e.count != due)
      fail(place, fmt::format("output: {} elements where {} keys take {}", e.count, keys.times.size(), due));
    charge(e.count * components, place);
    keys.values.resize(e.count * components);
    for (std::size_t i = 0; i < keys.values.size(); ++i) {
      keys.values[i] = component_value(e, i / components, i % components);
      if (!std::isfinite(keys.values[i]))
        fail(place, fmt::format("output: element {} is not finite", i / components));
    }
    if (keys.rotation) check_rotations(keys, parts, place);
  }

  void check_rotations(const Keyframes& keys, std::size_t parts, const std::string& place) const {
    for (std::size_t key = 0; key < keys.times.size(); ++key) {
      const float* q = &keys.values[(key * parts + parts / 2) * 4];
      if (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0)
        fail(place, fmt::format("output: key {} is not a quaternion", key));
    }
  }

  const GltfFile& file_;
  const tinygltf::Animation& source_;
  std::string place_;
  Animation animation_;
  std::map<std::tuple<int, std::size_t, bool>, std::size_t> read_;
  std::size_t values_ = 0;
};

void apply(NodeMotion& motion, TrackTarget target, const std::vector<double>& v) {
  switch (target) {
    case TrackTarget::kTranslation: motion.translation = glm::dvec3(v[0], v[1], v[2]); break;
    case TrackTarget::kRotation: motion.rotation = glm::dquat(v[3], v[0], v[1], v[2]); break;
    case TrackTarget::kScale: motion.scale = glm::dvec3(v[0], v[1], v[2]); break;
    case TrackTarget::kWeights: motion.weights = v; break;
  }
}

}  // namespace

Animation read_animation(const GltfFile& file, std::size_t index) { return Reader(file, index).read(); }

std::vector<Animation> choose_animations(GltfFile& file, const std::string& choice) {
  std::vector<std::string> names;
  for (const tinygltf::Animation& animation : file.model.animations) names.push_back(animation.name);
  if (std::ranges::find(file.model.extensionsUsed, "KHR_animation_pointer") !=
      file.model.extensionsUsed.end())
    file.notes.emplace_back("KHR_animation_pointer is not supported; its channels are left out");
  std::vector<Animation> chosen;
  if (choice == kAll && !names.empty()) {
    for (std::size_t i = 0; i < names.size(); ++i) chosen.push_back(read_animation(file, i));
    return chosen;
  }
  if (choice.empty() && names.empty()) return chosen;
  const std::optional<std::size_t> index = find_choice(names, choice.empty() ? "0" : choice);
  if (!index)
    throw user_error("{}: animation '{}' does not exist; animations: {}", file.path, choice.substr(0, 60),
                     list_of_choices(names));
  chosen.push_back(read_animation(file, *index));
  return chosen;
}

NodeMotions motions_at(const std::vector<Animation>& animations, double time) {
  NodeMotions motions;
  for (const Animation& animation : animations) {
    for (const Track& track : animation.tracks)
      apply(motions[track.node], track.target, value_at(animation.keyframes[track.keyframes], time));
  }
  return motions;
}

}  // namespace quadrille::scenes
