/// Draws and passes as native Vulkan programs record them: without a fragment shader, with arguments in a
/// buffer, and with colour attachments that are left out.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>
#include <set>

#include "scenes/material/glsl.h"
#include "tests/traces/capture/native_objects.h"
#include "traces/capture/shader_words.h"

namespace quadrille::capture {
namespace {

using nlohmann::json;

constexpr std::uint32_t kHalf = 0x3f000000, kOne = 0x3f800000;
constexpr std::uint32_t kBlue = 0xffff0000;

constexpr const char* kFlat = R"(#version 450
layout(location = 0) in vec2 place;
void main() { gl_Position = vec4(place, 0.5, 1.0); }
)";
constexpr const char* kThree = R"(#version 450
layout(location = 0) out vec4 red; layout(location = 1) out vec4 green; layout(location = 2) out vec4 white;
void main() { red = vec4(1, 0, 0, 1); green = vec4(0, 1, 0, 1); white = vec4(1); }
)";
constexpr const char* kArrayOfThree = R"(#version 450
layout(location = 0) out vec4 all[3];
void main() { all[0] = vec4(1, 0, 0, 1); all[1] = vec4(0, 1, 0, 1); all[2] = vec4(1); }
)";

/// The words lie in a buffer of so many bytes, and `draw` stands behind the frame's own draw.
SmallCapture indirect(const std::vector<std::uint32_t>& words, const char* call, const json& draw,
                      std::uint64_t bytes = 64) {
  SmallCapture wish;
  wish.objects = [bytes](CaptureWriter& file) { add_arguments(file, bytes); };
  std::vector<std::uint8_t> data(4 * words.size());
  std::memcpy(data.data(), words.data(), data.size());
  wish.before = {
      {"CmdUpdateBuffer", {{"dstBuffer", kArguments}, {"dataSize", data.size()}, {"pData", data}}}};
  wish.behind = {
      {"CmdBindIndexBuffer", {{"buffer", kArguments}, {"offset", 48}, {"indexType", VK_INDEX_TYPE_UINT16}}},
      {call, draw}};
  return wish;
}

std::vector<traces::Draw> draws(const Import& made) {
  std::vector<traces::Draw> all;
  for (const traces::Command& command : made.stream.commands)
    if (const auto* draw = std::get_if<traces::Draw>(&command)) all.push_back(*draw);
  return all;
}

/// A pass whose colour attachments are `colors`; image A is cleared to blue, image B to black.
SmallCapture holes(const json& colors, const char* fragment, const Commands& behind = {}) {
  SmallCapture wish;
  wish.objects = [fragment](CaptureWriter& file) {
    add_image(file, {kImageA, kViewA, VK_FORMAT_R8G8B8A8_UNORM});
    add_image(file, {kImageB, kViewB, VK_FORMAT_R8G8B8A8_UNORM});
    add_pipeline(file, {.vertex = kFlat, .fragment = fragment, .colors = 3});
  };
  wish.before = pass(colors, nullptr, together({triangle(), behind}));
  return wish;
}

const json kInA = attachment(kViewA, {0, 0, kOne, kOne}), kInB = attachment(kViewB, {0, 0, 0, 0}),
           kLeftOut = attachment(0, {kOne, kOne, kOne, kOne});

std::uint32_t pixel(const std::vector<std::byte>& texels, std::size_t x, std::size_t y) {
  std::uint32_t value = 0;
  std::memcpy(&value, texels.data() + 4 * (16 * y + x), sizeof value);
  return value;
}

ShaderFacts facts_of(const std::string& body, const std::string& declarations) {
  const std::string source = "#version 450\n" + declarations + "void main() {" + body + "}";
  return shader_facts(scenes::compile_glsl(source.c_str(), traces::ShaderStage::kFragment, "shader"));
}

}  // namespace

TEST_CASE("capture: a pipeline without a fragment shader draws depths, and no colours") {
  SmallCapture wish;
  wish.objects = [](CaptureWriter& file) {
    add_image(file, {kImageA, kViewA, VK_FORMAT_R8G8B8A8_UNORM});
    add_image(file, {kImageB, kViewB});
    add_pipeline(file, {.vertex = kFlat, .colors = 1, .depth = true});
  };
  wish.before = pass(json::array({kInA}), attachment(kViewB, {kOne}), triangle());
  const Import made = import_small(wish);
  CHECK(pixel(left_in(made, kImageB), 2, 12) == kHalf);
  CHECK(pixel(left_in(made, kImageB), 12, 2) == kOne);
  CHECK(pixel(left_in(made, kImageA), 2, 12) == kBlue);
}

