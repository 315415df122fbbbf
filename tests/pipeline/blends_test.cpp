/// The test card of blending against closed forms in double precision, field by field, and on the machine.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <glm/vector_relational.hpp>

#include "models/base/error.h"
#include "models/rop/srgb.h"
#include "pipeline/render.h"
#include "scenes/passes/blend_card.h"
#include "scenes/scene.h"
#include "tests/hw/contract.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

constexpr std::uint32_t kWidth = 384, kHeight = 192;

SceneOptions options() {
  SceneOptions options;
  options.width = kWidth;
  options.height = kHeight;
  return options;
}

/// A colour that was not multiplied by its alpha.
struct Layer {
  glm::dvec3 color{0};
  double alpha = 1;
};

/// At a place of a field, 0..1 both ways.
Layer layer(const Ramp& ramp, glm::dvec2 at) {
  return {glm::mix(glm::dvec3(ramp.top), glm::dvec3(ramp.bottom), at.y),
          (1 - at.x) * static_cast<double>(ramp.left) + at.x * static_cast<double>(ramp.right)};
}

glm::dvec3 over(const Layer& upper, const glm::dvec3& lower) {
  return upper.alpha * upper.color + (1 - upper.alpha) * lower;
}

/// What the first row does with a source and a background.
glm::dvec3 way(int field, const Layer& source, const glm::dvec3& target) {
  switch (field) {
    case 0: return source.color;
    case 1: return over(source, target);
    case 2: return source.alpha * source.color * target + (1 - source.alpha) * target;
    case 3: return target + source.alpha * source.color;
    case 4: return target + source.color;
    default: return glm::max(glm::dvec3(0), target - source.color);
  }
}

glm::dvec3 two_layers(int field, glm::dvec2 at, const glm::dvec3& target) {
  const Layer lower = layer(BlendCard::kLower, at), upper = layer(BlendCard::kUpper, at);
  if (field != BlendCard::kStraightGroup) return over(upper, over(lower, target));
  // The group's colours are multiplied by its alpha, which a straight *over* does once more.
  const double alpha = upper.alpha + (1 - upper.alpha) * lower.alpha;
  return over({over(upper, lower.alpha * lower.color), alpha}, target);
}

double linear(std::uint32_t pixel, int c) {
  return static_cast<double>(models::decode_srgb8(static_cast<std::uint8_t>(pixel >> (8 * c) & 255U)));
}

glm::dvec3 linear(std::uint32_t pixel) { return {linear(pixel, 0), linear(pixel, 1), linear(pixel, 2)}; }

/// Each layer of a field is stored as a code, and so is off by half a code: in linear colours by 0.0045 where
/// codes lie furthest apart.
bool near(std::uint32_t pixel, const glm::dvec3& expected, int layers) {
  const glm::dvec3 off = glm::abs(linear(pixel) - glm::clamp(expected, 0.0, 1.0));
  return std::max({off.x, off.y, off.z}) <= 0.0045 * layers;
}

class Picture {
 public:
  explicit Picture(std::vector<std::uint32_t> pixels) : pixels_(std::move(pixels)) {}
  /// Calls `visit(pixel, place)` for each pixel of a field.
  void visit(int field, const std::function<void(std::uint32_t, glm::dvec2)>& visit) const {
    const BlendCard::Place corner = card_.place(field);
    for (int y = 0; y < card_.side(); ++y)
      for (int x = 0; x < card_.side(); ++x)
        visit(
            pixels_[static_cast<std::size_t>(corner.y + y) * kWidth + static_cast<std::size_t>(corner.x + x)],
            (glm::dvec2(x, y) + 0.5) / static_cast<double>(card_.side()));
  }
  /// The mean of a field's linear colours.
  [[nodiscard]] glm::dvec3 mean(int field) const {
    glm::dvec3 sum(0);
    visit(field, [&](std::uint32_t pixel, glm::dvec2) { sum += linear(pixel); });
    return sum / static_cast<double>(card_.side() * card_.side());
  }

 private:
  BlendCard card_{kWidth, kHeight};
  std::vector<std::uint32_t> pixels_;
};

Picture functional_card() {
  return Picture(pipeline::render_functional_frame(load_scene("builtin:blends", options()), {}).image.color);
}

}  // namespace

