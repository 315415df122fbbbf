#include "tests/scenes/gltf_builder.h"

#include <fmt/format.h>

#include "tests/scenes/gltf_text.h"

namespace quadrille::scenes {

int GltfBuilder::add(std::span<const std::byte> bytes, std::size_t components, int component_type,
                     const std::string& type, bool normalized) {
  const std::size_t width = type == "SCALAR" ? 1
                            : type == "VEC2" ? 2
                            : type == "VEC3" ? 3
                            : type == "VEC4" ? 4
                                             : 16;
  const std::string comma = count_ == 0 ? "" : ",";
  views_ +=
      fmt::format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{}}})", comma, buffer_.size(), bytes.size());
  accessors_ +=
      fmt::format(R"({}{{"bufferView":{},"componentType":{},"count":{},"type":"{}","normalized":{}}})", comma,
                  count_, component_type, components / width, type, normalized);
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  buffer_.resize((buffer_.size() + 3) / 4 * 4);
  return count_++;
}

std::string GltfBuilder::text(const std::string& parts) const {
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{},"uri":"{}"}}],"bufferViews":[{}],"accessors":[{}],{}}})",
      buffer_.size(), data_uri(buffer_), views_, accessors_, parts);
}

namespace {

template <class T>
int weights_accessor(GltfBuilder& b, const std::vector<float>& weights, float one) {
  std::vector<T> values;
  for (const float w : weights) values.push_back(static_cast<T>(w * one));
  return b.accessor(values, "VEC4", one != 1.0F);
}

int add_weights(GltfBuilder& b, std::vector<float> weights, int bits, float factor) {
  for (float& w : weights) w *= factor;
  if (bits == 8) return weights_accessor<std::uint8_t>(b, weights, 255);
  return bits == 16 ? weights_accessor<std::uint16_t>(b, weights, 65535)
                    : weights_accessor<float>(b, weights, 1);
}

template <class T>
int joints_accessor(GltfBuilder& b, std::uint16_t last) {
  const T top = static_cast<T>(last);
  return b.accessor(
      std::vector<T>{0, 9, 9, 9, 0, 9, 9, 9, 0, top, 9, 9, 0, top, 9, 9, top, 9, 9, 9, top, 9, 9, 9}, "VEC4");
}

}  // namespace

std::string arm_gltf(const ArmOptions& o) {
  GltfBuilder b;
  const int positions =
      b.accessor<float>({-0.5F, 0, 0, 0.5F, 0, 0, -0.5F, 1, 0, 0.5F, 1, 0, -0.5F, 2, 0, 0.5F, 2, 0}, "VEC3");
  const int normals = b.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int indices = b.accessor<std::uint8_t>({0, 1, 2, 2, 1, 3, 2, 3, 4, 4, 3, 5}, "SCALAR");
  const int joints = o.wide_joints ? joints_accessor<std::uint16_t>(b, o.last_joint)
                                   : joints_accessor<std::uint8_t>(b, o.last_joint);
  const float w = o.weight;
  const std::vector<float> plain{w,    0,    0, 0, w, 0, 0, 0, 0.5F, 0.5F, 0, 0,
                                 0.5F, 0.5F, 0, 0, w, 0, 0, 0, w,    0,    0, 0};
  const int weights = add_weights(b, plain, o.weight_bits, o.second_set ? 0.5F : 1.0F);
  std::vector<float> binds;
  for (int i = 0; i < o.inverse_binds; ++i) {
    const std::array<float, 16> bind{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, i == 1 ? -1.0F : 0.0F, 0, 1};
    binds.insert(binds.end(), bind.begin(), bind.end());
  }
  const int inverse_binds = b.accessor(binds, "MAT4");
  const int times = b.accessor(o.key_times, "SCALAR");
  const int turns = b.accessor<float>({0, 0, 0, 1, 0, 0, 0.70710678F, 0.70710678F}, "VEC4");
  const std::string second =
      o.second_set ? fmt::format(R"(,"JOINTS_1":{},"WEIGHTS_1":{})", joints, weights) : "";
  return b.text(fmt::format(
      R"("scene":0,"scenes":[{{"name":"all","nodes":[0,1]}},{{"name":"bones","nodes":[1]}}],
"nodes":[{{"mesh":0,"skin":0{}}},{{"name":"lower","children":[2]}},{{"name":"upper","translation":[0,1,0],"children":[3]}},{{"camera":0,"translation":[0,0,5]}}],
"cameras":[{{"name":"rider","type":"perspective","perspective":{{"yfov":1,"znear":0.1}}}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":{},"NORMAL":{},"JOINTS_0":{},"WEIGHTS_0":{}{}}},"indices":{},"material":0}}]}}],
"materials":[{{"doubleSided":true}}],
"skins":[{{"joints":{},"inverseBindMatrices":{}}}],
"animations":[{{"name":"bend","samplers":[{{"input":{},"output":{},"interpolation":"{}"}}],"channels":[{{"sampler":0,"target":{{"node":2,"path":"rotation"}}}}]}}])",
      o.node_of_mesh, positions, normals, joints, weights, second, indices, o.joints, inverse_binds, times,
      turns, o.interpolation));
}

std::string morph_gltf(int targets, const std::string& weights) {
  GltfBuilder b;
  const int positions = b.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, "VEC3");
  const int normals = b.accessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  const int bend = b.accessor<float>({1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");
  const int indices = b.accessor<std::uint8_t>({0, 1, 2, 2, 1, 3}, "SCALAR");
  std::string list;
  for (int t = 0; t < targets; ++t) {
    std::vector<float> moved(12);
    for (std::size_t v = 0; v < 4; ++v) moved[3 * v + static_cast<std::size_t>(t % 3)] = 1;
    list +=
        fmt::format(R"({}{{"POSITION":{},"NORMAL":{}}})", t == 0 ? "" : ",", b.accessor(moved, "VEC3"), bend);
  }
  const int times = b.accessor<float>({0, 2}, "SCALAR");
  std::vector<float> values(static_cast<std::size_t>(2 * targets));
  for (int t = 0; t < targets; ++t) values[static_cast<std::size_t>(targets + t)] = 1;
  const int outputs = b.accessor(values, "SCALAR");
  return b.text(fmt::format(
      R"("scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
"meshes":[{{"weights":{},"primitives":[{{"attributes":{{"POSITION":{},"NORMAL":{}}},"indices":{},"targets":[{}]}}]}}],
"animations":[{{"samplers":[{{"input":{},"output":{}}}],"channels":[{{"sampler":0,"target":{{"node":0,"path":"weights"}}}}]}}])",
      weights, positions, normals, indices, list, times, outputs));
}

}  // namespace quadrille::scenes