TEST_CASE("capture: indirect draws have the arguments that lie in their buffer") {
  const auto three =
      draws(import_small(indirect({3, 1, 0, 0, 0, 3, 0, 0, 0, 0, 3, 5, 0, 7, 0}, "CmdDrawIndirect",
                                  {{"buffer", kArguments}, {"drawCount", 3}, {"stride", 20}})));
  REQUIRE(three.size() == 3);  // the second has no instances
  CHECK(three[1] == three[0]);
  CHECK(three[2].count == 3);
  CHECK(three[2].instances == 5);
  CHECK(three[2].first_instance == 7);
  const auto indexed = draws(import_small(
      indirect({9, 3, 2, 0, 0xffffffffu, 4, 0, 0, 0, 0, 0, 0, 0x10001, 0x10001}, "CmdDrawIndexedIndirect",
               {{"buffer", kArguments}, {"offset", 4}, {"drawCount", 1}})));
  REQUIRE(indexed.size() == 2);
  CHECK(indexed[1].indexed);
  CHECK(indexed[1].count == 3);
  CHECK(indexed[1].instances == 2);
  CHECK(indexed[1].vertex_offset == -1);
  CHECK(indexed[1].first_instance == 4);
}

TEST_CASE("capture: the number of indirect draws may lie in a buffer, too") {
  const json draw{{"buffer", kArguments}, {"offset", 4},  {"countBuffer", kArguments},
                  {"maxDrawCount", 2},    {"stride", 16}, {"countBufferOffset", 0}};
  for (const std::uint32_t count : {0u, 1u, 2u, 9u}) {
    CAPTURE(count);
    const Import made = import_small(indirect({count, 3, 1, 0, 0, 3, 1, 0, 0}, "CmdDrawIndirectCount", draw));
    CHECK(draws(made).size() == 1 + std::min(count, 2u));
  }
}

TEST_CASE("capture: indirect draws whose arguments are not known are refused by name") {
  const auto refused = [](const json& draw) {
    return refusal(indirect({3, 1, 0, 0}, "CmdDrawIndirect", draw, 24));
  };
  CHECK_THAT(refused({{"buffer", kArguments}, {"drawCount", 2}, {"stride", 16}}),
             Catch::Contains(
                 "not supported: vkCmdDrawIndirect: whose arguments are bytes 0+32 of a buffer of 24 (x1)"));
  CHECK_THAT(refused({{"buffer", kArguments}, {"drawCount", 2}, {"stride", 4}}),
             Catch::Contains("vkCmdDrawIndirect: whose arguments, of 16 bytes, follow each other by 4 (x1)"));
  CHECK_THAT(refused({{"buffer", kArguments}, {"drawCount", 0xffffffffu}, {"stride", 16}}),
             Catch::Contains("vkCmdDrawIndirect: of 4294967295 draws; at most 65536 are possible (x1)"));
  CHECK_THAT(refused({{"buffer", 999}, {"drawCount", 1}}),
             Catch::Contains("buffer 999 was never created (x1)"));
  CHECK(refused({{"buffer", 999}, {"drawCount", 0}}).empty());
}

