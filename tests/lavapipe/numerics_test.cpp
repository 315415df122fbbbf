/// How lavapipe computes what the specification leaves open, measured bit by bit: docs/sources.md and
/// docs/deviations.md cite these cases.
///
/// A shader writes the bits of a float into the four bytes of its pixel, and the test recomputes them in
/// fp32. The cases hold for Mesa
/// 22.3's llvmpipe; on another driver they say so and judge nothing.
#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <random>
#include <string>

#include "models/base/error.h"
#include "models/raster/viewport.h"
#include "tests/lavapipe/hand_made_stream.h"
#include "tests/lavapipe/vulkan_renderer.h"

namespace quadrille::lavapipe {
namespace {

using traces::Format;

constexpr std::uint32_t kSide = 32;
constexpr std::size_t kInputs = std::size_t{kSide} * kSide;

std::optional<Rendered> render(const traces::CommandStream& stream) {
  try {
    VulkanRenderer renderer;
    if (renderer.info().name.starts_with("llvmpipe")) return renderer.render(stream);
    WARN("skipped: " << renderer.info().name << " is not llvmpipe");
  } catch (const UserError& error) { WARN("skipped: " << error.what()); }
  return std::nullopt;
}

/// Random vectors `a` and `b` for each pixel.
struct Inputs {
  std::vector<float> a, b;
  explicit Inputs(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(-2, 2);
    for (std::size_t i = 0; i < 4 * kInputs; ++i) {
      a.push_back(value(random));
      b.push_back(value(random));
    }
  }
};

std::array<Corner, 3> covering_triangle() {
  return {Corner{{-1, -1, 0, 1}, {}}, Corner{{3, -1, 0, 1}, {}}, Corner{{-1, 3, 0, 1}, {}}};
}

/// A stream whose pixel i holds the bits of the GLSL expression `result`, a function of `a` and `b` (vec4 i
/// of the inputs).
HandMadeStream bits_of(const std::string& result, const Inputs& inputs) {
  const std::string fragment = R"(#version 450
layout(set = 0, binding = 0, std140) uniform A { vec4 all_a[1024]; };
layout(set = 0, binding = 1, std140) uniform B { vec4 all_b[1024]; };
layout(set = 0, binding = 2) uniform sampler2D image;
layout(location = 0) out vec4 color;
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 a = all_a[pixel.y * 32 + pixel.x];
  vec4 b = all_b[pixel.y * 32 + pixel.x];
  uint bits = floatBitsToUint()" +
                               result + R"();
  color = vec4(uvec4(bits, bits >> 8, bits >> 16, bits >> 24) & 255u) / 255.0;
})";
  HandMadeStream made(kSide, kSide, Format::kR8G8B8A8Unorm, Format::kUndefined);
  made.shaders(pass_through_vertex_shader(), fragment)
      .uniforms(0, inputs.a)
      .uniforms(1, inputs.b)
      .corners(covering_triangle())
      .draw(3);
  return made;
}

/// How many of the pixels hold exactly the bits of `expected(a, b)`.
template <class Expected>
std::optional<std::size_t> equal_bits(const std::string& expression, Expected expected) {
  const Inputs inputs(7);
  const auto image =
      render(bits_of(expression, inputs)
                 .texture(2, {"", Format::kR8G8B8A8Unorm, 1, 1, 1, std::vector<std::byte>(4), nullptr}, {})
                 .finish());
  if (!image) return std::nullopt;
  std::size_t equal = 0;
  for (std::size_t i = 0; i < kInputs; ++i)
    equal +=
        image->color[i] == std::bit_cast<std::uint32_t>(expected(&inputs.a[4 * i], &inputs.b[4 * i])) ? 1 : 0;
  return equal;
}

float dot3(const float* a, const float* b) { return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]; }

}  // namespace

TEST_CASE("lavapipe numerics: matrix times vector adds the last column first and rounds every step") {
  const auto equal = equal_bits("(mat4(a, b, a.yzwx, b.wxyz) * b).x", [](const float* a, const float* b) {
    return ((b[3] * b[3] + a[1] * b[2]) + b[0] * b[1]) + a[0] * b[0];
  });
  if (equal) CHECK(*equal == kInputs);
}

TEST_CASE("lavapipe numerics: dot products add x first, and normalize divides by the length") {
  const auto dots =
      equal_bits("dot(a, b)", [](const float* a, const float* b) { return dot3(a, b) + a[3] * b[3]; });
  const auto units = equal_bits("normalize(a.xyz).x",
                                [](const float* a, const float*) { return a[0] / std::sqrt(dot3(a, a)); });
  if (dots) CHECK(*dots == kInputs);
  if (units) CHECK(*units == kInputs);
}

TEST_CASE("lavapipe numerics: mix is a (1 - t) + b t, and fma rounds twice") {
  const auto mixed = equal_bits(
      "mix(a.x, b.x, a.y)", [](const float* a, const float* b) { return a[0] * (1 - a[1]) + b[0] * a[1]; });
  const auto fused =
      equal_bits("fma(a.x, b.x, a.y)", [](const float* a, const float* b) { return a[0] * b[0] + a[1]; });
  if (mixed) CHECK(*mixed == kInputs);
  if (fused) CHECK(*fused == kInputs);
}

TEST_CASE("lavapipe numerics: every derivative is the fine one") {
  const Inputs inputs(7);
  const auto image =
      render(bits_of("dFdxCoarse(a.x)", inputs)
                 .texture(2, {"", Format::kR8G8B8A8Unorm, 1, 1, 1, std::vector<std::byte>(4), nullptr}, {})
                 .finish());
  if (!image) return;
  for (std::size_t i = 0; i < kInputs; ++i) {
    const std::size_t left = i & ~std::size_t{1};
    CHECK(image->color[i] == std::bit_cast<std::uint32_t>(inputs.a[4 * (left + 1)] - inputs.a[4 * left]));
  }
}

