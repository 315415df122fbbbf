#include "scenes/material/frame_block.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include <glm/ext/matrix_double4x4.hpp>
#include <glm/ext/vector_double4.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "models/base/error.h"
#include "scenes/view/exposure.h"

namespace quadrille::scenes {
namespace {

constexpr std::size_t kMaxLights = 256;
constexpr std::size_t kMaxUnrolledLights = 4;
// the sky's share where the file brings its own lights [G: shadows stay readable]
constexpr float kSkyBesideLights = 0.35F;

/// `Light` of interface.glsl, std140.
struct LightBlock {
  glm::vec4 position{0}, direction{0}, color{0}, cone{0};
};
static_assert(sizeof(LightBlock) == 64);

struct FrameHead {
  glm::mat4 view_projection;
  glm::vec4 eye, toward_viewer, sky, ground;
};
static_assert(sizeof(FrameHead) == 128);

struct EnvironmentBlock {
  std::array<glm::vec4, 9> irradiance;
  std::array<glm::vec4, 3> turn, ways;
  glm::vec4 range;
};
static_assert(sizeof(EnvironmentBlock) == 256);

/// The direction, of any length, in the middle of the picture, and what a half width adds to the right and a
/// half height downwards: of the points where the far plane, which may be at infinity, has its corners.
std::array<glm::vec4, 3> background_ways(const View& view) {
  if (view.orthographic) return {glm::vec4(-view.toward_viewer, 0), glm::vec4(0), glm::vec4(0)};
  const glm::dmat4 to_world = glm::inverse(glm::dmat4(view.view_projection));
  std::array<glm::dvec3, 3> ways{};
  for (int i = 0; i < 3; ++i) {
    const glm::dvec4 h = to_world[i] + (i == 2 ? to_world[3] : glm::dvec4(0));
    ways[static_cast<std::size_t>(i)] = glm::dvec3(h) - h.w * glm::dvec3(view.eye);
  }
  const double length = glm::length(ways[2]);
  const auto packed = [&](std::size_t i) { return glm::vec4(ways[i] / length, 0); };
  return {packed(2), packed(0), packed(1)};
}

/// From the camera's upper left, warm.
Light key_light(const View& view) {
  Light light;
  light.color = glm::vec3(1.0F, 0.965F, 0.91F) * kKeyLux;
  light.direction = -glm::normalize(-0.45F * view.right + 0.75F * view.up + 0.65F * view.toward_viewer);
  return light;
}

LightBlock light_block(const Light& light, const View& view) {
  LightBlock block;
  block.position = glm::vec4(glm::vec3(light.position) - view.eye, light.range > 0 ? 1 / light.range : 0.0F);
  block.direction = glm::vec4(-light.direction, 0);
  block.color = glm::vec4(light.color * std::numbers::inv_pi_v<float>, 0);
  if (light.kind == Light::Kind::kSpot) {
    // Linear in the cosine between the two cones. [KHR_lights_punctual, inner and outer cone angles]
    const double outer = std::cos(static_cast<double>(light.outer_cone)),
                 inner = std::cos(static_cast<double>(light.inner_cone));
    const double scale = 1 / std::max(1e-3, inner - outer);
    block.cone = glm::vec4(static_cast<float>(scale), static_cast<float>(-outer * scale), 0, 0);
  }
  return block;
}

std::size_t count(const std::vector<Light>& lights, Light::Kind kind) {
  return static_cast<std::size_t>(std::ranges::count(lights, kind, &Light::kind));
}

}  // namespace

std::vector<Light> frame_lights(const PlacedScene& scene, const View& view, float exposure,
                                const EnvironmentMap* map) {
  std::vector<Light> lights = scene.at.lights;
  if (map != nullptr && map->sun) lights.push_back(*map->sun);
  if (map == nullptr && lights.empty()) lights.push_back(key_light(view));
  if (scene.at.lights.size() > kMaxLights)
    throw user_error("{}: {} lights; at most {} are supported", scene.data.name, scene.at.lights.size(),
                     kMaxLights);
  for (Light& light : lights) light.color = exposed(light.color, exposure);
  std::ranges::stable_sort(lights, {}, &Light::kind);
  return lights;
}

std::vector<std::byte> frame_block(const SceneData& scene, const View& view, const std::vector<Light>& lights,
                                   float exposure, const std::optional<DepthRange>& depths) {
  const float black =
      depths && depths->farthest > depths->nearest ? 1 / (depths->farthest - depths->nearest) : 0;
  const float share = scene.lights.empty() ? exposure : kSkyBesideLights;
  const FrameHead head{view.view_projection, glm::vec4(view.eye, depths ? depths->nearest : 0.0F),
                       glm::vec4(view.toward_viewer, black), glm::vec4(scene.environment.sky * share, 0),
                       glm::vec4(scene.environment.ground * share, 0)};
  std::vector<LightBlock> blocks;
  blocks.reserve(lights.size());
  for (const Light& light : lights) blocks.push_back(light_block(light, view));
  if (blocks.empty()) blocks.emplace_back();  // the shader's array has one at least
  std::vector<std::byte> bytes(sizeof(head) + blocks.size() * sizeof(LightBlock));
  std::memcpy(bytes.data(), &head, sizeof(head));
  std::memcpy(bytes.data() + sizeof(head), blocks.data(), blocks.size() * sizeof(LightBlock));
  return bytes;
}

std::vector<std::byte> environment_block(const EnvironmentMap& map, const View& view, float exposure) {
  EnvironmentBlock block{
      {}, {}, background_ways(view), {map.scale * exposure, static_cast<float>(map.levels - 1), 0, 0}};
  for (std::size_t i = 0; i < block.irradiance.size(); ++i)
    block.irradiance[i] = glm::vec4(map.irradiance[i] * exposure, 0);
  for (int row = 0; row < 3; ++row)
    block.turn[static_cast<std::size_t>(row)] =
        glm::vec4(map.turn[0][row], map.turn[1][row], map.turn[2][row], 0);
  std::vector<std::byte> bytes(sizeof(block));
  std::memcpy(bytes.data(), &block, sizeof(block));
  return bytes;
}

std::vector<std::string> frame_defines(const View& view, const std::vector<Light>& lights,
                                       const EnvironmentMap* map) {
  std::vector<std::string> defines{
      fmt::format("LIGHTS {}", std::max<std::size_t>(lights.size(), 1)),
      fmt::format("DIRECTIONAL_LIGHTS {}", count(lights, Light::Kind::kDirectional)),
      fmt::format("POINT_LIGHTS {}", count(lights, Light::Kind::kPoint)),
      fmt::format("SPOT_LIGHTS {}", count(lights, Light::Kind::kSpot)),
      lights.size() <= kMaxUnrolledLights ? "LOOP_HINT [[unroll]]" : "LOOP_HINT"};
  if (view.orthographic) defines.emplace_back("ORTHOGRAPHIC");
  if (map != nullptr) defines.emplace_back("ENVIRONMENT");
  if (map != nullptr && map->turn != glm::mat3(1)) defines.emplace_back("ENVIRONMENT_TURNED");
  return defines;
}

}  // namespace quadrille::scenes
