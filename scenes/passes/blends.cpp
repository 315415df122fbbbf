/// A test card of blending, each way in a field of its own: six columns and three rows.
///
/// The first row mixes a source with what is there in the six ways of the lectures. The second puts two
/// layers over a background, one by one and as a group that was drawn elsewhere. The third draws textures
/// with see-through parts, enlarged and reduced, both with colours as they are and multiplied by their alpha.
/// tests/pipeline/blends_test.cpp has the closed form of every field.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include <glm/packing.hpp>

#include "models/base/error.h"
#include "scenes/passes/blend_card.h"
#include "scenes/passes/pass_recorder.h"
#include "scenes/passes/passes.h"

namespace quadrille::scenes {
namespace {

using traces::BlendFactor;
using traces::BlendOp;
using traces::BlendState;

// model[0]: the field's corner in pixels, one over its side, and a choice; model[1] and model[2]: colours of
// its upper and lower edge, and alphas of its left and right one.
constexpr std::string_view kRampFragment = R"(
layout(location = 0) out vec4 result;
void main() {
  vec2 at = (gl_FragCoord.xy - draw.model[0].xy) * draw.model[0].z;
  vec3 color = mix(draw.model[1].rgb, draw.model[2].rgb, at.y);
  float alpha = mix(draw.model[1].a, draw.model[2].a, at.x);
  result = vec4(draw.model[0].w > 0.0 ? color * alpha : color, alpha);
}
)";
constexpr std::string_view kGroupFragment = R"(
layout(location = 0) out vec4 result;
layout(set = 1, binding = 0) uniform sampler2D group;
void main() {
  vec4 texel = textureLod(group, gl_FragCoord.xy / vec2(textureSize(group, 0)), 0.0);
  result = draw.model[0].w > 0.0 ? vec4(texel.rgb / max(texel.a, 1e-6), texel.a) : texel;
}
)";
constexpr std::string_view kTextureFragment = R"(
layout(location = 0) out vec4 result;
layout(set = 1, binding = 0) uniform sampler2D image;
void main() {
  result = textureLod(image, (gl_FragCoord.xy - draw.model[0].xy) * draw.model[0].z, draw.model[0].w);
}
)";

/// The same factors for colour and alpha.
BlendState blend(BlendFactor source, BlendFactor target, BlendOp op = BlendOp::kAdd) {
  return {true, source, target, source, target, op, op, 0xf};
}
/// Colours that are not multiplied by their alpha; alpha itself is.
BlendState straight_over() {
  BlendState state = blend(BlendFactor::kSrcAlpha, BlendFactor::kOneMinusSrcAlpha);
  state.src_alpha = BlendFactor::kOne;
  return state;
}
BlendState premultiplied_over() { return blend(BlendFactor::kOne, BlendFactor::kOneMinusSrcAlpha); }
/// Front to back: what is there lies over what comes.
BlendState premultiplied_under() { return blend(BlendFactor::kOneMinusDstAlpha, BlendFactor::kOne); }

/// Constants of a draw, as the shaders see them.
struct Constants {
  glm::vec4 place{0}, from{0}, to{0}, unused{0};
};

class Card {
 public:
  Card(PassRecorder& recorder, const BlendCard& card)
      : recorder_(recorder),
        card_(card),
        ramp_(recorder.screen_pipeline("ramp", kRampFragment)),
        group_(recorder.screen_pipeline("group", kGroupFragment)),
        texture_(recorder.screen_pipeline("texture", kTextureFragment)) {}

  void ramp(int field, const Ramp& ramp, const BlendState& state, bool premultiplied = false) {
    draw(field, ramp_, state, traces::kNone,
         {glm::vec4(0, 0, 0, premultiplied ? 1 : 0), glm::vec4(ramp.top, ramp.left),
          glm::vec4(ramp.bottom, ramp.right)});
  }
  void background(int field) { ramp(field, BlendCard::kBackground, {}); }
  /// What an earlier pass drew in the same place; `divided` by its alpha.
  void group(int field, traces::Index image, const BlendState& state, bool divided = false) {
    draw(field, group_, state, image, {glm::vec4(0, 0, 0, divided ? 1 : 0)});
  }
  void texture(int field, traces::Index set, float level, const BlendState& state) {
    draw(field, texture_, state, set, {glm::vec4(0, 0, 0, level)});
  }

