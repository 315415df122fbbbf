#include "scenes/gltf/joint_streams.h"

#include <cmath>
#include <cstring>

#include "models/base/error.h"

namespace quadrille::scenes {
namespace {

using traces::Format;

constexpr double kRounding = 2e-7;  // of a sum, for each weight in it [glTF2.0 #skinned-mesh-attributes]

bool is_fraction(const Elements& weights) {
  return weights.normalized &&
         (weights.component == Component::kUint8 || weights.component == Component::kUint16);
}

float weight_at(const JointElements& set, std::size_t vertex, std::size_t i) {
  return component_value(set.weights, vertex, i);
}

/// The sum of a vertex's weights, and how many of them count.
struct Sum {
  double weight = 0;
  int terms = 0;
  [[nodiscard]] bool is_one() const { return std::abs(weight - 1) <= kRounding * terms; }
};

Sum sum_of(std::span<const JointElements> sets, std::size_t vertex) {
  Sum sum;
  for (const JointElements& set : sets) {
    for (std::size_t i = 0; i < 4; ++i) {
      const auto weight = static_cast<double>(weight_at(set, vertex, i));
      sum.weight += weight;
      sum.terms += weight > 0 ? 1 : 0;
    }
  }
  return sum;
}

void make_floats(Elements& weights) {
  if (weights.component == Component::kFloat) return;
  std::vector<std::byte> data(float_bytes(weights));
  for (std::size_t i = 0; i < std::size_t{4} * weights.count; ++i) {
    const float value = component_value(weights, i / 4, i % 4);
    std::memcpy(&data[4 * i], &value, 4);
  }
  weights = {Component::kFloat, 4, false, weights.count, std::move(data)};
}

void set_weight(JointElements& set, std::size_t vertex, std::size_t i, double weight) {
  const auto value = static_cast<float>(weight);
  std::memcpy(&set.weights.data[4 * (4 * vertex + i)], &value, 4);
}

void mend(std::span<JointElements> sets, std::size_t vertex, const Sum& sum) {
  for (JointElements& set : sets) make_floats(set.weights);
  if (sum.terms == 0) return set_weight(sets.front(), vertex, 0, 1);
  for (JointElements& set : sets) {
    for (std::size_t i = 0; i < 4; ++i)
      set_weight(set, vertex, i, static_cast<double>(weight_at(set, vertex, i)) / sum.weight);
  }
}

}  // namespace

void check_joints(const GltfFile& file, const JointElements& set, const std::string& place) {
  const auto& [joints, weights] = set;
  if (joints.components != 4 || joints.normalized ||
      (joints.component != Component::kUint16 && joints.component != Component::kUint8))
    throw user_error("{}: {}: JOINTS are four unsigned integers of 8 or 16 bits", file.path, place);
  if (weights.components != 4 || (!is_fraction(weights) && weights.component != Component::kFloat))
    throw user_error("{}: {}: WEIGHTS are four floats or normalized unsigned integers of 8 or 16 bits",
                     file.path, place);
  if (joints.count != weights.count)
    throw user_error("{}: {}: {} JOINTS where WEIGHTS has {}", file.path, place, joints.count, weights.count);
  for (std::size_t i = 0; i < std::size_t{4} * weights.count; ++i) {
    const float weight = weight_at(set, i / 4, i % 4);
    if (!std::isfinite(weight)) throw user_error("{}: {}: element {} is not finite", file.path, place, i / 4);
    if (weight < 0) throw user_error("{}: {}: vertex {} has the weight {}", file.path, place, i / 4, weight);
  }
}

std::size_t mend_weights(std::span<JointElements> sets) {
  std::size_t mended = 0;
  for (std::size_t vertex = 0; !sets.empty() && vertex < sets.front().weights.count; ++vertex) {
    const Sum sum = sum_of(sets, vertex);
    if (sum.is_one()) continue;
    mend(sets, vertex, sum);
    ++mended;
  }
  return mended;
}

std::pair<Array, Array> to_joint_arrays(JointElements set) {
  Elements& joints = set.joints;
  Elements& weights = set.weights;
  const std::size_t size = component_bytes(joints.component);
  for (std::size_t i = 0; i < std::size_t{4} * weights.count; ++i) {
    if (weight_at(set, i / 4, i % 4) == 0) std::memset(&joints.data[i * size], 0, size);
  }
  const Format numbers =
      joints.component == Component::kUint16 ? Format::kR16G16B16A16Uint : Format::kR8G8B8A8Uint;
  const Format fractions = weights.component == Component::kFloat   ? Format::kR32G32B32A32Float
                           : weights.component == Component::kUint8 ? Format::kR8G8B8A8UnormVertex
                                                                    : Format::kR16G16B16A16Unorm;
  return {Array{"JOINTS", numbers, joints.count, std::move(joints.data)},
          Array{"WEIGHTS", fractions, weights.count, std::move(weights.data)}};
}

}  // namespace quadrille::scenes
