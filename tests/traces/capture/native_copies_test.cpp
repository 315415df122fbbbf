/// Copies, resolves and blits as native Vulkan programs ask for them.
#include <catch2/catch.hpp>

#include <array>
#include <cstring>

#include "models/precision.h"
#include "models/rop/depth_plane.h"
#include "pipeline/render.h"
#include "tests/traces/capture/native_objects.h"

namespace quadrille::capture {
namespace {

using nlohmann::json;

constexpr int kColors = VK_IMAGE_ASPECT_COLOR_BIT, kDepths = VK_IMAGE_ASPECT_DEPTH_BIT,
              kStencils = VK_IMAGE_ASPECT_STENCIL_BIT;
constexpr std::uint32_t kHalf = 0x3f000000, kOne = 0x3f800000;

constexpr const char* kSlanted = R"(#version 450
layout(location = 0) in vec2 place;
void main() { gl_Position = vec4(place, 0.37 + 0.31 * place.x - 0.05 * place.y, 1.0); }
)";
constexpr const char* kFlat = R"(#version 450
layout(location = 0) in vec2 place;
void main() { gl_Position = vec4(place, 0.5, 1.0); }
)";
constexpr const char* kRed = R"(#version 450
layout(location = 0) out vec4 color;
void main() { color = vec4(1.0, 0.0, 0.0, 1.0); }
)";

std::uint32_t word(const std::vector<std::byte>& texels, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, texels.data() + 4 * at, sizeof value);
  return value;
}

/// Image A gets depths by a pipeline without a fragment shader, image B is cleared to 0.5 and stencils of 7;
/// then `copy` stands.
SmallCapture depth_frame(VkFormat format, const Commands& copy) {
  SmallCapture wish;
  wish.objects = [format](CaptureWriter& file) {
    add_image(file, {kImageA, kViewA, format});
    add_image(file, {kImageB, kViewB, format});
    add_pipeline(file, {.vertex = kSlanted, .depth = true});
  };
  wish.before = together({pass(json::array(), attachment(kViewA, {kOne, 3}), triangle()),
                          pass(json::array(), attachment(kViewB, {kHalf, 7}), {}), copy});
  return wish;
}

json depth_copy(int aspects, int width = 16) {
  const json region{{"srcSubresource", subresource(aspects)},
                    {"dstSubresource", subresource(aspects)},
                    {"extent", extent(width)}};
  return {{"srcImage", kImageA}, {"dstImage", kImageB}, {"pRegions", json::array({region})}};
}

/// Image A has four samples a pixel and a triangle in red on blue; then `commands` stand.
SmallCapture sample_frame(const Commands& commands) {
  SmallCapture wish;
  wish.objects = [](CaptureWriter& file) {
    add_image(file, {kImageA, kViewA, VK_FORMAT_R8G8B8A8_UNORM, 4});
    add_image(file, {kImageB, 0, VK_FORMAT_R8G8B8A8_UNORM});
    add_pipeline(file, {.vertex = kFlat, .fragment = kRed, .colors = 1, .samples = 4});
  };
  wish.before =
      together({pass(json::array({attachment(kViewA, {0, 0, kOne, kOne})}), nullptr, triangle()), commands});
  return wish;
}

json resolve_info(int width, std::uint64_t from = kImageA) {
  const json region{{"srcSubresource", subresource(kColors)},
                    {"dstSubresource", subresource(kColors)},
                    {"extent", extent(width)}};
  return {{"srcImage", from}, {"dstImage", kImageB}, {"pRegions", json::array({region})}};
}

}  // namespace

TEST_CASE("capture: a copy of depths that a pass has drawn has their bits, and stencil values stay") {
  for (const VkFormat format : {VK_FORMAT_D16_UNORM, VK_FORMAT_D32_SFLOAT, VK_FORMAT_D24_UNORM_S8_UINT,
                                VK_FORMAT_D32_SFLOAT_S8_UINT}) {
    CAPTURE(format);
    const Import made =
        import_small(depth_frame(format, {{"CmdCopyImage2", {{"pCopyImageInfo", depth_copy(kDepths)}}}}));
    std::vector<std::byte> from = left_in(made, kImageA), to = left_in(made, kImageB);
    REQUIRE(from.size() == to.size());
    const std::size_t bytes = from.size() / 256;
    const bool packed = format == VK_FORMAT_D24_UNORM_S8_UINT, stencils = packed || bytes == 8;
    for (std::size_t at = packed ? 3 : 4; stencils && at < from.size(); at += bytes) {
      REQUIRE(from[at] == std::byte{3});
      REQUIRE(to[at] == std::byte{7});
      to[at] = from[at];
    }
    CHECK(from == to);
    CHECK(std::memcmp(from.data(), from.data() + bytes * (12 * 16 + 2), bytes) != 0);  // something was drawn
  }
}

