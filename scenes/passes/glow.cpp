/// A frame whose passes draw to levels and layers of one image.
#include <algorithm>
#include <bit>

#include <fmt/format.h>

#include "scenes/passes/lamps.h"
#include "scenes/passes/passes.h"
#include "scenes/passes/sunlight.h"

namespace quadrille::scenes {
namespace {

constexpr std::uint32_t kMostLevels = 8;
constexpr std::uint32_t kPicture = 0, kBright = 1;  ///< layers

/// Of a lamp itself: a disc, where nothing is before it.
constexpr std::string_view kBulbFragment = R"(
layout(location = 0) flat in vec4 reach;
layout(location = 1) flat in vec3 glow;
layout(location = 0) out vec4 result;
void main() {
  vec2 uv = gl_FragCoord.xy / vec2(textureSize(depths, 0));
  if (gl_FragCoord.z > textureLod(depths, uv, 0.0).r) discard;
  vec3 along = normalize(place(uv, 0.5) - frame.eye.xyz);
  vec3 toward = reach.xyz - frame.eye.xyz;
  float off = length(toward - along * dot(toward, along)) / (0.07 * reach.w);
  if (off > 1.0) discard;
  result = vec4(glow * 9.0 * (1.0 - off * off), 0.0);
}
)";
/// The mean of a level's texels around a place, in a tent of two texels to each side.
constexpr std::string_view kTent = R"(
vec3 tent(sampler2D from, vec2 uv) {
  vec2 texel = 1.0 / vec2(textureSize(from, 0));
  vec3 sum = 4.0 * textureLod(from, uv, 0.0).rgb;
  sum += textureLod(from, uv + vec2(texel.x, texel.y), 0.0).rgb;
  sum += textureLod(from, uv + vec2(-texel.x, texel.y), 0.0).rgb;
  sum += textureLod(from, uv + vec2(texel.x, -texel.y), 0.0).rgb;
  sum += textureLod(from, uv - vec2(texel.x, texel.y), 0.0).rgb;
  return sum / 8.0;
}
)";
/// The first level of what is bright comes from the picture.
constexpr std::string_view kFirstFragment = R"(
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 picture;
layout(location = 1) out vec4 bright;
layout(set = 1, binding = 0) uniform sampler2D above;
void main() {
  vec3 mean = tent(above, uv);
  picture = vec4(mean, 1.0);
  bright = vec4(max(mean - 0.8, vec3(0.0)), 1.0);
}
)";
constexpr std::string_view kNextFragment = R"(
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 picture;
layout(location = 1) out vec4 bright;
layout(set = 1, binding = 0) uniform sampler2D above;
layout(set = 1, binding = 1) uniform sampler2D bright_above;
void main() {
  picture = vec4(tent(above, uv), 1.0);
  bright = vec4(tent(bright_above, uv), 1.0);
}
)";
/// What is nearer or farther than the middle of the scene is seen through coarser levels; each level of what
/// is bright adds its glow.
constexpr std::string_view kLensFragment = R"(
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 result;
layout(set = 1, binding = 0) uniform sampler2D picture;
layout(set = 1, binding = 1) uniform sampler2D bright;
layout(set = 1, binding = 2) uniform sampler2D depths;
const vec2 ring[4] = vec2[](vec2(1.0, 0.0), vec2(0.7, 0.7), vec2(0.0, 1.0), vec2(-0.7, 0.7));
vec3 blurred(float level) {
  vec2 radius = 0.9 * exp2(level) / vec2(textureSize(picture, 0));
  float finer = max(level - 1.0, 0.0);
  vec3 sum = 2.0 * textureLod(picture, uv, finer).rgb;
  for (int i = 0; i < 4; ++i)
    sum += textureLod(picture, uv + radius * ring[i], finer).rgb +
           textureLod(picture, uv - radius * ring[i], finer).rgb;
  return sum / 10.0;
}
void main() {
  vec4 p = frame.inverse_view_projection * vec4(uv * 2.0 - 1.0, textureLod(depths, uv, 0.0).r, 1.0);
  float far = length(p.xyz / p.w - frame.eye.xyz), focus = 0.93 * length(frame.eye.xyz);
  float level = clamp(9.0 * abs(1.0 - focus / far) - 0.7, 0.0, 3.5);
  vec3 c = blurred(level);
  vec3 glow = vec3(0.0);
  for (int i = 0; i < 7; ++i) glow += textureLod(bright, uv, float(i)).rgb;
  c += 0.12 * glow;
  c = c * (1.0 + c * 0.16) / (1.0 + c);
  vec2 rim = uv - 0.5;
  result = vec4(c * (1.1 - 0.5 * dot(rim, rim)), 1.0);
}
)";

