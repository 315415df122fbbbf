/// The stage of the frames of several passes: a floor with a ring of columns around a pedestal, steps, balls
/// and rings, each vertex with its colour.
#include "scenes/builtin/builtin.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <glm/ext/matrix_transform.hpp>

#include "scenes/builtin/mesh_builder.h"

namespace quadrille::scenes {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr int kColumns = 12, kBalls = 6;
constexpr float kRingRadius = 4.2F;  // metres
constexpr Streams kStreams{.normal = true, .tangent = false, .uv = false, .color = true};

/// (cos, sin) of a part of a turn, in double and rounded once.
glm::vec2 around(double turns) {
  return {static_cast<float>(std::cos(kTurn * turns)), static_cast<float>(std::sin(kTurn * turns))};
}

/// A body of revolution about y: radius and height by v, from the top down.
template <class Profile>
void turned(MeshBuilder& mesh, std::uint32_t around_y, std::uint32_t along, const glm::vec4& color,
            const Profile& profile) {
  mesh.patch(around_y, along, [&](float u, float v) {
    const glm::vec2 at = around(-static_cast<double>(u));
    const glm::vec2 p = profile(v);
    return PatchPoint{{p.x * at.x, p.y, p.x * at.y}, {u, v}, color};
  });
}

std::uint32_t ball(SceneData& scene, const std::string& name, float radius, const glm::vec4& color) {
  MeshBuilder mesh;
  turned(mesh, 32, 16, color, [&](float v) { return radius * glm::vec2(around(0.25 - 0.5 * v)); });
  return mesh.finish(scene, name, 0, kStreams);
}

std::uint32_t ring(SceneData& scene, float radius, float thickness, const glm::vec4& color) {
  MeshBuilder mesh;
  turned(mesh, 64, 24, color, [&](float v) {
    const glm::vec2 at = around(-static_cast<double>(v));
    return glm::vec2(radius + thickness * at.x, thickness * at.y);
  });
  return mesh.finish(scene, "ring", 0, kStreams);
}

std::uint32_t column(SceneData& scene) {
  constexpr float kHeight = 3;
  MeshBuilder mesh;
  const glm::vec4 stone(0.78F, 0.74F, 0.66F, 1);
  turned(mesh, 32, 8, stone,
         [](float v) { return glm::vec2(0.24F + 0.06F * v, 0.25F + (kHeight - 0.5F) * (1 - v)); });
  mesh.box({-0.42F, 0, -0.42F}, {0.42F, 0.25F, 0.42F}, 1, stone);
  mesh.box({-0.4F, kHeight - 0.25F, -0.4F}, {0.4F, kHeight, 0.4F}, 1, stone);
  return mesh.finish(scene, "column", 0, kStreams);
}

/// Squares of two colours, each of its own corners.
std::uint32_t floor(SceneData& scene) {
  constexpr int kSquares = 14;
  constexpr float kHalf = 7;
  MeshBuilder mesh;
  for (int z = 0; z < kSquares; ++z) {
    for (int x = 0; x < kSquares; ++x) {
      const glm::vec3 low(-kHalf + static_cast<float>(x), 0, -kHalf + static_cast<float>(z));
      const glm::vec4 color =
          (x + z) % 2 == 0 ? glm::vec4(0.62F, 0.56F, 0.48F, 1) : glm::vec4(0.25F, 0.22F, 0.22F, 1);
      mesh.patch(1, 1, [&](float u, float v) { return PatchPoint{low + glm::vec3(u, 0, v), {u, v}, color}; });
    }
  }
  return mesh.finish(scene, "floor", 0, kStreams);
}

std::uint32_t pedestal(SceneData& scene) {
  MeshBuilder mesh;
  const glm::vec4 stone(0.55F, 0.51F, 0.46F, 1);
  for (int step = 0; step < 3; ++step) {
    const float half = 1.6F - 0.35F * static_cast<float>(step), low = 0.2F * static_cast<float>(step);
    mesh.box({-half, low, -half}, {half, low + 0.2F, half}, 1, stone);
  }
  return mesh.finish(scene, "pedestal", 0, kStreams);
}

}  // namespace

SceneData build_rotunda() {
  SceneData scene;
  scene.materials.emplace_back();
  place(scene, floor(scene));
  place(scene, pedestal(scene));
  const std::uint32_t pillar = column(scene);
  for (int i = 0; i < kColumns; ++i) {
    const glm::vec2 at = kRingRadius * around(static_cast<double>(i) / kColumns);
    place(scene, pillar, glm::translate(glm::mat4(1), {at.x, 0, at.y}));
  }
  const glm::mat4 above = glm::translate(glm::mat4(1), {0, 1.5F, 0});
  place(scene, ball(scene, "globe", 0.6F, {0.85F, 0.72F, 0.31F, 1}), above);
  place(scene, ring(scene, 0.95F, 0.08F, {0.71F, 0.2F, 0.15F, 1}), above);
  for (int i = 0; i < kBalls; ++i) {
    const double turns = (i + 0.5) / kBalls;
    const glm::vec2 at = 2.6F * around(turns);
    const glm::vec2 tint = around(turns);
    const glm::vec4 color(0.5F + 0.35F * tint.x, 0.45F + 0.25F * tint.y, 0.5F - 0.3F * tint.x, 1);
    place(scene, ball(scene, fmt::format("ball {}", i), 0.35F, color),
          glm::translate(glm::mat4(1), {at.x, 0.35F, at.y}));
  }
  scene.background = {0.45F, 0.6F, 0.85F};
  return scene;
}

}  // namespace quadrille::scenes
