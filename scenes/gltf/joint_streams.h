/// JOINTS_n and WEIGHTS_n of a primitive: checked, mended where the weights of a vertex do not sum to one,
/// and as vertex streams.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include "scenes/gltf/accessor.h"

namespace quadrille::scenes {

/// One set of four joints and weights a vertex, as the file has it.
struct JointElements {
  Elements joints, weights;
};

/// Throws `UserError` with `place` for types that glTF does not allow, unequal numbers of elements, and a
/// weight that is not finite or below zero.
void check_joints(const GltfFile& file, const JointElements& set, const std::string& place);

/// Makes the weights of every vertex sum to one over all its sets, which have passed `check_joints` and are
/// of the same number of elements: they are divided by their sum, and a vertex without any weight hangs on
/// the first joint that it names. What is off by less than the rounding of its floats stays as it is. Where a
/// vertex is mended, the weights become floats. Returns how many vertices were. [glTF2.0
/// #skinned-mesh-attributes]
[[nodiscard]] std::size_t mend_weights(std::span<JointElements> sets);

/// The set as vertex streams of joints and weights; joints of no weight become joint 0.
[[nodiscard]] std::pair<Array, Array> to_joint_arrays(JointElements set);

}  // namespace quadrille::scenes
