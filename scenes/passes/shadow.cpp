/// A frame with a shadow map.
#include <glm/geometric.hpp>

#include "models/base/error.h"
#include "scenes/passes/pass_recorder.h"
#include "scenes/passes/passes.h"
#include "scenes/passes/sunlight.h"

namespace quadrille::scenes {
namespace {

constexpr std::uint32_t kMapSide = 1024;

constexpr std::string_view kMapVertex = R"(
layout(location = 0) in vec3 position;
void main() { gl_Position = frame.light * (draw.model * vec4(position, 1.0)); }
)";
constexpr std::string_view kMapFragment = R"(
void main() {}
)";
/// The mean over nine texels around the place: 1 where the sun sees nothing nearer than it, falling to 0 over
/// some centimetres.
constexpr std::string_view kLitFragment = R"(
layout(location = 0) in vec3 world;
layout(location = 1) in vec3 facing;
layout(location = 2) in vec3 albedo;
layout(location = 0) out vec4 result;
layout(set = 1, binding = 0) uniform sampler2D map;
float sunlit(vec3 at) {
  vec2 texel = 1.0 / vec2(textureSize(map, 0));
  vec2 uv = (floor((at.xy * 0.5 + 0.5) / texel) + 0.5) * texel;
  float sum = 0.0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      sum += clamp(1.0 + 600.0 * (textureLod(map, uv + vec2(x, y) * texel, 0.0).r - at.z), 0.0, 1.0);
  return sum / 9.0;
}
void main() {
  vec3 n = normalize(facing);
  float toward = max(dot(n, frame.sun.xyz), 0.0);
  vec4 at = frame.light * vec4(world + 0.03 * n, 1.0);
  vec3 sky = mix(vec3(0.20, 0.18, 0.16), vec3(0.32, 0.40, 0.55), 0.5 + 0.5 * n.y);
  vec3 half_way = normalize(frame.sun.xyz + normalize(frame.eye.xyz - world));
  float gloss = pow(max(dot(n, half_way), 0.0), 48.0);
  float sun = toward > 0.0 ? sunlit(at.xyz) : 0.0;
  result = vec4(albedo * (sky + 2.2 * toward * sun * vec3(1.0, 0.93, 0.8)) + 1.5 * gloss * sun, 1.0);
}
)";

}  // namespace

traces::CommandStream record_shadow(const SceneData& scene, const SceneOptions& options) {
  using traces::Format;
  refuse_other_pictures(scene, options);
  PassRecorder recorder(scene, options);
  recorder.set_frame(sunlit_frame(scene, recorder.view()));

  const traces::Index map = recorder.attachment("shadow map", Format::kD32Float, kMapSide, kMapSide);
  traces::Pipeline casters =
      recorder.scene_pipeline("casters", {Semantic::kPosition}, kMapVertex, kMapFragment);
  // Only the sides away from the sun are drawn, so that what it reaches lies before its own depths. The sun's
  // clip space has y up, which turns fronts over.
  casters.cull = traces::CullMode::kBack;
  // A little toward the sun, so that no light leaks in where things touch the floor.
  casters.depth_bias = {.enable = true, .constant = -2.0F, .slope = -1.0F, .clamp = -0.0005F};
  const traces::Index casting = recorder.add(std::move(casters));
  traces::BeginPass pass;
  pass.depth.image = map;
  recorder.begin(pass);
  recorder.draw_scene(casting, {Semantic::kPosition});
  recorder.end();

  const traces::Index colors =
      recorder.attachment("radiance", Format::kR16G16B16A16Float, options.width, options.height);
  const traces::Index depth =
      recorder.attachment("depth", options.depth_format, options.width, options.height);
  const traces::Index map_set = recorder.textures({map});
  recorder.begin(cleared_pass(scene, colors, depth));
  draw_surfaces(recorder, "lit", kLitFragment, map_set);
  recorder.end();

  add_tone_pass(recorder, colors, options);
  return recorder.finish();
}

}  // namespace quadrille::scenes
