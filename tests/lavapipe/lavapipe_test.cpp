/// The ruler itself is measured: pictures of hand-made streams against closed forms, under the validation
/// layer where it is installed.
#include <catch2/catch.hpp>

#include <bit>
#include <cmath>
#include <optional>

#include "models/base/error.h"
#include "tests/lavapipe/hand_made_stream.h"
#include "tests/lavapipe/vulkan_renderer.h"

namespace quadrille::lavapipe {
namespace {

using traces::Format;

constexpr std::string_view kWriteValue = R"(#version 450
layout(location = 0) in vec2 v_value;
layout(location = 0) out vec4 color;
void main() { color = vec4(v_value, 0.0, 1.0); })";

/// Renders, or returns nothing after saying that the test is skipped for want of a driver. Any message of the
/// validation layer fails the test.
std::optional<Rendered> render(const traces::CommandStream& stream) {
  std::optional<VulkanRenderer> renderer;
  try {
    renderer.emplace(true);
  } catch (const UserError&) {
    try {
      renderer.emplace(false);
    } catch (const UserError& error) {
      WARN("skipped: " << error.what());
      return std::nullopt;
    }
  }
  Rendered image = renderer->render(stream);
  for (const std::string& message : renderer->validation_messages()) FAIL_CHECK(message);
  return image;
}

/// Corners of two triangles that tile the target: (0,1,2) lies towards the origin, (3,4,5) is the rest.
std::array<Corner, 6> full_target(float depth) {
  const auto corner = [depth](float x, float y) { return Corner{{2 * x - 1, 2 * y - 1, depth, 1}, {x, y}}; };
  return {corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 0), corner(1, 1), corner(0, 1)};
}

}  // namespace

TEST_CASE("lavapipe: covers exactly the pixels whose centres are inside, by the top-left rule") {
  // The hypotenuse from (16, 0) to (0, 16) passes through pixel centres; it is neither a top nor a left edge,
  // so they are outside.
  const auto image = render(HandMadeStream(16, 16, Format::kR8G8B8A8Unorm, Format::kUndefined)
                                .shaders(pass_through_vertex_shader(), kWriteValue)
                                .corners(full_target(0))
                                .draw(3)
                                .finish());
  if (!image) return;
  for (std::uint32_t y = 0; y < 16; ++y)
    for (std::uint32_t x = 0; x < 16; ++x) CHECK((image->color[16 * y + x] != 0) == (x + y + 1 < 16));
}

TEST_CASE("lavapipe: two triangles that share an edge cover each pixel once") {
  HandMadeStream made(16, 16, Format::kR8G8B8A8Unorm, Format::kUndefined);
  made.shaders(pass_through_vertex_shader(), R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(100.0 / 255.0); })");
  made.pipeline().blend[0] = {true,
                              traces::BlendFactor::kOne,
                              traces::BlendFactor::kOne,
                              traces::BlendFactor::kOne,
                              traces::BlendFactor::kOne,
                              traces::BlendOp::kAdd,
                              traces::BlendOp::kAdd,
                              0xf};
  const auto image = render(made.corners(full_target(0)).draw(6).finish());
  if (!image) return;
  for (const std::uint32_t pixel : image->color) CHECK(pixel == 0x64646464u);
}

TEST_CASE("lavapipe: interpolates linearly across the target, at pixel centres") {
  const auto image = render(HandMadeStream(32, 8, Format::kR8G8B8A8Unorm, Format::kUndefined)
                                .shaders(pass_through_vertex_shader(), kWriteValue)
                                .corners(full_target(0))
                                .draw(6)
                                .finish());
  if (!image) return;
  for (std::uint32_t x = 0; x < 32; ++x) {
    const double expected = 255 * (x + 0.5) / 32;
    CHECK(std::abs((image->color[3 * 32 + x] & 0xffu) - expected) <= 0.5 + 1e-3);
  }
}

TEST_CASE("lavapipe: the nearer triangle wins whatever the order, and its depth is stored") {
  auto corners = std::vector<Corner>{};
  for (const float depth : {0.25f, 0.75f})
    for (const Corner& corner : full_target(depth)) corners.push_back({corner.position, {depth, depth}});
  HandMadeStream made(8, 8, Format::kR8G8B8A8Unorm, Format::kD32Float);
  made.shaders(pass_through_vertex_shader(), kWriteValue);
  made.pipeline().depth = {true, true, traces::CompareOp::kLess};
  const auto image = render(made.corners(corners).draw(12).finish());
  if (!image) return;
  REQUIRE(image->depth.size() == 64);
  for (const float depth : image->depth) CHECK(depth == 0.25f);
  for (const std::uint32_t pixel : image->color) CHECK((pixel & 0xffu) == 64);  // 0.25 * 255 = 63.75
}