TEST_CASE("capture: depths of 16 and 24 bits are the same ones behind a float of 32 bits") {
  for (const auto& [format, most] :
       {std::pair{traces::Format::kD16Unorm, 0xffffu}, {traces::Format::kD24UnormS8Uint, 0xffffffu}})
    for (std::uint32_t code = 0; code <= most; ++code) {
      const models::PixelCode pixel{{code, 0, 0, 0}};
      if (models::encode_depth(format, models::decode_depth(format, pixel), 0) == pixel) continue;
      FAIL("depth " << code << " of " << most);
    }
  SUCCEED();
}

TEST_CASE("capture: a blit of depths takes the nearest, and a part of a copy leaves the rest") {
  json blit = depth_copy(kDepths);
  blit["pRegions"][0]["srcOffsets"] = json::array({{{"x", 0}}, {{"x", 4}, {"y", 16}, {"z", 1}}});
  blit["pRegions"][0]["dstOffsets"] = json::array({{{"x", 0}}, {{"x", 8}, {"y", 16}, {"z", 1}}});
  const Import made = import_small(depth_frame(VK_FORMAT_D32_SFLOAT, {{"CmdBlitImage", blit}}));
  const std::vector<std::byte> from = left_in(made, kImageA), to = left_in(made, kImageB);
  for (std::size_t y = 0; y < 16; ++y)
    for (std::size_t x = 0; x < 16; ++x) {
      CAPTURE(x, y);
      CHECK(word(to, 16 * y + x) == (x < 8 ? word(from, 16 * y + x / 2) : kHalf));
    }
}

TEST_CASE("capture: copies of depths that cannot be drawn are refused by name") {
  const auto copied = [](VkFormat format, const json& info) {
    return refusal(depth_frame(format, {{"CmdCopyImage", info}}));
  };
  CHECK_THAT(copied(VK_FORMAT_D24_UNORM_S8_UINT, depth_copy(kDepths | kStencils)),
             Catch::Contains("not supported: vkCmdCopyImage: of stencil values (x1)"));
  CHECK_THAT(copied(VK_FORMAT_D32_SFLOAT, depth_copy(kColors)),
             Catch::Contains("vkCmdCopyImage: to an image of depths (x1)"));
  json within = depth_copy(kDepths);
  within["srcImage"] = kImageB;
  CHECK_THAT(copied(VK_FORMAT_D32_SFLOAT, within),
             Catch::Contains("vkCmdCopyImage: within a level of an image (x1)"));
  json layers = depth_copy(kDepths);
  layers["pRegions"][0]["dstSubresource"] = subresource(kDepths, 2);
  CHECK_THAT(copied(VK_FORMAT_D32_SFLOAT, layers), Catch::Contains("vkCmdCopyImage: of 2 layers (x1)"));
}

TEST_CASE("capture: samples that a pass has drawn are resolved by a pass of their own") {
  for (const bool second : {false, true}) {
    CAPTURE(second);
    const Commands resolve{
        second ? Commands::value_type{"CmdResolveImage2", {{"pResolveImageInfo", resolve_info(16)}}}
               : Commands::value_type{"CmdResolveImage", resolve_info(16)}};
    const std::vector<std::byte> left = left_in(import_small(sample_frame(resolve)), kImageB);
    CHECK(word(left, 12 * 16 + 2) == 0xff0000ffu);
    CHECK(word(left, 2 * 16 + 12) == 0xffff0000u);
    const std::uint32_t edge = word(left, 5 * 16 + 5);  // half of its samples are covered
    CHECK((edge & 0xff) > 0x30);
    CHECK((edge >> 16 & 0xff) > 0x30);
  }
}

