#include "scenes/passes/sunlight.h"

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_double4x4.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/ext/vector_double3.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "models/base/error.h"
#include "scenes/passes/passes.h"

namespace quadrille::scenes {
namespace {

constexpr glm::dvec3 kTowardSun{-0.75, 0.7, -0.15};

constexpr std::string_view kSurfaceVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 color;
layout(location = 0) out vec3 world;
layout(location = 1) out vec3 facing;
layout(location = 2) out vec3 albedo;
void main() {
  vec4 at = draw.model * vec4(position, 1.0);
  world = at.xyz;
  facing = mat3(draw.model) * normal;
  albedo = color.rgb;
  gl_Position = frame.view_projection * at;
}
)";
constexpr std::string_view kToneFragment = R"(
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 result;
layout(set = 1, binding = 0) uniform sampler2D radiance;
vec3 glare(vec2 at) { return max(textureLod(radiance, at, 0.0).rgb - 1.0, vec3(0.0)); }
void main() {
  vec2 texel = 1.0 / vec2(textureSize(radiance, 0));
  vec3 sum = vec3(0.0);
  for (int i = 1; i <= 4; ++i) {
    vec2 far = texel * float(2 * i);
    sum += (glare(uv + vec2(far.x, far.y)) + glare(uv - vec2(far.x, far.y)) +
            glare(uv + vec2(far.x, -far.y)) + glare(uv - vec2(far.x, -far.y))) / float(4 + 4 * i);
  }
  vec3 c = textureLod(radiance, uv, 0.0).rgb + 0.5 * sum;
  c = c * (1.0 + c * 0.16) / (1.0 + c);
  vec2 rim = uv - 0.5;
  result = vec4(c * (1.1 - 0.5 * dot(rim, rim)), 1.0);
}
)";

}  // namespace

PassFrame sunlit_frame(const SceneData& scene, const View& view) {
  const Bounds bounds = scene.bounds();
  const double radius = bounds.radius();
  const glm::dvec3 centre(bounds.center()), toward = glm::normalize(kTowardSun);
  const glm::dmat4 look = glm::lookAtRH(centre + 2 * radius * toward, centre, glm::dvec3(0, 1, 0));
  PassFrame frame;
  frame.light = glm::mat4(glm::orthoRH_ZO(-radius, radius, -radius, radius, radius, 3 * radius) * look);
  frame.view_projection = view.view_projection;
  frame.inverse_view_projection = glm::mat4(glm::inverse(glm::dmat4(view.view_projection)));
  frame.eye = glm::vec4(view.eye, 1);
  frame.right = glm::vec4(view.right, 0);
  frame.up = glm::vec4(view.up, 0);
  frame.sun = glm::vec4(glm::vec3(toward), 0);
  return frame;
}

void draw_surfaces(PassRecorder& recorder, const std::string& name, std::string_view fragment,
                   traces::Index textures) {
  const PassStreams streams{Semantic::kPosition, Semantic::kNormal, Semantic::kColor};
  traces::Pipeline pipeline = recorder.scene_pipeline(name, streams, kSurfaceVertex, fragment);
  pipeline.cull = traces::CullMode::kBack;
  recorder.draw_scene(recorder.add(std::move(pipeline)), streams, textures);
}

traces::BeginPass cleared_pass(const SceneData& scene, traces::Index colors, traces::Index depth) {
  traces::BeginPass pass;
  pass.colors.emplace_back();
  pass.colors[0].image = colors;
  pass.colors[0].clear = {scene.background.r, scene.background.g, scene.background.b, 1};
  pass.depth.image = depth;
  pass.depth.store = traces::StoreOp::kDiscard;
  return pass;
}

void add_tone_pass(PassRecorder& recorder, traces::Index radiance, const SceneOptions& options) {
  const traces::Index picture =
      recorder.attachment("picture", options.color_format, options.width, options.height);
  const traces::Index tones = recorder.add(recorder.screen_pipeline("tones", kToneFragment));
  const traces::Index set = recorder.textures({radiance});
  traces::BeginPass pass;
  pass.colors.emplace_back();
  pass.colors[0].image = picture;
  pass.colors[0].load = traces::LoadOp::kDontCare;  // every pixel is drawn
  recorder.begin(pass);
  recorder.draw_screen(tones, set, "tones");
  recorder.end();
}

void refuse_other_pictures(const SceneData& scene, const SceneOptions& options) {
  const auto refuse = [&](const char* what) {
    throw user_error("{}: draws passes of its own; {} is not for it", scene.name, what);
  };
  if (options.visibility) refuse("a picture of its triangles");
  if (options.shading != Shading::kPbr) refuse("--shading");
  if (options.order != DrawOrder::kFile) refuse("--order");
  if (options.transparency.mode != models::Transparency::kNone) refuse("--transparency");
  if (options.shown != Showing::kColors) refuse("--view");
  if (!options.environment.empty()) refuse("--environment");
  if (options.alpha_to_coverage) refuse("--alpha-to-coverage");
  if (!options.vertex_shader.empty() || !options.fragment_shader.empty()) refuse("a shader of yours");
}

}  // namespace quadrille::scenes
