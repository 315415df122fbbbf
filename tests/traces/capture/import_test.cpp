/// What a capture becomes, on captures made here.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>

#include "models/base/descriptor_binding.h"
#include "models/base/error.h"
#include "models/precision.h"
#include "pipeline/frame_contents.h"
#include "pipeline/render.h"
#include "tests/traces/capture/small_capture.h"
#include "traces/capture/import.h"

namespace quadrille::capture {
namespace {

Import import(const SmallCapture& wish, const ImportOptions& options = {}) {
  return import_bytes("small.gfxr", small_capture(wish), options);
}

std::vector<std::uint32_t> picture(const traces::CommandStream& stream) {
  return pipeline::render_functional_frame(stream, models::Precision{}).image.color;
}

constexpr std::uint32_t kBlue = 0xffff0000;
constexpr std::uint32_t kTriangle = 0xff3264c8;  // kTexel, red in the low byte

std::string refusal(const SmallCapture& wish) {
  try {
    (void)import(wish);
  } catch (const UserError& error) { return error.what(); }
  return "";
}

}  // namespace

TEST_CASE("capture: a frame of one triangle is the picture that its commands draw") {
  const std::vector<std::uint32_t> pixels = picture(import({}).stream);
  REQUIRE(pixels.size() == 256);
  // The triangle covers what is left of the diagonal from the upper left to the lower right corner.
  for (std::uint32_t y = 0; y < 16; ++y) {
    for (std::uint32_t x = 0; x < 16; ++x) {
      if (x == y) continue;  // centres on the edge
      CAPTURE(x, y);
      REQUIRE(pixels[y * 16 + x] == (x < y ? kTriangle : kBlue));
    }
  }
}

TEST_CASE("capture: blocks of LZ4 and Zstandard hold the same frame as plain ones") {
  const traces::CommandStream plain = import({}).stream;
  CHECK(import({.packing = Packing::kLz4}).stream == plain);
  CHECK(import({.packing = Packing::kZstd}).stream == plain);
}

TEST_CASE("capture: arrays of descriptors, samplers of layouts, and dynamic offsets of two sets at once") {
  const traces::CommandStream stream = import({.arrays = true}).stream;
  std::vector<std::uint32_t> offsets;
  std::vector<std::uint32_t> elements;
  for (const traces::DescriptorSet& set : stream.descriptor_sets) {
    for (const auto& block : set.uniforms) offsets.push_back(block.offset);
    for (const auto& texture : set.textures) elements.push_back(texture.binding);
  }
  std::ranges::sort(offsets);
  CHECK(offsets == std::vector<std::uint32_t>{0, 256, 512});
  // Element 1, which was never written, is like element 0.
  CHECK(elements == std::vector<std::uint32_t>{3, models::element_binding(3, 1)});
  CHECK(stream.samplers.size() == 1);
  CHECK(picture(stream)[16] == (kTriangle | 0x00ff0000u));  // blue by the third block
}

TEST_CASE("capture: a texture of which only the memory is known is read from it, if the driver is lavapipe") {
  const Import known = import({.texture_in_memory = true});
  CHECK(picture(known.stream) == picture(import({}).stream));
  CHECK(known.notes.empty());
  const Import unknown = import({.texture_in_memory = true, .lavapipe = false});
  CHECK(picture(unknown.stream)[16] != kTriangle);
  CHECK(unknown.notes.size() == 1);
}

TEST_CASE("capture: an entry point of any name is called main in the stream") {
  const Import named = import({.entry = "draw_it"});
  CHECK(picture(named.stream) == picture(import({}).stream));
}

TEST_CASE("capture: a clip space of -w to w moves depths to the middle of what 0 to w gives") {
  const auto depths = [](bool negative) {
    traces::CommandStream stream = import({.negative_one_to_one = negative}).stream;
    traces::Image depth;
    depth.format = traces::Format::kD32Float;
    depth.width = depth.height = 16;
    depth.usage = traces::kDepthAttachment;
    stream.images.push_back(depth);
    for (traces::Command& command : stream.commands) {
      auto* begin = std::get_if<traces::BeginPass>(&command);
      if (begin != nullptr) begin->depth.image = static_cast<traces::Index>(stream.images.size() - 1);
    }
    for (traces::Pipeline& pipeline : stream.pipelines)
      pipeline.depth = {true, true, traces::CompareOp::kLess};
    traces::validate(stream);
    return pipeline::render_functional_frame(stream, models::Precision{}).image.depth;
  };
  CHECK(depths(false)[12 * 16 + 2] == 0.25f);
  CHECK(depths(true)[12 * 16 + 2] == 0.625f);  // (0.25 + 1) / 2
}

TEST_CASE("capture: a command that is not supported is named with its count") {
  const SmallCapture wish{.extra_command = "CmdDrawMeshTasksEXT"};
  CHECK_THAT(refusal(wish), Catch::Contains("not supported: vkCmdDrawMeshTasksEXT (x1)"));
  const Import skipped = import(wish, {.skip_unsupported = true});
  REQUIRE(skipped.skipped.size() == 1);
  CHECK(skipped.skipped.begin()->first == "vkCmdDrawMeshTasksEXT");
  CHECK(picture(skipped.stream) == picture(import({}).stream));
}

TEST_CASE("capture: a draw that needs what the machine lacks is left out if that is wished") {
  const SmallCapture wish{.sampler_counts_texels = true};
  CHECK_THAT(refusal(wish),
             Catch::Contains("vkCmdDraw: a sampler with unnormalised coordinates is not supported (x1)"));
  const std::vector<std::uint32_t> pixels = picture(import(wish, {.skip_unsupported = true}).stream);
  CHECK(std::ranges::all_of(pixels, [](std::uint32_t pixel) { return pixel == kBlue; }));
}

TEST_CASE("capture: a pass that begins with an earlier frame's picture says that it is not there") {
  CHECK(import({}).notes.empty());
  const Import made = import({.loads = true});
  REQUIRE(made.notes.size() == 1);
  CHECK_THAT(*made.notes.begin(), Catch::Contains("begins with what an earlier frame left"));
}

TEST_CASE("capture: a frame begins with what the one before it left, once that is known") {
  const SmallCapture wish{.frames = 2};
  for (const bool known : {false, true}) {
    CAPTURE(known);
    CaptureFrames frames("small.gfxr", small_capture(wish));
    const Import first = *frames.next();
    if (known) frames.keep(pipeline::contents_after(first.stream, models::Precision{}));
    const Import second = *frames.next();
    CHECK(second.notes.empty() == known);
    const std::vector<std::uint32_t> before = picture(first.stream), after = picture(second.stream);
    CHECK(before[16 * 9 + 14] == kBlue);
    CHECK(after[16 * 9 + 14] == kTriangle);                 // the second frame's
    CHECK(after[16 * 12 + 2] == (known ? kTriangle : 0u));  // the first one's
    CHECK(after[16 * 2 + 14] == (known ? kBlue : 0u));      // its clear
    CHECK_FALSE(frames.next());
  }
}

TEST_CASE("capture: a buffer that a frame's programs wrote is what the next frame reads") {
  CaptureFrames frames("small.gfxr", small_capture({.frames = 3}));
  (void)frames.next();
  const Import second = *frames.next();
  const float places[6] = {-1, -1, -1,
                           1,  1,  1};  // the first frame's triangle, as if a program had written it
  const auto bytes = std::as_bytes(std::span(places));
  frames.keep({.parts = {}, .buffers = {{0, {bytes.begin(), bytes.end()}}}});
  const std::vector<std::uint32_t> before = picture(second.stream), after = picture(frames.next()->stream);
  CHECK(before[16 * 12 + 2] == 0);
  CHECK(after[16 * 12 + 2] == kTriangle);
}

TEST_CASE("capture: a pass that renders to a part of its attachments leaves the rest") {
  using nlohmann::json;
  const json part{{"offset", {{"x", 4}, {"y", 8}}}, {"extent", {{"width", 12}, {"height", 8}}}};
  CaptureFrames frames("small.gfxr", small_capture({.frames = 2, .later_area = part}));
  const Import first = *frames.next();
  frames.keep(pipeline::contents_after(first.stream, models::Precision{}));
  const std::vector<std::uint32_t> pixels = picture(frames.next()->stream);
  CHECK(pixels[16 * 6 + 2] == kTriangle);   // above it, the first frame's
  CHECK(pixels[16 * 12 + 2] == kTriangle);  // left of it
  CHECK(pixels[16 * 12 + 5] == kBlue);      // cleared
  CHECK(pixels[16 * 9 + 14] == kTriangle);  // drawn into it
}

TEST_CASE("capture: a clear behind a draw fills its area of the colour attachment that it names") {
  using nlohmann::json;
  const json red{{"color", json::array({0x3f800000, 0, 0, 0x3f800000})}};
  const auto clear = [&](int attachment) {
    const json what{{"aspectMask", 1}, {"colorAttachment", attachment}, {"clearValue", red}};
    const json rect{{"rect", {{"offset", {{"x", 3}, {"y", 5}}}, {"extent", {{"width", 4}, {"height", 2}}}}}};
    return SmallCapture{
        .behind = {{"CmdClearAttachments",
                    {{"pAttachments", json::array({what})}, {"pRects", json::array({rect})}}}}};
  };
  const std::vector<std::uint32_t> pixels = picture(import(clear(0)).stream);
  for (std::uint32_t y = 0; y < 16; ++y)
    for (std::uint32_t x = 0; x < 16; ++x) {
      const bool within = x >= 3 && x < 7 && y >= 5 && y < 7;
      CAPTURE(x, y);
      CHECK((pixels[16 * y + x] == 0xff0000ffu) == within);
    }
  CHECK_THAT(refusal(clear(1)),
             Catch::Contains("vkCmdClearAttachments: of colour attachment 1 of a pass that has 1"));
}

TEST_CASE("capture: contents that no draw of the frame can see are not brought") {
  CaptureFrames frames("small.gfxr", small_capture({.frames = 3}));
  CHECK(frames.next()->stream.images[0].texels.empty());
  const Import lacking = *frames.next();
  CHECK(lacking.stream.images[0].texels.empty());
  frames.keep(pipeline::contents_after(lacking.stream, models::Precision{}));
  CHECK(frames.next()->stream.images[0].texels.size() == 16 * 16 * 4);
}

TEST_CASE("capture: copies in the frame change what its draws read") {
  using nlohmann::json;
  const json layer{{"aspectMask", 1}, {"layerCount", 1}};
  const auto at = [](std::vector<std::uint32_t> pixels, std::size_t x, std::size_t y) {
    return pixels.at(16 * y + x);
  };
  SECTION("a buffer's bytes as vertices") {
    // The second corner to the upper right: the triangle covers the other half.
    const float corner[2] = {1, -1};
    std::vector<std::uint8_t> bytes(sizeof(corner));
    std::memcpy(bytes.data(), corner, sizeof(corner));
    const Import made = import(
        {.before = {{"CmdUpdateBuffer",
                     {{"dstBuffer", kVertices}, {"dstOffset", 0}, {"dataSize", 8}, {"pData", bytes}}},
                    {"CmdCopyBuffer",
                     {{"srcBuffer", kVertices},
                      {"dstBuffer", kVertices},
                      {"pRegions", json::array({{{"dstOffset", 8}, {"size", 8}}})}}},
                    {"CmdFillBuffer",
                     {{"dstBuffer", kVertices}, {"dstOffset", 0}, {"size", 8}, {"data", 0xbf800000u}}}}});
    CHECK(at(picture(made.stream), 12, 3) == kTriangle);
    CHECK(at(picture(made.stream), 3, 12) == kBlue);
  }
  SECTION("a buffer's bytes as a texel") {
    const Import made = import(
        {.before = {{"CmdCopyBufferToImage",
                     {{"srcBuffer", kVertices},
                      {"dstImage", kTexture},
                      {"pRegions",
                       json::array({{{"bufferOffset", 0},
                                     {"imageSubresource", layer},
                                     {"imageExtent", {{"width", 1}, {"height", 1}, {"depth", 1}}}}})}}}}});
    CHECK(at(picture(made.stream), 3, 12) == 0xbf800000u);  // -1.0f
  }
  SECTION("a cleared image, and a texel drawn into it") {
    const json clear{{"image", kShown},
                     {"pColor", json::array({0, 0x3f800000, 0, 0x3f800000})},
                     {"pRanges", json::array({{{"aspectMask", 1}, {"levelCount", 1}, {"layerCount", 1}}})}};
    const json copy{{"srcImage", kTexture},
                    {"dstImage", kShown},
                    {"pRegions", json::array({{{"srcSubresource", layer},
                                               {"dstSubresource", layer},
                                               {"dstOffset", {{"x", 2}, {"y", 9}}},
                                               {"extent", {{"width", 1}, {"height", 1}, {"depth", 1}}}}})}};
    CHECK_THAT(refusal({.loads = true, .before = {{"CmdClearColorImage", clear}, {"CmdCopyImage", copy}}}),
               Catch::Contains("vkCmdCopyImage: between formats"));
    const Import made = import({.loads = true, .before = {{"CmdClearColorImage", clear}}});
    CHECK(made.notes.empty());
    CHECK(at(picture(made.stream), 12, 3) == 0xff00ff00u);
    CHECK(at(picture(made.stream), 2, 9) == kTriangle);
  }
  SECTION("what lies beyond a buffer or an image") {
    const json beyond{{"dstBuffer", kVertices}, {"dstOffset", 20}, {"size", 8}, {"data", 1}};
    CHECK_THAT(refusal({.before = {{"CmdFillBuffer", beyond}}}),
               Catch::Contains("vkCmdFillBuffer: of bytes 20+8 of a buffer of 24"));
    const json wide{
        {"srcBuffer", kVertices},
        {"dstImage", kTexture},
        {"pRegions", json::array({{{"imageSubresource", layer},
                                   {"imageExtent", {{"width", 2}, {"height", 1}, {"depth", 1}}}}})}};
    CHECK_THAT(refusal({.before = {{"CmdCopyBufferToImage", wide}}}),
               Catch::Contains("of an area beyond the image"));
  }
}

TEST_CASE("capture: a barrier is no command that could be missed") {
  CHECK(import({.extra_command = "CmdPipelineBarrier2"}).skipped.empty());
}

TEST_CASE("capture: a file that ends anywhere is refused with its name and a place") {
  const std::vector<std::byte> whole = small_capture({.packing = Packing::kZstd});
  for (std::size_t size = 0; size < whole.size(); size += 7) {
    CAPTURE(size);
    const std::vector<std::byte> part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    REQUIRE_THROWS_AS(import_bytes("part.gfxr", part), UserError);
  }
}

TEST_CASE("capture: a byte that is changed leads to a frame or a refusal of one line") {
  const std::vector<std::byte> whole = small_capture();
  std::size_t refused = 0;
  for (std::size_t at = 0; at < whole.size(); at += 3) {
    std::vector<std::byte> changed = whole;
    changed[at] ^= std::byte{0xff};
    try {
      (void)import_bytes("changed.gfxr", changed);
    } catch (const UserError& error) {
      ++refused;
      CAPTURE(at, error.what());
      REQUIRE(std::string(error.what()).starts_with("changed.gfxr: "));
      REQUIRE(std::string(error.what()).find('\n') == std::string::npos);
    }
  }
  CHECK(refused > whole.size() / 30);
}

}  // namespace quadrille::capture