TEST_CASE("capture: resolves of parts, of one sample, and of what the frame has not drawn are said") {
  CHECK_THAT(refusal(sample_frame({{"CmdResolveImage", resolve_info(8)}})),
             Catch::Contains("not supported: vkCmdResolveImage: of a part of an image (x1)"));
  CHECK_THAT(refusal(sample_frame({{"CmdResolveImage", resolve_info(16, kShown)}})),
             Catch::Contains("vkCmdResolveImage: of 1 samples a pixel to 1 (x1)"));
  SmallCapture undrawn = sample_frame({});
  undrawn.before = {{"CmdResolveImage", resolve_info(16)}};
  const Import made = import_small(undrawn);
  REQUIRE(made.notes.size() == 1);
  CHECK_THAT(*made.notes.begin(), Catch::Contains("begins with what an earlier frame left"));
}

TEST_CASE("capture: a copy samples an image that the program does not") {
  // The shown image is a target of copies alone, image B a source.
  SmallCapture wish;
  wish.loads = true;
  wish.objects = [](CaptureWriter& file) {
    add_image(file, {kImageB, kViewB, VK_FORMAT_B8G8R8A8_UNORM});
    add_pipeline(file, {.vertex = kFlat, .fragment = kRed, .colors = 1});
  };
  json info = depth_copy(kColors);
  info["srcImage"] = kImageB;
  info["dstImage"] = kShown;
  wish.before = together({pass(json::array({attachment(kViewB, {0, kOne, 0, kOne})}), nullptr, {}),
                          {{"CmdCopyImage2", {{"pCopyImageInfo", info}}}}});
  const Import made = import_small(wish);
  const auto pixels = pipeline::render_functional_frame(made.stream, models::Precision{}).image.color;
  CHECK(pixels.at(2 * 16 + 12) == 0xff00ff00u);
}

TEST_CASE("capture: a volume is blitted on its texels, each the mean of those that it covers") {
  const auto volume_frame = [](VkFilter filter, int width) {
    SmallCapture wish;
    wish.objects = [](CaptureWriter& file) {
      add_image(file, {kImageA, 0, VK_FORMAT_R8G8B8A8_UNORM, 1, VK_IMAGE_TYPE_3D, 2, 2, 2});
      add_image(file, {kImageB, 0, VK_FORMAT_R8G8B8A8_UNORM, 1, VK_IMAGE_TYPE_3D, 1, 1, 1});
      std::array<std::uint8_t, 32> texels{};
      for (std::size_t i = 0; i < texels.size(); ++i) texels.at(i) = static_cast<std::uint8_t>(8 * i);
      file.init_image(kImageA, std::as_bytes(std::span(texels)));
    };
    const json corner{{"x", 2}, {"y", 2}, {"z", 2}}, one{{"x", width}, {"y", 1}, {"z", 1}};
    const json region{{"srcSubresource", subresource(kColors)},
                      {"dstSubresource", subresource(kColors)},
                      {"srcOffsets", json::array({{{"x", 0}}, corner})},
                      {"dstOffsets", json::array({{{"x", 0}}, one})}};
    json copy = depth_copy(kColors);
    copy["srcImage"] = kImageB;
    copy["dstImage"] = kTexture;
    copy["pRegions"][0]["extent"] = extent(1, 1);
    wish.before = {{"CmdBlitImage",
                    {{"srcImage", kImageA},
                     {"dstImage", kImageB},
                     {"pRegions", json::array({region})},
                     {"filter", filter}}},
                   {"CmdCopyImage", copy}};
    return wish;
  };
  const auto shown = [&](VkFilter filter) {
    const Import made = import_small(volume_frame(filter, 1));
    return pipeline::render_functional_frame(made.stream, models::Precision{}).image.color.at(12 * 16 + 2);
  };
  // Of red, 0, 32, 64 and so on to 224.
  CHECK(shown(VK_FILTER_LINEAR) == 0x88807870u);
  CHECK(shown(VK_FILTER_NEAREST) == 0xf8f0e8e0u);  // on a border: the greater one
  CHECK_THAT(refusal(volume_frame(VK_FILTER_LINEAR, 2)),
             Catch::Contains("vkCmdBlitImage: to texels 0 to 2 of 1 (x1)"));
}

}  // namespace quadrille::capture
