#include "scenes/material/frame_block.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include <glm/geometric.hpp>

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

std::vector<Light> frame_lights(const PlacedScene& scene, const View& view, float exposure) {
  std::vector<Light> lights = scene.at.lights;
  if (lights.empty()) lights.push_back(key_light(view));
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
  std::vector<std::byte> bytes(sizeof(head) + blocks.size() * sizeof(LightBlock));
  std::memcpy(bytes.data(), &head, sizeof(head));
  std::memcpy(bytes.data() + sizeof(head), blocks.data(), blocks.size() * sizeof(LightBlock));
  return bytes;
}

std::vector<std::string> frame_defines(const View& view, const std::vector<Light>& lights) {
  std::vector<std::string> defines{
      fmt::format("LIGHTS {}", lights.size()),
      fmt::format("DIRECTIONAL_LIGHTS {}", count(lights, Light::Kind::kDirectional)),
      fmt::format("POINT_LIGHTS {}", count(lights, Light::Kind::kPoint)),
      fmt::format("SPOT_LIGHTS {}", count(lights, Light::Kind::kSpot)),
      lights.size() <= kMaxUnrolledLights ? "LOOP_HINT [[unroll]]" : "LOOP_HINT"};
  if (view.orthographic) defines.emplace_back("ORTHOGRAPHIC");
  return defines;
}

}  // namespace quadrille::scenes