TEST_CASE("blends: the six ways of the lectures, at every pixel") {
  const Picture card = functional_card();
  for (int field = 0; field < 6; ++field) {
    INFO(BlendCard::name(field));
    int wrong = 0;
    card.visit(field, [&](std::uint32_t pixel, glm::dvec2 at) {
      const glm::dvec3 expected =
          way(field, layer(BlendCard::kSource, at), layer(BlendCard::kBackground, at).color);
      wrong += near(pixel, expected, 2) ? 0 : 1;
    });
    CHECK(wrong == 0);
  }
}

TEST_CASE("blends: over repeated, premultiplied and as a group, and a group taken as straight is too dark") {
  const Picture card = functional_card();
  for (int field = BlendCard::kStraight; field <= BlendCard::kDividedGroup; ++field) {
    INFO(BlendCard::name(field));
    int wrong = 0;
    card.visit(field, [&](std::uint32_t pixel, glm::dvec2 at) {
      wrong += near(pixel, two_layers(field, at, layer(BlendCard::kBackground, at).color), 3) ? 0 : 1;
    });
    CHECK(wrong == 0);
  }
  CHECK(card.mean(BlendCard::kStraightGroup).r < 0.95 * card.mean(BlendCard::kPremultipliedGroup).r);
}

TEST_CASE("blends: filtered colours that were not multiplied by alpha leave a dark fringe, others none") {
  const Picture card = functional_card();
  // Premultiplied: every pixel is a mixture of the leaf's colour and the background, so each channel lies
  // between the two.
  const glm::dvec3 leaf(BlendCard::mask_texel(BlendCard::kMaskSide / 2, BlendCard::kMaskSide / 2, false));
  const auto darker = [&](int field) {
    int count = 0;
    card.visit(field, [&](std::uint32_t pixel, glm::dvec2 at) {
      const glm::dvec3 back = layer(BlendCard::kBackground, at).color;
      const glm::dvec3 least = glm::min(leaf, back) - 0.015;
      count += glm::any(glm::lessThan(linear(pixel), least)) ? 1 : 0;
    });
    return count;
  };
  for (int level = 0; level < 3; ++level) {
    const int straight = BlendCard::kMasks + 2 * level;
    CHECK(darker(straight) > 20);
    CHECK(darker(straight + 1) == 0);
  }
  // Far away the leaf is one colour, of its mean alpha, over the background: a closed form. Straight, its
  // colour is multiplied by that alpha once more.
  double alpha = 0;
  for (std::uint32_t y = 0; y < BlendCard::kMaskSide; ++y)
    for (std::uint32_t x = 0; x < BlendCard::kMaskSide; ++x)
      alpha += static_cast<double>(BlendCard::mask_texel(x, y, false).a);
  alpha /= double{BlendCard::kMaskSide} * BlendCard::kMaskSide;
  const glm::dvec3 back =
      0.5 * (glm::dvec3(BlendCard::kBackground.top) + glm::dvec3(BlendCard::kBackground.bottom));
  for (int c = 0; c < 3; ++c) {
    CHECK(card.mean(BlendCard::kMasks + 5)[c] ==
          Approx(alpha * leaf[c] + (1 - alpha) * back[c]).margin(0.02));
    CHECK(card.mean(BlendCard::kMasks + 4)[c] ==
          Approx(alpha * alpha * leaf[c] + (1 - alpha) * back[c]).margin(0.02));
  }
}

TEST_CASE("blends: the machine draws the same card, and its laws hold") {
  const std::string wrong = hw::contract::in_child([] {
    const traces::CommandStream stream = load_scene("builtin:blends", options());
    const pipeline::RenderedFrame drawn = pipeline::render_exact(stream, pipeline::MachineConfig{});
    std::string text;
    if (drawn.image.color != pipeline::render_functional_frame(stream, {}).image.color) text += "pixels ";
    if (!drawn.figures.checks_hold()) text += "laws";
    return text;
  });
  CHECK(wrong.empty());
}

TEST_CASE("blends: a picture of few pixels has a pixel of every field, and other pictures are refused") {
  const BlendCard tiny(6, 3);
  CHECK(tiny.side() == 1);
  CHECK(tiny.place(17).x == 5);
  CHECK(tiny.place(17).y == 2);
  SceneOptions small = options();
  small.width = 5;
  CHECK_THROWS_AS(load_scene("builtin:blends", small), UserError);
  SceneOptions other = options();
  other.shading = Shading::kFlat;
  CHECK_THROWS_AS(load_scene("builtin:blends", other), UserError);
}
