/// A frame with deferred shading.
#include <cmath>
#include <numbers>

#include <glm/vec3.hpp>

#include <fmt/format.h>

#include "scenes/passes/lamps.h"
#include "scenes/passes/passes.h"
#include "scenes/passes/sunlight.h"

namespace quadrille::scenes {

const std::string_view kSurfaceTextures = R"(
layout(set = 1, binding = 0) uniform sampler2D colors;
layout(set = 1, binding = 1) uniform sampler2D normals;
layout(set = 1, binding = 2) uniform sampler2D depths;
vec3 place(vec2 uv, float depth) {
  vec4 p = frame.inverse_view_projection * vec4(uv * 2.0 - 1.0, depth, 1.0);
  return p.xyz / p.w;
}
)";

namespace {

constexpr std::string_view kSurfaceFragment = R"(
layout(location = 1) in vec3 facing;
layout(location = 2) in vec3 albedo;
layout(location = 0) out vec4 color;
layout(location = 1) out vec4 normal;
void main() {
  color = vec4(albedo, 1.0);
  normal = vec4(0.5 + 0.5 * normalize(facing), 1.0);
}
)";
constexpr std::string_view kSkyFragment = R"(
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 result;
void main() {
  float depth = textureLod(depths, uv, 0.0).r;
  vec3 n = textureLod(normals, uv, 0.0).rgb * 2.0 - 1.0;
  vec3 sky = mix(vec3(0.06, 0.05, 0.05), vec3(0.10, 0.12, 0.20), 0.5 + 0.5 * n.y);
  vec3 lit = textureLod(colors, uv, 0.0).rgb * (sky + 0.15 * max(dot(n, frame.sun.xyz), 0.0));
  result = vec4(depth < 1.0 ? lit : vec3(0.02, 0.025, 0.05), 1.0);
}
)";
/// A square that faces the camera and holds the light's sphere.
constexpr std::string_view kLightVertex = R"(
layout(location = 0) in vec4 sphere;
layout(location = 1) in vec3 color;
layout(location = 0) flat out vec4 reach;
layout(location = 1) flat out vec3 glow;
void main() {
  vec2 corner = vec2(gl_VertexIndex == 1 || gl_VertexIndex == 2 || gl_VertexIndex == 4 ? 1.0 : -1.0,
                     gl_VertexIndex == 2 || gl_VertexIndex >= 4 ? 1.0 : -1.0);
  reach = sphere;
  glow = color;
  vec3 at = sphere.xyz + @RADIUS@ * sphere.w * (corner.x * frame.right.xyz + corner.y * frame.up.xyz);
  gl_Position = frame.view_projection * vec4(at, 1.0);
}
)";
constexpr std::string_view kLightFragment = R"(
layout(location = 0) flat in vec4 reach;
layout(location = 1) flat in vec3 glow;
layout(location = 0) out vec4 result;
void main() {
  vec2 uv = gl_FragCoord.xy / vec2(textureSize(depths, 0));
  vec3 at = place(uv, textureLod(depths, uv, 0.0).r);
  vec3 toward = reach.xyz - at;
  float far = length(toward) / reach.w;
  float falls = max(1.0 - far * far, 0.0);
  vec3 n = textureLod(normals, uv, 0.0).rgb * 2.0 - 1.0;
  float faces = max(dot(n, toward), 0.0) / max(length(toward), 0.001);
  result = vec4(textureLod(colors, uv, 0.0).rgb * glow * (faces * falls * falls), 0.0);
}
)";

}  // namespace

std::vector<LampInstance> lamps() {
  constexpr int kLamps = 48;
  constexpr double kOuter = 5.1, kInner = 2.5;  // metres
  constexpr double kTurn = 2 * std::numbers::pi;
  std::vector<LampInstance> all;
  all.reserve(kLamps);
  for (int i = 0; i < kLamps; ++i) {
    const double turns = static_cast<double>(i) / kLamps, hue = kTurn * 5 * turns;
    const double radius = i % 2 == 0 ? kOuter : kInner;
    all.push_back(
        {{static_cast<float>(radius * std::cos(kTurn * turns)), i % 2 == 0 ? 1.2F : 0.6F,
          static_cast<float>(radius * std::sin(kTurn * turns)), 1.6F},
         {static_cast<float>(1.1 + std::cos(hue)), static_cast<float>(1.1 + std::cos(hue - kTurn / 3)),
          static_cast<float>(1.1 + std::cos(hue + kTurn / 3))}});
  }
  return all;
}