/// Records the passes on the image of levels and layers.
class GlowRecorder {
 public:
  GlowRecorder(const SceneData& scene, const SceneOptions& options)
      : scene_(scene), options_(options), recorder_(scene, options) {}

  traces::CommandStream record() {
    recorder_.set_frame(sunlit_frame(scene_, recorder_.view()));
    surfaces_ = draw_lit_surfaces(recorder_, options_);
    add_image();
    draw_finest();
    for (std::uint32_t level = 1; level < levels_; ++level) draw_level(level);
    draw_picture();
    return recorder_.finish();
  }

 private:
  /// Of two levels at least.
  void add_image() {
    const std::uint32_t width = std::max(2u, options_.width), height = std::max(2u, options_.height);
    image_ = recorder_.attachment("levels", traces::Format::kR16G16B16A16Float, width, height);
    levels_ = std::min(kMostLevels, static_cast<std::uint32_t>(std::bit_width(std::max(width, height))));
    recorder_.stream().images[image_].levels = levels_;
    recorder_.stream().images[image_].layers = 2;
    traces::Sampler smooth;
    smooth.wrap_u = smooth.wrap_v = traces::Wrap::kClampToEdge;
    recorder_.stream().samplers.push_back(smooth);
    smooth_ = static_cast<traces::Index>(recorder_.stream().samplers.size() - 1);
  }

  [[nodiscard]] traces::ColorAttachmentUse use(std::uint32_t level, std::uint32_t layer) const {
    traces::ColorAttachmentUse use;
    use.image = image_;
    use.load = traces::LoadOp::kDontCare;  // every pixel is drawn
    use.level = level;
    use.layer = layer;
    return use;
  }
  /// A texture of set 1.
  [[nodiscard]] traces::TextureDescriptor view(std::uint32_t binding, std::uint32_t layer,
                                               std::uint32_t first, std::uint32_t levels) const {
    return {binding, image_, smooth_, first, levels, layer};
  }
  traces::Index add_set(std::vector<traces::TextureDescriptor> textures) {
    traces::DescriptorSet set;
    set.textures = std::move(textures);
    recorder_.stream().descriptor_sets.push_back(std::move(set));
    return static_cast<traces::Index>(recorder_.stream().descriptor_sets.size() - 1);
  }
  traces::Index screen(const std::string& name, std::string_view fragment) {
    return recorder_.add(recorder_.screen_pipeline(name, std::string(kTent) + std::string(fragment)));
  }

  void draw_finest() {
    const traces::Index bulbs = recorder_.add(lamp_pipeline(recorder_, "bulbs", 0.08, kBulbFragment));
    traces::BeginPass pass;
    pass.colors = {use(0, kPicture)};
    recorder_.begin(pass);
    draw_radiance(recorder_, surfaces_.set);
    draw_lamps(recorder_, bulbs, surfaces_.set, "bulbs");
    recorder_.end();
  }

  /// Both layers of a level, each from its level above.
  void draw_level(std::uint32_t level) {
    std::vector<traces::TextureDescriptor> above{view(0, kPicture, level - 1, 1)};
    if (level > 1) above.push_back(view(1, kBright, level - 1, 1));
    if (level <= 2)
      down_ = level == 1 ? screen("first level", kFirstFragment) : screen("level", kNextFragment);
    const traces::Index set = add_set(std::move(above));
    traces::BeginPass pass;
    pass.colors = {use(level, kPicture), use(level, kBright)};
    recorder_.begin(pass);
    recorder_.draw_screen(down_, set, fmt::format("level {}", level));
    recorder_.end();
  }

  void draw_picture() {
    const traces::Index lens = recorder_.add(recorder_.screen_pipeline("lens", kLensFragment));
    // Nothing was drawn to the finest level of what is bright.
    const traces::Index set =
        add_set({view(0, kPicture, 0, 0), view(1, kBright, 1, 0), {2, surfaces_.depths, 0}});
    traces::BeginPass pass;
    pass.colors.resize(1);
    pass.colors[0].image =
        recorder_.attachment("picture", options_.color_format, options_.width, options_.height);
    pass.colors[0].load = traces::LoadOp::kDontCare;
    recorder_.begin(pass);
    recorder_.draw_screen(lens, set, "lens");
    recorder_.end();
  }

  const SceneData& scene_;
  const SceneOptions& options_;
  PassRecorder recorder_;
  LitSurfaces surfaces_;
  traces::Index image_ = traces::kNone, smooth_ = traces::kNone, down_ = traces::kNone;
  std::uint32_t levels_ = 1;
};

}  // namespace

traces::CommandStream record_glow(const SceneData& scene, const SceneOptions& options) {
  refuse_other_pictures(scene, options);
  return GlowRecorder(scene, options).record();
}

}  // namespace quadrille::scenes
