/// A flag in the wind: a cloth on a chain of joints that a wave runs along, with two morph targets that
/// ripple it. Small, and posed by the vertex shader.
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include <glm/ext/matrix_double4x4.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/matrix.hpp>

#include "scenes/builtin/builtin.h"
#include "scenes/builtin/mesh_builder.h"
#include "scenes/builtin/procedural_texture.h"

namespace quadrille::scenes {
namespace {

constexpr int kJoints = 25, kColumns = 72, kRows = 40;
// metres: of the cloth, and where its lower edge is
constexpr float kLength = 3, kHeight = 1.9F, kFoot = 2.4F;
constexpr double kTurn = 2 * std::numbers::pi;

template <class T>
int add_array(SceneData& scene, const char* name, traces::Format format, const std::vector<T>& values) {
  Array array{name, format, static_cast<std::uint32_t>(values.size()),
              std::vector<std::byte>(values.size() * sizeof(T))};
  std::memcpy(array.data.data(), values.data(), array.data.size());
  scene.arrays.push_back(std::move(array));
  return static_cast<int>(scene.arrays.size() - 1);
}

/// Rows of the cloth's grid as `MeshBuilder::patch` numbers its vertices.
template <class Visit>
void for_each_point(const Visit& visit) {
  for (int row = 0; row <= kRows; ++row) {
    for (int column = 0; column <= kColumns; ++column)
      visit(static_cast<float>(column) / kColumns, static_cast<float>(row) / kRows);
  }
}

/// A ripple across the cloth, larger toward its free end; `phase` sets the two targets a quarter apart, so
/// that their weights can move it along.
MorphTarget ripple(SceneData& scene, double phase) {
  std::vector<glm::vec3> positions, normals;
  for_each_point([&](float u, float v) {
    const double place = kTurn * (2.2 * static_cast<double>(v) + 0.8 * static_cast<double>(u) + phase);
    const double height = 0.05 * static_cast<double>(u), slope = height * std::cos(place) * kTurn;
    positions.emplace_back(0, 0, static_cast<float>(height * std::sin(place)));
    normals.emplace_back(static_cast<float>(-0.8 / static_cast<double>(kLength) * slope),
                         static_cast<float>(2.2 / static_cast<double>(kHeight) * slope), 0);
  });
  MorphTarget target;
  for (const glm::vec3& p : positions) target.reach.add(p);
  target.deltas[static_cast<std::size_t>(Semantic::kPosition)] =
      add_array(scene, "ripple.position", traces::Format::kR32G32B32Float, positions);
  target.deltas[static_cast<std::size_t>(Semantic::kNormal)] =
      add_array(scene, "ripple.normal", traces::Format::kR32G32B32Float, normals);
  return target;
}

/// Each point hangs between the two joints beside it.
void add_joints(SceneData& scene, Primitive& cloth) {
  std::vector<std::array<std::uint8_t, 4>> joints;
  std::vector<glm::vec4> weights;
  cloth.joint_boxes.resize(kJoints);
  for_each_point([&](float u, float v) {
    const float place = u * (kJoints - 1);
    const int joint = std::min(static_cast<int>(place), kJoints - 2);
    const float part = place - static_cast<float>(joint);
    joints.push_back({static_cast<std::uint8_t>(joint), static_cast<std::uint8_t>(joint + 1), 0, 0});
    weights.emplace_back(1 - part, part, 0, 0);
    for (const int j : {joint, joint + 1})
      cloth.joint_boxes[static_cast<std::size_t>(j)].add(
          glm::vec3(u * kLength, kFoot + kHeight * (1 - v), 0));
  });
  cloth.joint_sets[0] = {add_array(scene, "flag.joints", traces::Format::kR8G8B8A8Uint, joints),
                         add_array(scene, "flag.weights", traces::Format::kR32G32B32A32Float, weights)};
}

/// Every joint turns about the pole's axis as a wave that runs to the free end has it, and a little downward.
std::vector<JointMatrix> joints_at(double turns) {
  std::vector<JointMatrix> joints;
  const double part = static_cast<double>(kLength) / (kJoints - 1);
  glm::dmat4 chain(1);
  for (int j = 0; j < kJoints; ++j) {
    const double along = static_cast<double>(j) / (kJoints - 1);
    const double bend = 0.26 * std::sqrt(along) * std::cos(kTurn * (1.4 * along - turns));
    if (j > 0) chain = glm::translate(chain, glm::dvec3(part, 0, 0));
    chain = glm::rotate(chain, bend, glm::dvec3(0, 1, 0));
    chain = glm::rotate(chain, -0.006 - 0.004 * std::sin(kTurn * turns), glm::dvec3(0, 0, 1));
    // A joint's place at rest is taken out; the turn of the chain is about the height where the cloth is
    // held.
    const glm::dvec3 rest(part * j, static_cast<double>(kFoot) + 0.5 * static_cast<double>(kHeight), 0);
    const glm::dmat4 moved = glm::translate(glm::dmat4(1), glm::dvec3(0, rest.y, 0)) * chain *
                             glm::translate(glm::dmat4(1), -rest);
    const glm::mat4 rows = glm::transpose(glm::mat4(moved));
    joints.push_back({rows[0], rows[1], rows[2]});
  }
  return joints;
}

Material matte(const char* name, const glm::vec4& color, float roughness, float metallic = 0) {
  Material m;
  m.name = name;
  m.base_color = color;
  m.roughness = roughness;
  m.metallic = metallic;
  return m;
}

Rgba8Image stripes() {
  return paint(256, true, [](glm::vec2 uv) {
    const float disc = glm::length((uv - glm::vec2(0.36F, 0.5F)) * glm::vec2(kLength, kHeight));
    const int band = static_cast<int>(uv.y * 5);
    const glm::vec3 ground = band % 2 == 0 ? glm::vec3(0.72F, 0.10F, 0.10F) : glm::vec3(0.86F, 0.82F, 0.74F);
    const float weave = 0.93F + 0.07F * tiling_noise({uv.x * 96, uv.y * 64}, 32, 2, 9);
    return glm::vec4(
        glm::mix(glm::vec3(0.07F, 0.16F, 0.38F), ground, smooth_ramp(0.52F, 0.55F, disc)) * weave, 1);
  });
}

}  // namespace

SceneData build_flag(double time) {
  SceneData scene;
  Material cloth_material = matte("cloth", glm::vec4(1), 0.85F);
  cloth_material.double_sided = true;
  cloth_material.texture(TextureSlot::kBaseColor).image = add_image(scene, "stripes", stripes());
  scene.materials = {cloth_material, matte("pole", {0.62F, 0.60F, 0.57F, 1}, 0.35F, 1),
                     matte("grass", {0.16F, 0.26F, 0.09F, 1}, 0.95F)};

  MeshBuilder cloth;
  cloth.patch(kColumns, kRows, [](float u, float v) {
    return PatchPoint{{u * kLength, kFoot + kHeight * (1 - v), 0}, {u, v}};
  });
  const std::uint32_t flag = cloth.finish(scene, "flag", 0, {});
  Primitive& primitive = scene.primitives[flag];
  primitive.targets = {ripple(scene, 0), ripple(scene, 0.25)};
  add_joints(scene, primitive);

  MeshBuilder pole;
  pole.patch(20, 1, [](float u, float v) {
    const double angle = kTurn * static_cast<double>(u);
    return PatchPoint{{static_cast<float>(0.06 * std::cos(angle)) - 0.06F, 4.6F * (1 - v),
                       static_cast<float>(-0.06 * std::sin(angle))},
                      {u, v}};
  });
  MeshBuilder ground;
  ground.patch(8, 8, [](float u, float v) {
    return PatchPoint{{16 * (u - 0.4F), 0, 16 * (v - 0.5F)}, {u, v}};
  });

  const double turns = time / kFlagSeconds;
  scene.poses.push_back(
      {{static_cast<float>(std::cos(kTurn * turns)), static_cast<float>(-std::sin(kTurn * turns))},
       joints_at(turns),
       false});
  scene.instances.push_back({flag, glm::mat4(1), "flag", -1, 0});
  place(scene,
        pole.finish(scene, "pole", 1, {.normal = true, .tangent = false, .uv = false, .color = false}));
  place(scene,
        ground.finish(scene, "ground", 2, {.normal = true, .tangent = false, .uv = false, .color = false}));

  Camera camera;
  camera.name = "below";
  camera.yfov = 0.72;
  camera.pose =
      glm::inverse(glm::lookAt(glm::vec3(2.4F, 1.5F, 7.6F), glm::vec3(1.35F, 2.75F, 0), glm::vec3(0, 1, 0)));
  scene.cameras.push_back(camera);
  return scene;
}

}  // namespace quadrille::scenes