 private:
  void draw(int field, const traces::Pipeline& program, const BlendState& state, traces::Index set,
            Constants constants) {
    const BlendCard::Place place = card_.place(field);
    constants.place.x = static_cast<float>(place.x);
    constants.place.y = static_cast<float>(place.y);
    constants.place.z = 1.0F / static_cast<float>(card_.side());
    std::vector<std::byte> bytes(sizeof constants);
    std::memcpy(bytes.data(), &constants, sizeof constants);
    traces::Pipeline pipeline = program;
    pipeline.name = std::string(BlendCard::name(field)) + ": " + program.name;
    pipeline.blend[0] = state;
    recorder_.stream().commands.emplace_back(traces::SetScissor{place.x, place.y,
                                                                static_cast<std::uint32_t>(card_.side()),
                                                                static_cast<std::uint32_t>(card_.side())});
    recorder_.stream().commands.emplace_back(traces::PushConstants{0, std::move(bytes)});
    recorder_.draw_screen(recorder_.add(std::move(pipeline)), set, BlendCard::name(field));
  }

  PassRecorder& recorder_;
  const BlendCard& card_;
  traces::Pipeline ramp_, group_, texture_;
};

/// The six ways of the lectures, of a source over a background.
void draw_ways(Card& card) {
  const std::array<std::pair<BlendState, bool>, 6> ways{{
      {{}, false},
      {blend(BlendFactor::kSrcAlpha, BlendFactor::kOneMinusSrcAlpha), false},
      {blend(BlendFactor::kDstColor, BlendFactor::kOneMinusSrcAlpha), true},
      {blend(BlendFactor::kSrcAlpha, BlendFactor::kOne), false},
      {blend(BlendFactor::kOne, BlendFactor::kOne), false},
      {blend(BlendFactor::kOne, BlendFactor::kOne, BlendOp::kReverseSubtract), false},
  }};
  for (int field = 0; field < 6; ++field) {
    const auto& [state, premultiplied] = ways[static_cast<std::size_t>(field)];
    card.background(field);
    card.ramp(field, BlendCard::kSource, state, premultiplied);
  }
}

/// Two layers, the lower one first, on whatever is there.
void two_layers(Card& card, int field, const BlendState& state, bool premultiplied) {
  card.ramp(field, BlendCard::kLower, state, premultiplied);
  card.ramp(field, BlendCard::kUpper, state, premultiplied);
}

void draw_groups(Card& card) {
  two_layers(card, BlendCard::kStraightGroup, straight_over(), false);
  two_layers(card, BlendCard::kPremultipliedGroup, premultiplied_over(), true);
  two_layers(card, BlendCard::kDividedGroup, premultiplied_over(), true);
  card.ramp(BlendCard::kFrontToBack, BlendCard::kUpper, premultiplied_under(), true);
  card.ramp(BlendCard::kFrontToBack, BlendCard::kLower, premultiplied_under(), true);
}

void draw_layers(Card& card, traces::Index groups) {
  for (int field = BlendCard::kStraight; field <= BlendCard::kDividedGroup; ++field) card.background(field);
  two_layers(card, BlendCard::kStraight, straight_over(), false);
  two_layers(card, BlendCard::kPremultiplied, premultiplied_over(), true);
  card.group(BlendCard::kStraightGroup, groups, straight_over());
  card.group(BlendCard::kPremultipliedGroup, groups, premultiplied_over());
  card.group(BlendCard::kFrontToBack, groups, premultiplied_over());
  card.group(BlendCard::kDividedGroup, groups, straight_over(), true);
}

/// A texture and its mip chain, each level the plain mean of four texels of the one before.
traces::Image mask_image(bool premultiplied) {
  constexpr std::uint32_t kSide = BlendCard::kMaskSide;
  traces::Image image;
  image.name = premultiplied ? "mask, premultiplied" : "mask";
  image.format = traces::Format::kR8G8B8A8Unorm;
  image.width = image.height = kSide;
  image.levels = BlendCard::kMaskLevels;
  std::vector<glm::vec4> level(std::size_t{kSide} * kSide);
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x)
      level[std::size_t{y} * kSide + x] = BlendCard::mask_texel(x, y, premultiplied);
  for (std::uint32_t side = kSide; side > 0; side /= 2) {
    for (const glm::vec4& texel : level) {
      const std::array<std::byte, 4> bytes =
          std::bit_cast<std::array<std::byte, 4>>(glm::packUnorm4x8(texel));
      image.texels.insert(image.texels.end(), bytes.begin(), bytes.end());
    }
    std::vector<glm::vec4> next;
    next.reserve(level.size() / 4);
    for (std::size_t y = 0; y + 1 < side; y += 2)
      for (std::size_t x = 0; x + 1 < side; x += 2)
        next.push_back(0.25F * (level[y * side + x] + level[y * side + x + 1] + level[(y + 1) * side + x] +
                                level[(y + 1) * side + x + 1]));
    level = std::move(next);
  }
  return image;
}

