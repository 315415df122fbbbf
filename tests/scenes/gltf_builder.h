/// Builds glTF files for tests: typed accessors over one buffer, and the other parts as JSON text.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace quadrille::scenes {

class GltfBuilder {
 public:
  /// Adds an accessor over `values`; `type` is "SCALAR", "VEC3" ... Returns its number.
  template <class T>
  int accessor(const std::vector<T>& values, const std::string& type, bool normalized = false) {
    return add(std::as_bytes(std::span(values)), values.size(), component_type(T{}), type, normalized);
  }
  /// The file: `parts` are members of the top-level object besides asset, buffers, bufferViews and accessors.
  [[nodiscard]] std::string text(const std::string& parts) const;

 private:
  static int component_type(float) { return 5126; }
  static int component_type(std::uint8_t) { return 5121; }
  static int component_type(std::uint16_t) { return 5123; }
  static int component_type(std::int16_t) { return 5122; }
  static int component_type(std::int8_t) { return 5120; }
  int add(std::span<const std::byte> bytes, std::size_t components, int component_type,
          const std::string& type, bool normalized);

  std::vector<std::byte> buffer_;
  std::string views_, accessors_;
  int count_ = 0;
};

/// A strip of two bones along y: bone 0 at the origin holds y = 0, bone 1 one above it holds y = 2, and what
/// is at y = 1 hangs between both. Options replace parts of the file, to make it hostile.
struct ArmOptions {
  std::vector<float> key_times{0, 1};
  std::string interpolation = "LINEAR";
  bool wide_joints = false;       ///< 16 bits
  int weight_bits = 32;           ///< 8 and 16: normalized
  std::uint16_t last_joint = 1;   ///< of the upper vertices
  int inverse_binds = 2;          ///< how many matrices
  bool second_set = false;        ///< JOINTS_1 and WEIGHTS_1 with half of each weight
  std::string node_of_mesh = "";  ///< more members of the node that shows the mesh
  std::string joints = "[1,2]";
  float weight = 1;  ///< of the joint that holds a vertex alone
};
/// Its animation "bend" turns bone 1 by a quarter around z from 0 to 1 s. Nodes: 0 the mesh, 1 and 2 the
/// bones, 3 a camera on bone 2.
[[nodiscard]] std::string arm_gltf(const ArmOptions& options = {});

/// A unit square in the plane z = 0 with `targets` morph targets: target i moves all by one along axis i mod
/// 3, and its normals by (1, 0, 0). `weights` are the mesh's. Animation 0 takes all weights from 0 to 1 in 2
/// s.
[[nodiscard]] std::string morph_gltf(int targets, const std::string& weights);

}  // namespace quadrille::scenes