TEST_CASE("capture: arguments of indirect draws that a shader of the frame wrote are not known") {
  const auto frame = [](const char* fragment) {
    SmallCapture wish = indirect({3, 1, 0, 0}, "CmdDrawIndirect", {{"buffer", kArguments}, {"drawCount", 1}});
    wish.objects = [fragment](CaptureWriter& file) {
      add_arguments(file, 64);
      add_image(file, {kImageA, kViewA, VK_FORMAT_R8G8B8A8_UNORM});
      add_pipeline(file, {.vertex = kFlat, .fragment = fragment, .colors = 1});
    };
    const json buffer{{"buffer", kArguments}, {"range", 32}};
    const json write{{"dstBinding", 0},
                     {"descriptorCount", 1},
                     {"descriptorType", VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                     {"pBufferInfo", json::array({buffer})}};
    const Commands push{{"CmdPushDescriptorSetKHR", {{"pDescriptorWrites", json::array({write})}}}};
    wish.before = together({wish.before, pass(json::array({kInA}), nullptr, together({push, triangle()}))});
    return refusal(wish);
  };
  CHECK(frame(R"(#version 450
layout(set = 0, binding = 0) buffer Words { uint word[]; } words;
layout(location = 0) out vec4 color;
void main() { color = vec4(words.word[1]); })")
            .empty());
  CHECK_THAT(
      frame(R"(#version 450
layout(set = 0, binding = 0) buffer Words { uint word[]; } words;
layout(location = 0) out vec4 color;
void main() { words.word[1] = 2u; color = vec4(1.0); })"),
      Catch::Contains("vkCmdDrawIndirect: whose arguments a shader of the frame may have written (x1)"));
}

TEST_CASE("capture: what a shader writes to is told from what it reads") {
  const std::string blocks =
      "layout(set = 0, binding = 0) buffer A { uint a[4]; } x;\n"
      "layout(set = 1, binding = 2) buffer B { uint b; uint c; } y;\n"
      "layout(location = 0) out vec4 color;\n";
  using Places = std::set<std::pair<std::uint32_t, std::uint32_t>>;
  CHECK(facts_of("color = vec4(x.a[1] + y.b);", blocks).written == Places{});
  CHECK(facts_of("x.a[y.b] = 1u;", blocks).written == Places{{0, 0}});
  CHECK(facts_of("color = vec4(atomicAdd(y.c, x.a[0]));", blocks).written == Places{{1, 2}});
}

TEST_CASE("capture: outputs of a shader find their attachments in a pass that leaves some out") {
  const Import made = import_small(holes(json::array({kLeftOut, kInA, kInB}), kThree));
  CHECK(pixel(left_in(made, kImageA), 2, 12) == 0xff00ff00u);
  CHECK(pixel(left_in(made, kImageA), 12, 2) == kBlue);
  CHECK(pixel(left_in(made, kImageB), 2, 12) == 0xffffffffu);
  const Import middle = import_small(holes(json::array({kInB, kLeftOut, kInA}), kThree));
  CHECK(pixel(left_in(middle, kImageB), 2, 12) == 0xff0000ffu);
  CHECK(pixel(left_in(middle, kImageA), 2, 12) == 0xffffffffu);
  // At the end nothing moves, and arrays may be outputs, too.
  const Import last = import_small(holes(json::array({kInB, kInA, kLeftOut}), kArrayOfThree));
  CHECK(pixel(left_in(last, kImageA), 2, 12) == 0xff00ff00u);
}

TEST_CASE("capture: a clear behind a draw counts the attachments that a pass leaves out") {
  const auto clear = [](int attachment) {
    const json what{{"aspectMask", 1},
                    {"colorAttachment", attachment},
                    {"clearValue", {{"color", json::array({kOne, kOne, kOne, kOne})}}}};
    const json rect{{"rect", {{"extent", {{"width", 3}, {"height", 16}}}}}};
    return Commands{
        {"CmdClearAttachments", {{"pAttachments", json::array({what})}, {"pRects", json::array({rect})}}}};
  };
  const json colors = json::array({kLeftOut, kInA});
  CHECK(pixel(left_in(import_small(holes(colors, kThree, clear(1))), kImageA), 2, 12) == 0xffffffffu);
  CHECK(pixel(left_in(import_small(holes(colors, kThree, clear(0))), kImageA), 2, 12) == 0xff00ff00u);
  CHECK_THAT(refusal(holes(colors, kThree, clear(2))),
             Catch::Contains("vkCmdClearAttachments: of colour attachment 2 of a pass that has 2 (x1)"));
}

TEST_CASE("capture: passes that cannot do without a colour attachment are refused by name") {
  CHECK_THAT(refusal(holes(json::array({kLeftOut, kInA}), kArrayOfThree)),
             Catch::Contains("vkCmdDraw: an array of outputs where a pass leaves out colour attachments"));
  CHECK_THAT(refusal(holes(json::array({kLeftOut}), kThree)),
             Catch::Contains("vkCmdBeginRendering: a pass without attachments is not supported (x1)"));
}

TEST_CASE("capture: a picture of one dimension is drawn to like one of height 1") {
  SmallCapture wish;
  wish.objects = [](CaptureWriter& file) {
    add_image(file, {kImageA, kViewA, VK_FORMAT_R8G8B8A8_UNORM, 1, VK_IMAGE_TYPE_1D, 16, 1});
    add_image(file, {kImageB, kViewB, VK_FORMAT_R8G8B8A8_UNORM, 1, VK_IMAGE_TYPE_1D, 16, 1});
  };
  const json copy{{"srcSubresource", subresource(1)},
                  {"dstSubresource", subresource(1)},
                  {"dstOffset", {{"x", 5}}},
                  {"extent", extent(3, 1)}};
  wish.before =
      together({pass(json::array({kInA}), nullptr, {}),
                pass(json::array({kInB}), nullptr, {}),
                {{"CmdCopyImage",
                  {{"srcImage", kImageA}, {"dstImage", kImageB}, {"pRegions", json::array({copy})}}}}});
  const std::vector<std::byte> left = left_in(import_small(wish), kImageB);
  REQUIRE(left.size() == 64);
  for (std::size_t x = 0; x < 16; ++x) CHECK(pixel(left, x, 0) == (x >= 5 && x < 8 ? kBlue : 0u));
}

}  // namespace quadrille::capture