TEST_CASE(
    "lavapipe numerics: level of detail is half the piecewise linear logarithm of the squared footprint, "
    "once a quad") {
  Inputs inputs(5);
  for (std::size_t i = 0; i < inputs.a.size(); ++i) inputs.a[i] *= std::exp2(-static_cast<float>(i / 4 % 8));
  traces::Image texture{"levels", Format::kR8G8B8A8Unorm, 256, 128, 9, {}, nullptr};
  for (unsigned level = 0; level < 9; ++level)
    texture.texels.resize(texture.texels.size() +
                          std::size_t{4} * std::max(1u, 256u >> level) * std::max(1u, 128u >> level));
  const std::string coordinates =
      "textureQueryLod(image, vec2(0.3, 0.4) + a.xy * 0.0 + all_a[(pixel.y & ~1) * 32 + (pixel.x & ~1)].xy * "
      "float(pixel.x & 1)"
      " + all_a[(pixel.y & ~1) * 32 + (pixel.x & ~1)].zw * float(pixel.y & 1)).y";
  const auto image = render(bits_of(coordinates, inputs).texture(2, texture, {}).finish());
  if (!image) return;
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x) {
      const float* step = &inputs.a[4 * ((y & ~1u) * kSide + (x & ~1u))];
      const float ax = ((0.3f + step[0]) - 0.3f) * 256, ay = ((0.4f + step[1]) - 0.4f) * 128;
      const float bx = ((0.3f + step[2]) - 0.3f) * 256, by = ((0.4f + step[3]) - 0.4f) * 128;
      const auto rho2 = std::bit_cast<std::uint32_t>(std::max(ax * ax + ay * ay, bx * bx + by * by));
      const float log2 = static_cast<float>(static_cast<int>(rho2 >> 23) - 128) +
                         std::bit_cast<float>((rho2 & 0x7fffffu) | 0x3f800000u);
      CHECK(std::bit_cast<float>(image->color[y * kSide + x]) == 0.5f * log2);
    }
}

TEST_CASE("lavapipe numerics: our viewport transform and snapping give its coverage") {
  constexpr std::int32_t kWidth = 640, kHeight = 352;
  std::mt19937 random(11);
  std::uniform_real_distribution<float> centre(-0.9f, 0.9f), offset(-0.05f, 0.05f), depth(0.5f, 20.0f);
  std::vector<Corner> corners;
  for (std::uint32_t triangle = 0; triangle < 4000; ++triangle) {
    const float x = centre(random), y = centre(random);
    for (int i = 0; i < 3; ++i) {
      const float w = depth(random);
      corners.push_back({{(x + offset(random)) * w, (y + offset(random)) * w, 0.5f * w, w},
                         {static_cast<float>(triangle + 1), 0}});
    }
  }
  const auto image = render(HandMadeStream(kWidth, kHeight, Format::kR8G8B8A8Unorm, Format::kD32Float)
                                .shaders(R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec2 value;
layout(location = 0) flat out uint id;
void main() {
  gl_Position = position;
  id = uint(value.x);
})",
                                         R"(#version 450
layout(location = 0) flat in uint id;
layout(location = 0) out vec4 color;
void main() { color = vec4(uvec4(id, id >> 8, 0, 0) & 255u) / 255.0; })")
                                .corners(corners)
                                .draw(static_cast<std::uint32_t>(corners.size()))
                                .finish());
  if (!image) return;

  const models::Viewport viewport{0, 0, kWidth, kHeight, 0, 1};
  std::vector<std::uint32_t> expected(image->color.size(), 0);
  for (std::uint32_t t = 0; t < corners.size() / 3; ++t) {
    std::array<std::int64_t, 3> x{}, y{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& p = corners[3 * t + i].position;
      models::WindowVertex vertex;
      REQUIRE(models::to_window({p[0], p[1], p[2], p[3]}, viewport, 8, vertex));
      x[i] = vertex.x;
      y[i] = vertex.y;
    }
    if ((x[1] - x[0]) * (y[2] - y[0]) < (x[2] - x[0]) * (y[1] - y[0])) {
      std::swap(x[1], x[2]);
      std::swap(y[1], y[2]);
    }
    const auto inside = [&](std::int64_t px, std::int64_t py) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3;
        const std::int64_t dx = x[j] - x[i], dy = y[j] - y[i], edge = dx * (py - y[i]) - dy * (px - x[i]);
        if (edge < 0 || (edge == 0 && !(dy < 0 || (dy == 0 && dx > 0)))) return false;
      }
      return true;
    };
    const auto [left, right] = std::minmax_element(x.begin(), x.end());
    const auto [top, bottom] = std::minmax_element(y.begin(), y.end());
    for (std::int64_t py = std::max<std::int64_t>(0, *top >> 8);
         py <= std::min<std::int64_t>(kHeight - 1, *bottom >> 8); ++py)
      for (std::int64_t px = std::max<std::int64_t>(0, *left >> 8);
           px <= std::min<std::int64_t>(kWidth - 1, *right >> 8); ++px)
        if (inside(256 * px + 128, 256 * py + 128))
          expected[static_cast<std::size_t>(py * kWidth + px)] = t + 1;
  }
  std::size_t different = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) different += image->color[i] != expected[i] ? 1 : 0;
  INFO(different << " of " << expected.size() << " pixels differ");
  CHECK(different == 0);
}

}  // namespace quadrille::lavapipe
