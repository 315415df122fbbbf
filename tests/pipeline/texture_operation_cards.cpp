/// The cards of operations: one line each.
#include "tests/pipeline/texture_card.h"

namespace quadrille::pipeline::test {
namespace {

using traces::Filter;
using traces::Format;
using traces::ImageKind;
using traces::ViewKind;

traces::Sampler sampler_of(Filter filter, traces::Wrap wrap) {
  traces::Sampler s;
  s.mag = s.min = s.mip = filter;
  s.wrap_u = s.wrap_v = s.wrap_w = wrap;
  return s;
}

/// Images by what they are: a full chain of levels each.
traces::Image image_of(ViewKind view, Format format, std::uint64_t seed) {
  switch (view) {
    case ViewKind::k1D: return card_image(format, ImageKind::k1D, {32, 1, 1}, 1, 6, seed);
    case ViewKind::k1DArray: return card_image(format, ImageKind::k1D, {32, 1, 1}, 5, 6, seed);
    case ViewKind::k3D: return card_image(format, ImageKind::k3D, {16, 8, 13}, 1, 5, seed);
    case ViewKind::kCube: return card_image(format, ImageKind::k2D, {16, 16, 1}, 6, 5, seed);
    case ViewKind::kCubeArray: return card_image(format, ImageKind::k2D, {16, 16, 1}, 18, 5, seed);
    case ViewKind::k2DArray: return card_image(format, ImageKind::k2D, {16, 32, 1}, 7, 6, seed);
    case ViewKind::k2D:
    case ViewKind::k2DMultisampled:  // only attachments have several samples
    case ViewKind::k2DMultisampledArray: break;
  }
  return card_image(format, 16, 32, 6, seed);
}

struct Asked {
  ViewKind view;
  const char* sample;
};

/// Sampled, with a nearest and a linear filter.
constexpr Asked kSampled[] = {
    {ViewKind::k1D, "texture(t, uv.x)"},
    {ViewKind::k1D, "textureLod(t, uv.x, 1.3)"},
    {ViewKind::k1DArray, "texture(t, vec2(uv.x, at.y * 0.1))"},
    {ViewKind::k3D, "texture(t, vec3(uv, at.x * 0.031 + at.y * 0.017))"},
    {ViewKind::k3D, "textureLod(t, vec3(uv, at.y * 0.033), 0.0)"},
    {ViewKind::k2DArray, "texture(t, vec3(uv, at.x * 0.2 - 1.03))"},
    {ViewKind::k2DArray, "textureLod(t, vec3(uv, at.x * 0.2), 1.3)"},
    {ViewKind::kCube, "textureLod(t, dir, 0.0)"},
    {ViewKind::kCube, "textureLod(t, dir * 3.0, 1.3)"},
    {ViewKind::kCubeArray, "textureLod(t, vec4(dir, at.x * 0.12), 0.0)"},
    {ViewKind::k2D, "textureGrad(t, uv, vec2(0.11, 0.03), vec2(-0.02, 0.05))"},
    {ViewKind::k2D, "textureOffset(t, uv, ivec2(3, -2))"},
    {ViewKind::k2D, "textureLodOffset(t, uv, 1.3, ivec2(-7, 5))"},
    {ViewKind::k2D, "textureProj(t, vec3(uv * 1.7, 1.7))"},
    {ViewKind::k2D, "textureProjLod(t, vec3(uv * 1.7, 1.7), 1.3)"},
    {ViewKind::k2D, "texture(t, uv, 0.9)"},
    {ViewKind::k3D, "textureGrad(t, vec3(uv, 0.37), vec3(0.1, 0.02, 0.04), vec3(0.0, 0.13, 0.02))"},
    {ViewKind::k3D, "textureOffset(t, vec3(uv, 0.41), ivec3(1, -2, 3))"},
    {ViewKind::k2DArray, "textureGrad(t, vec3(uv, 2.1), vec2(0.11, 0.03), vec2(-0.02, 0.05))"},
    {ViewKind::kCube, "textureGrad(t, dir, vec3(0.11, 0.03, 0.02), vec3(-0.02, 0.05, 0.1))"},
};

/// Exact: no filter weighs them.
constexpr Asked kExact[] = {
    {ViewKind::k1D, "texelFetch(t, int(at.x) & 31, 0)"},
    {ViewKind::k1DArray, "texelFetch(t, ivec2(int(at.x) & 15, int(gl_FragCoord.y) / 10), 1)"},
    {ViewKind::k2D, "texelFetch(t, ivec2(at) & 15, 0)"},
    {ViewKind::k2D, "texelFetch(t, ivec2(at) & 3, 2)"},
    {ViewKind::k2D, "texelFetchOffset(t, ivec2(at) & 3, 1, ivec2(2, 4))"},
    {ViewKind::k3D, "texelFetch(t, ivec3(ivec2(at) & 7, int(gl_FragCoord.y) / 4), 0)"},
    {ViewKind::k2DArray, "texelFetch(t, ivec3(ivec2(at) & 7, int(gl_FragCoord.y) / 7), 1)"},
    {ViewKind::k2D, "textureGather(t, uv, 0)"},
    {ViewKind::k2D, "textureGather(t, uv, 2)"},
    {ViewKind::k2D, "textureGatherOffset(t, uv, ivec2(3, -5), 1)"},
    {ViewKind::k2D,
     "textureGatherOffset(t, uv, ivec2((int(gl_FragCoord.x) & 3) - 1, int(gl_FragCoord.y) & 3), 3)"},
    {ViewKind::k2D,
     "textureGatherOffsets(t, uv, ivec2[4](ivec2(0, 1), ivec2(2, -3), ivec2(4, 4), ivec2(-1, 0)), 1)"},
    {ViewKind::k2DArray, "textureGather(t, vec3(uv, at.x * 0.2), 1)"},
    {ViewKind::k2D, "vec4(vec2(textureSize(t, 1)), float(textureQueryLevels(t)), 1.0)"},
    {ViewKind::k1D, "vec4(float(textureSize(t, 2)), float(textureQueryLevels(t)), 0.0, 1.0)"},
    {ViewKind::k3D, "vec4(vec3(textureSize(t, 1)), float(textureQueryLevels(t)))"},
    {ViewKind::kCube, "vec4(vec2(textureSize(t, 1)), float(textureQueryLevels(t)), 1.0)"},
    {ViewKind::k1DArray, "vec4(vec2(textureSize(t, 1)), float(textureQueryLevels(t)), 1.0)"},
    {ViewKind::k2DArray, "vec4(vec3(textureSize(t, 2)), float(textureQueryLevels(t)))"},
    {ViewKind::kCubeArray, "vec4(vec3(textureSize(t, 1)), float(textureQueryLevels(t)))"},
};

/// Compared with depths.
constexpr Asked kCompared[] = {
    {ViewKind::k2D, "vec4(texture(t, vec3(uv, at.x * 0.03)))"},
    {ViewKind::k2D, "vec4(textureLod(t, vec3(uv, at.y * 0.02), 1.0))"},
    {ViewKind::k2D, "vec4(textureOffset(t, vec3(uv, 0.41), ivec2(1, 2)))"},
    {ViewKind::k2D, "vec4(textureGrad(t, vec3(uv, 0.41), vec2(0.07, 0.0), vec2(0.0, 0.03)))"},
    {ViewKind::k2D, "textureGather(t, uv, 0.37)"},
    {ViewKind::k2DArray, "vec4(texture(t, vec4(uv, at.x * 0.2, 0.52)))"},
    {ViewKind::kCube, "vec4(texture(t, vec4(dir, 0.43)))"},
};

/// Of compressed blocks.
struct AskedOfBlocks {
  Asked asked;
  Format format;
};
constexpr AskedOfBlocks kOfBlocks[] = {
    {{ViewKind::kCube, "textureLod(t, dir, 1.3)"}, Format::kBc1RgbUnorm},
    {{ViewKind::kCubeArray, "textureLod(t, vec4(dir, at.x * 0.12), 0.0)"}, Format::kBc3Unorm},
    {{ViewKind::k2DArray, "texture(t, vec3(uv, at.x * 0.2 - 1.03))"}, Format::kBc7Unorm},
    {{ViewKind::k2DArray, "texelFetch(t, ivec3(ivec2(at) & 7, int(gl_FragCoord.y) / 7), 1)"},
     Format::kBc5Unorm},
    {{ViewKind::k2D, "textureGatherOffset(t, uv, ivec2(3, -5), 1)"}, Format::kBc7Unorm},
    {{ViewKind::k2D, "textureGatherOffset(t, uv, ivec2(3, -5), 1)"}, Format::kAstc6x5Unorm},
    {{ViewKind::k2DArray, "texture(t, vec3(uv, at.x * 0.2 - 1.03))"}, Format::kAstc10x8Unorm},
    {{ViewKind::kCube, "textureLod(t, dir, 1.3)"}, Format::kAstc5x5Unorm},
    {{ViewKind::kCube, "textureLod(t, dir, 1.3)"}, Format::kEtc2Rgb8Unorm},
    {{ViewKind::k2D, "textureLodOffset(t, uv, 1.3, ivec2(-7, 5))"}, Format::kBc4Unorm},
};

TextureCard card_of(const Asked& asked, Format format, Filter filter, traces::Wrap wrap, std::uint64_t seed) {
  TextureCard card;
  card.view = asked.view;
  card.sample = asked.sample;
  card.image = image_of(asked.view, format, seed);
  card.layers = card.image.layers;
  card.sampler = sampler_of(filter, wrap);
  card.step = {0.5f, 0.5f};
  card.first = {-3.97f, -5.03f};
  return card;
}

/// Views that show components in another order.
std::vector<TextureCard> mapped_cards(std::uint64_t seed) {
  using models::ComponentSource;
  constexpr models::ComponentMapping kTurned{ComponentSource::kBlue, ComponentSource::kOne,
                                             ComponentSource::kAlpha, ComponentSource::kZero};
  constexpr models::ComponentMapping kGrey{ComponentSource::kRed, ComponentSource::kRed,
                                           ComponentSource::kRed, ComponentSource::kOne};
  std::vector<TextureCard> cards;
  const auto add = [&](const Asked& asked, Format format, Filter filter,
                       const models::ComponentMapping& components) {
    cards.push_back(card_of(asked, format, filter, traces::Wrap::kRepeat, seed + cards.size()));
    cards.back().components = components;
  };
  for (const Filter filter : {Filter::kNearest, Filter::kLinear}) {
    add({ViewKind::k2D, "texture(t, uv)"}, Format::kR8G8B8A8Unorm, filter, kTurned);
    add({ViewKind::k2D, "texture(t, uv)"}, Format::kR16Unorm, filter, kGrey);
    add({ViewKind::kCube, "textureLod(t, dir, 0.0)"}, Format::kR8G8B8A8Unorm, filter, kTurned);
    add({ViewKind::k2D, "texture(t, uv)"}, Format::kBc1RgbUnorm, filter, kTurned);
  }
  for (const char* gather : {"textureGather(t, uv, 0)", "textureGather(t, uv, 1)", "textureGather(t, uv, 3)"})
    add({ViewKind::k2D, gather}, Format::kR8G8B8A8Unorm, Filter::kNearest, kTurned);
  for (const char* ask : {"texelFetch(t, ivec2(at) & 15, 0)", "textureGather(t, uv, 1)"})
    add({ViewKind::k2D, ask}, Format::kR32G32B32A32Uint, Filter::kNearest, kTurned);
  return cards;
}

}  // namespace

std::vector<TextureCard> operation_cards() {
  constexpr traces::Wrap kWraps[] = {traces::Wrap::kRepeat, traces::Wrap::kMirroredRepeat,
                                     traces::Wrap::kClampToEdge, traces::Wrap::kClampToBorder,
                                     traces::Wrap::kMirrorClampToEdge};
  std::vector<TextureCard> cards;
  for (const Asked& asked : kSampled)
    for (const Filter filter : {Filter::kNearest, Filter::kLinear})
      cards.push_back(card_of(asked,
                              cards.size() % 3 == 0 ? Format::kR16G16B16A16Float : Format::kR8G8B8A8Unorm,
                              filter, kWraps[cards.size() % 5], cards.size()));
  for (const Asked& asked : kExact) {
    const Format format = cards.size() % 2 == 0 ? Format::kR8G8B8A8Unorm : Format::kR32G32B32A32Float;
    cards.push_back(card_of(asked, format, Filter::kNearest, traces::Wrap::kRepeat, cards.size()));
    cards.back().tolerance = 1e-6;
  }
  for (const Asked& asked : kCompared)
    for (const Filter filter : {Filter::kNearest, Filter::kLinear}) {
      const Format format = cards.size() % 2 == 0 ? Format::kD16Unorm : Format::kD32Float;
      cards.push_back(card_of(asked, format, filter, traces::Wrap::kClampToEdge, cards.size()));
      cards.back().shadow = true;
      cards.back().sampler.compare = static_cast<models::CompareOp>(1 + cards.size() % 6);
      if (cards.back().sampler.compare == models::CompareOp::kEqual ||
          cards.back().sampler.compare == models::CompareOp::kNotEqual)
        cards.back().sampler.compare = models::CompareOp::kLessOrEqual;
    }
  for (const auto& [asked, format] : kOfBlocks)
    for (const Filter filter : {Filter::kNearest, Filter::kLinear})
      cards.push_back(card_of(asked, format, filter, traces::Wrap::kRepeat, cards.size()));
  for (TextureCard& card : mapped_cards(cards.size())) cards.push_back(std::move(card));
  TextureCard separate = card_of({ViewKind::k2D, "texture(t, uv)"}, Format::kR8G8B8A8Unorm, Filter::kLinear,
                                 traces::Wrap::kRepeat, 99);
  separate.separate = true;
  cards.push_back(separate);
  TextureCard unfiltered = card_of({ViewKind::k2D, "texelFetch(image, ivec2(at) & 15, 0)"},
                                   Format::kR8G8B8A8Unorm, Filter::kNearest, traces::Wrap::kRepeat, 98);
  unfiltered.separate = true;
  cards.push_back(unfiltered);
  for (const char* sample :
       {"textureLod(t, uv, 1.0)", "texelFetch(t, ivec2(at) & 7, 1)", "textureGather(t, uv, 1)"}) {
    TextureCard early = card_of({ViewKind::k2D, sample}, Format::kR8G8B8A8Unorm, Filter::kNearest,
                                traces::Wrap::kRepeat, cards.size());
    early.in_vertex = true;
    cards.push_back(early);
  }
  for (const Format format : {Format::kR32G32B32A32Uint, Format::kR8G8Sint})
    for (const char* sample : {"texelFetch(t, ivec2(at) & 15, 0)", "textureGather(t, uv, 1)"})
      cards.push_back(
          card_of({ViewKind::k2D, sample}, format, Filter::kNearest, traces::Wrap::kRepeat, cards.size()));
  return cards;
}

std::vector<TextureCard> anisotropy_cards() {
  std::vector<TextureCard> cards;
  for (const float most : {2.0f, 4.0f, 16.0f})
    for (const char* sample :
         {"texture(t, vec2(uv.x * 0.3, uv.y * 6.0))", "texture(t, mat2(3.0, 2.1, 0.2, -0.31) * uv)",
          "textureGrad(t, uv, vec2(0.31, 0.12), vec2(0.02, 0.04))", "texture(t, uv * 0.1)"}) {
      const Format format = cards.size() % 3 == 2 ? Format::kBc7Srgb : Format::kR8G8B8A8Srgb;
      TextureCard card =
          card_of({ViewKind::k2D, sample}, format, Filter::kLinear, traces::Wrap::kRepeat, cards.size());
      card.sampler.max_anisotropy = most;
      cards.push_back(card);
    }
  return cards;
}

}  // namespace quadrille::pipeline::test