/// The images as textures of set 1, smoothed between texels, one a set.
std::array<traces::Index, 2> mask_sets(PassRecorder& recorder) {
  traces::CommandStream& stream = recorder.stream();
  traces::Sampler smooth;
  smooth.wrap_u = smooth.wrap_v = traces::Wrap::kClampToEdge;
  stream.samplers.push_back(smooth);
  const auto sampler = static_cast<traces::Index>(stream.samplers.size() - 1);
  std::array<traces::Index, 2> sets{};
  for (const bool premultiplied : {false, true}) {
    stream.images.push_back(mask_image(premultiplied));
    traces::DescriptorSet set;
    set.textures.push_back({0, static_cast<traces::Index>(stream.images.size() - 1), sampler});
    stream.descriptor_sets.push_back(std::move(set));
    sets[premultiplied ? 1 : 0] = static_cast<traces::Index>(stream.descriptor_sets.size() - 1);
  }
  return sets;
}

void draw_masks(Card& card, const std::array<traces::Index, 2>& masks) {
  constexpr std::array<float, 3> kLevels{0, 2, 4};
  int field = BlendCard::kMasks;
  for (const float level : kLevels) {
    for (const bool premultiplied : {false, true}) {
      card.background(field);
      card.texture(field++, masks[premultiplied ? 1 : 0], level,
                   premultiplied ? premultiplied_over() : straight_over());
    }
  }
}

traces::BeginPass pass_over(traces::Index image, const glm::vec4& clear) {
  traces::BeginPass pass;
  pass.colors.emplace_back();
  pass.colors[0].image = image;
  pass.colors[0].clear = {clear.r, clear.g, clear.b, clear.a};
  return pass;
}

}  // namespace

BlendCard::BlendCard(std::uint32_t width, std::uint32_t height)
    : width_(static_cast<int>(width)),
      height_(static_cast<int>(height)),
      pitch_(std::max(1, std::min(width_ / kColumns, height_ / kRows))),
      side_(std::max(1, pitch_ - std::max(1, pitch_ / 12))) {}

BlendCard::Place BlendCard::place(int field) const {
  const int left = (width_ - kColumns * pitch_) / 2, top = (height_ - kRows * pitch_) / 2;
  const int inset = (pitch_ - side_) / 2;
  return {std::max(0, left + pitch_ * (field % kColumns) + inset),
          std::max(0, top + pitch_ * (field / kColumns) + inset)};
}

const char* BlendCard::name(int field) {
  static constexpr std::array<const char*, std::size_t{kColumns} * kRows> kNames{
      "replace",
      "linear mix",
      "multiply",
      "additive",
      "add",
      "subtract",
      "two layers over",
      "two premultiplied layers over",
      "their group, taken as straight",
      "their group, premultiplied",
      "their group, front to back",
      "their group, divided by its alpha",
      "enlarged",
      "enlarged, premultiplied",
      "reduced",
      "reduced, premultiplied",
      "reduced far",
      "reduced far, premultiplied"};
  return kNames[static_cast<std::size_t>(field)];
}

glm::vec4 BlendCard::mask_texel(std::uint32_t x, std::uint32_t y, bool premultiplied) {
  // A leaf with lobes; what lies outside of it is black.
  const double half = 0.5 * kMaskSide;
  const double dx = (x + 0.5 - half) / half, dy = (y + 0.5 - half) / half;
  const double radius = std::sqrt(dx * dx + dy * dy), round = std::atan2(dy, dx);
  const bool inside = radius < 0.62 + 0.25 * std::cos(5 * round);
  const glm::vec3 color = inside ? glm::vec3(0.15F, 0.35F, 0.9F) : glm::vec3(0);
  const float alpha = inside ? 1.0F : 0.0F;
  return {premultiplied ? color * alpha : color, alpha};
}

traces::CommandStream record_blends(const SceneData& scene, const SceneOptions& options) {
  refuse_other_pictures(scene, options);
  if (std::cmp_less(options.width, BlendCard::kColumns) || std::cmp_less(options.height, BlendCard::kRows))
    throw user_error("{}: {}x{} pixels do not hold its fields; it needs at least {}x{}", scene.name,
                     options.width, options.height, BlendCard::kColumns, BlendCard::kRows);
  PassRecorder recorder(scene, options);
  recorder.set_frame({});
  const BlendCard places(options.width, options.height);
  Card card(recorder, places);
  const traces::Index groups =
      recorder.attachment("groups", traces::Format::kR16G16B16A16Float, options.width, options.height);
  recorder.begin(pass_over(groups, glm::vec4(0)));
  draw_groups(card);
  recorder.end();
  const traces::Index picture =
      recorder.attachment("picture", options.color_format, options.width, options.height);
  const traces::Index group_set = recorder.textures({groups});
  const std::array<traces::Index, 2> masks = mask_sets(recorder);
  recorder.begin(pass_over(picture, glm::vec4(scene.background, 1)));
  draw_ways(card);
  draw_layers(card, group_set);
  draw_masks(card, masks);
  recorder.end();
  return recorder.finish();
}

}  // namespace quadrille::scenes