traces::Pipeline lamp_pipeline(PassRecorder& recorder, const std::string& name, double radius,
                               std::string_view fragment) {
  std::string vertex(kLightVertex);
  const std::string_view mark = "@RADIUS@";
  vertex.replace(vertex.find(mark), mark.size(), fmt::format("{:.2f}", radius));
  traces::Pipeline p =
      recorder.scene_pipeline(name, {}, vertex, std::string(kSurfaceTextures) + std::string(fragment));
  p.depth = {};
  p.bindings = {{0, sizeof(LampInstance), true}};
  p.attributes = {{0, 0, traces::Format::kR32G32B32A32Float, 0},
                  {1, 0, traces::Format::kR32G32B32Float, sizeof(glm::vec4)}};
  p.blend[0].enable = true;
  p.blend[0].src_color = p.blend[0].dst_color = traces::BlendFactor::kOne;
  p.blend[0].src_alpha = p.blend[0].dst_alpha = traces::BlendFactor::kOne;
  return p;
}

void draw_lamps(PassRecorder& recorder, traces::Index pipeline, traces::Index set, const std::string& label) {
  const std::vector<LampInstance> lights = lamps();
  const traces::Index buffer = recorder.buffer(label, lights.data(), lights.size() * sizeof lights[0]);
  recorder.bind(pipeline, set);
  traces::Draw draw;
  draw.count = 6;
  draw.instances = static_cast<std::uint32_t>(lights.size());
  draw.label = label;
  recorder.stream().commands.emplace_back(traces::BindVertexBuffer{0, buffer, 0});
  recorder.stream().commands.emplace_back(draw);
}

LitSurfaces draw_lit_surfaces(PassRecorder& recorder, const SceneOptions& options) {
  using traces::Format;
  const auto attachment = [&](const char* name, Format format) {
    return recorder.attachment(name, format, options.width, options.height);
  };
  const traces::Index colors = attachment("colours", Format::kR8G8B8A8Unorm),
                      normals = attachment("normals", Format::kA2B10G10R10Unorm),
                      depths = attachment("depths", options.depth_format);
  traces::BeginPass pass;
  pass.colors.resize(2);
  pass.colors[0].image = colors;
  pass.colors[1].image = normals;
  pass.depth.image = depths;
  recorder.begin(pass);
  draw_surfaces(recorder, "surfaces", kSurfaceFragment);
  recorder.end();
  return {depths, recorder.textures({colors, normals, depths})};
}

void draw_radiance(PassRecorder& recorder, traces::Index set) {
  const traces::Index sky = recorder.add(
      recorder.screen_pipeline("sky", std::string(kSurfaceTextures) + std::string(kSkyFragment)));
  const traces::Index lights = recorder.add(lamp_pipeline(recorder, "lights", 1.25, kLightFragment));
  recorder.draw_screen(sky, set, "sky");
  draw_lamps(recorder, lights, set, "lights");
}

traces::CommandStream record_deferred(const SceneData& scene, const SceneOptions& options) {
  refuse_other_pictures(scene, options);
  PassRecorder recorder(scene, options);
  recorder.set_frame(sunlit_frame(scene, recorder.view()));
  const LitSurfaces surfaces = draw_lit_surfaces(recorder, options);
  const traces::Index radiance =
      recorder.attachment("radiance", traces::Format::kR16G16B16A16Float, options.width, options.height);
  recorder.begin(cleared_pass(scene, radiance, traces::kNone));
  draw_radiance(recorder, surfaces.set);
  recorder.end();
  add_tone_pass(recorder, radiance, options);
  return recorder.finish();
}

}  // namespace quadrille::scenes