TEST_CASE("lavapipe: a texture drawn one texel a pixel arrives unchanged") {
  traces::Image texture{"texture", Format::kR8G8B8A8Unorm, 8, 8, 1, {}, nullptr};
  for (unsigned i = 0; i < 4 * 64; ++i) texture.texels.push_back(static_cast<std::byte>(i * 37 + 11));
  const auto image = render(HandMadeStream(8, 8, Format::kR8G8B8A8Unorm, Format::kUndefined)
                                .shaders(pass_through_vertex_shader(), R"(#version 450
layout(location = 0) in vec2 v_value;
layout(set = 0, binding = 3) uniform sampler2D image;
layout(location = 0) out vec4 color;
void main() { color = texture(image, v_value); })")
                                .texture(3, texture, {})
                                .corners(full_target(0))
                                .draw(6)
                                .finish());
  if (!image) return;
  for (unsigned i = 0; i < 64; ++i)
    for (unsigned c = 0; c < 4; ++c)
      CHECK((image->color[i] >> 8 * c & 0xffu) == std::to_integer<unsigned>(texture.texels[4 * i + c]));
}

TEST_CASE("lavapipe: a minified texture is read from the mip level of its footprint") {
  traces::Image texture{"levels", Format::kR8G8B8A8Unorm, 32, 32, 6, {}, nullptr};
  for (unsigned level = 0; level < 6; ++level)
    texture.texels.insert(texture.texels.end(), std::size_t{4} << (2 * (5 - level)),
                          static_cast<std::byte>(40 * level));
  const auto image = render(HandMadeStream(8, 8, Format::kR8G8B8A8Unorm, Format::kUndefined)
                                .shaders(pass_through_vertex_shader(), R"(#version 450
layout(location = 0) in vec2 v_value;
layout(set = 0, binding = 0) uniform sampler2D image;
layout(location = 0) out vec4 color;
void main() { color = texture(image, v_value); })")
                                .texture(0, texture, {})
                                .corners(full_target(0))
                                .draw(6)
                                .finish());
  if (!image) return;
  for (const std::uint32_t pixel : image->color) CHECK((pixel & 0xffu) == 80);  // 4 texels a pixel: level 2
}

TEST_CASE("lavapipe: an sRGB target stores encoded values and clears to them") {
  HandMadeStream made(4, 4, Format::kR8G8B8A8Srgb, Format::kUndefined);
  made.pass().colors[0].clear = {0.5f, 0, 1, 0.5f};
  const auto image = render(
      made.shaders(pass_through_vertex_shader(), kWriteValue).corners(full_target(0)).draw(0).finish());
  if (!image) return;
  // 0.5 linear is 188 encoded
  for (const std::uint32_t pixel : image->color) CHECK(pixel == (0x80u << 24 | 0xffu << 16 | 0xbcu));
}

TEST_CASE("lavapipe: byte indices, uniforms, push constants and instances reach the shaders") {
  const std::array<float, 4> uniform{0.25f, 0, 0, 0}, push{0.5f, 0, 0, 0};
  const std::array<std::uint8_t, 3> indices{2, 0, 1};
  const auto image = render(HandMadeStream(4, 4, Format::kR8G8B8A8Unorm, Format::kUndefined)
                                .shaders(R"(#version 450
layout(location = 0) in vec4 position;
layout(location = 1) in vec2 value;
layout(location = 0) flat out float v_value;
layout(push_constant) uniform Push { float push; };
void main() {
  gl_Position = vec4(position.xy * 2.0 + 1.0, position.zw);
  v_value = push;
})",
                                         R"(#version 450
layout(location = 0) flat in float v_value;
layout(set = 0, binding = 1, std140) uniform Block { float block; };
layout(location = 0) out vec4 color;
void main() { color = vec4(v_value, block, float(gl_PrimitiveID), 1.0); })")
                                .uniforms(1, uniform)
                                .push_constants(push)
                                .corners(full_target(0))
                                .draw_indexed(indices)
                                .finish());
  if (!image) return;
  for (const std::uint32_t pixel : image->color) CHECK(pixel == 0xff004080u);
}

TEST_CASE("lavapipe: more push constants than the driver takes are refused by name") {
  const std::vector<float> push(traces::kMaxPushConstantBytes / 4, 1.0f);
  const auto stream = HandMadeStream(4, 4, Format::kR8G8B8A8Unorm, Format::kUndefined)
                          .shaders(pass_through_vertex_shader(), kWriteValue)
                          .push_constants(push)
                          .corners(full_target(0))
                          .draw(3)
                          .finish();
  std::optional<VulkanRenderer> renderer;
  try {
    renderer.emplace();
  } catch (const UserError& error) {
    WARN("skipped: " << error.what());
    return;
  }
  if (renderer->info().max_push_constants >= traces::kMaxPushConstantBytes) return;
  CHECK_THROWS_WITH(renderer->render(stream), Catch::Contains("256 bytes of constants"));
}

}  // namespace quadrille::lavapipe
