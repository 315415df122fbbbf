/// Each case damages one thing in a valid stream and asks for the refusal that names it.
#include <catch2/catch.hpp>

#include <cstring>
#include <limits>
#include <memory>

#include "tests/traces/defects.h"

using namespace quadrille;
using namespace quadrille::traces;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

}  // namespace

TEST_CASE("validate: the samples are valid") {
  REQUIRE(refusal(small_stream()) == "accepted");
  for (std::uint32_t seed = 0; seed < 300; ++seed) REQUIRE(refusal(random_stream(seed)) == "accepted");
}

TEST_CASE("validate: queries") {
  const auto pools = [](CommandStream& s) {
    s.query_pools = {{"samples", QueryType::kOcclusion, 0, 2},
                     {"stages", QueryType::kPipelineStatistics, kAllStatistics, 1}};
  };
  // Commands put before the one of that number.
  const auto with = [&](const std::vector<std::pair<std::size_t, Command>>& added) {
    return [=](CommandStream& s) {
      pools(s);
      for (const auto& [at, c] : added) s.commands.insert(s.commands.begin() + static_cast<int>(at), c);
    };
  };
  const auto pool = [&](std::size_t number, auto harm) {
    return [=](CommandStream& s) {
      pools(s);
      harm(s.query_pools[number]);
    };
  };
  constexpr std::size_t kDraw = 8, kEnd = 10;
  const BeginQuery first{0, 0, true}, second{0, 1, false}, stages{1, 0, false};
  CommandStream good = small_stream();
  with({{kDraw, first},
        {kDraw + 1, stages},
        {kDraw + 3, EndQuery{0, 0}},
        {kDraw + 4, second},
        {kDraw + 5, EndQuery{0, 1}},
        {kDraw + 6, EndQuery{1, 0}}})(good);
  CHECK(refusal(good) == "accepted");
  good = small_stream();
  with({{0, first}, {12, EndQuery{0, 0}}})(good);
  CHECK(refusal(good) == "accepted");
  expect({
      {"query pool 2 does not exist", with({{kDraw, BeginQuery{2, 0, true}}})},
      {"query 2 does not exist; query pool 0 'samples' has 2", with({{kDraw, BeginQuery{0, 2, true}}})},
      {"query 3 does not exist", with({{kDraw, EndQuery{0, 3}}})},
      {"command 9: query 1 of pool 0 begins inside query 0 of pool 0; one of a type may be active at a time",
       with({{kDraw, first}, {kDraw + 1, second}})},
      {"command 9: query 0 of pool 0 begins inside query 0", with({{kDraw, first}, {kDraw + 1, first}})},
      {"begins twice", with({{kDraw, first}, {kDraw + 1, EndQuery{0, 0}}, {kDraw + 2, first}})},
      {"command 8: query 0 of pool 0 ends that is not active", with({{kDraw, EndQuery{0, 0}}})},
      {"query 1 of pool 0 ends that is not active", with({{kDraw, first}, {kDraw + 1, EndQuery{0, 1}}})},
      {"a render pass ends in which query 0 of pool 0 has begun and not ended", with({{kEnd, first}})},
      {"query 0 of pool 0 began outside of the render pass in which it ends",
       with({{0, first}, {kDraw, EndQuery{0, 0}}})},
      {"query 0 of pool 1 is not ended", with({{0, stages}})},
      {"query 0 of pool 1 is precise; only occlusion queries are", with({{kDraw, BeginQuery{1, 0, true}}})},
      {"query pool 0 'samples': 0 queries", pool(0, [](QueryPool& p) { p.queries = 0; })},
      {"4294967295 queries; 1 to 1048576 are possible", pool(0, [](QueryPool& p) { p.queries = ~0u; })},
      {"statistics 0x1 of occlusion queries", pool(0, [](QueryPool& p) { p.statistics = 1; })},
      {"statistics 0x0; a part of 0xe7", pool(1, [](QueryPool& p) { p.statistics = 0; })},
      {"statistics 0x8; a part of 0xe7 is possible", pool(1, [](QueryPool& p) { p.statistics = 8; })},
  });
}

TEST_CASE("validate: primitives") {
  expect({
      {"pipeline 0 '", [](auto& s) { s.pipelines[0].line_width = kNan; }},
      {"line width 0.5 is outside 1..64", [](auto& s) { s.pipelines[0].line_width = 0.5f; }},
      {"line width 65 is outside 1..64", [](auto& s) { s.pipelines[0].line_width = 65; }},
      {"primitive restart in a list", [](auto& s) { s.pipelines[0].primitive_restart = true; }},
      {"primitive restart in a list",
       [](auto& s) {
         s.pipelines[0].topology = Topology::kPointList;
         s.pipelines[0].primitive_restart = true;
       }},
  });
}

namespace {

/// The small stream with its draw order-independent, as it has to be.
CommandStream kept_stream() {
  CommandStream s = small_stream();
  Pipeline& p = s.pipelines[0];
  using enum BlendFactor;
  p.order_independent = true;
  p.depth.write = false;
  p.blend[0] = {true, kOne, kOneMinusSrcAlpha, kOne, kOneMinusSrcAlpha, BlendOp::kAdd, BlendOp::kAdd, 0xf};
  command<BeginPass>(s, 0).transparency = {Transparency::kKbuffer, 8};
  return s;
}

}  // namespace

TEST_CASE("validate: order-independent draws") {
  CHECK(refusal(kept_stream()) == "accepted");
  const std::vector<Defect> defects{
      {"its blending is not one over the other",
       [](auto& s) { s.pipelines[0].blend[0].dst_color = BlendFactor::kOne; }},
      {"its blending is not one over the other", [](auto& s) { s.pipelines[0].blend[0].write_mask = 7; }},
      {"its blending is not one over the other", [](auto& s) { s.pipelines[0].blend_shared.logic = true; }},
      {"but it writes depths", [](auto& s) { s.pipelines[0].depth.write = true; }},
      {"in a pass that keeps no fragments", [](auto& s) { command<BeginPass>(s, 0).transparency = {}; }},
      {"command 0: 9 fragments a pixel are kept; 1..8",
       [](auto& s) { command<BeginPass>(s, 0).transparency.layers = 9; }},
      {"command 0: 0 fragments a pixel are kept; 1..64",
       [](auto& s) {
         command<BeginPass>(s, 0).transparency = {Transparency::kAbuffer, 0};
       }},
      {"command 0: 1 fragments a pixel are kept; 0..0",
       [](auto& s) {
         command<BeginPass>(s, 0).transparency = {Transparency::kNone, 1};
       }},
      {"behind an order-independent one",
       [](auto& s) {
         s.pipelines.push_back(s.pipelines[0]);
         s.pipelines[1].order_independent = false;
         const auto end = s.commands.end() - 1;
         const Command draw = *(end - 1);
         s.commands.insert(end, {Command(BindPipeline{1}), draw});
       }},
  };
  for (const Defect& defect : defects) {
    CommandStream stream = kept_stream();
    defect.make(stream);
    CAPTURE(defect.message);
    REQUIRE_THAT(refusal(stream), Catch::Contains(defect.message));
  }
}

TEST_CASE("validate: an index that ends a strip fetches nothing") {
  CommandStream stream = small_stream();
  stream.pipelines[0].topology = Topology::kLineStrip;
  for (Buffer& buffer : stream.buffers) {
    if (buffer.data.size() == 3) buffer.data[1] = std::byte{0xff};  // the indices, of 8 bits
  }
  CHECK(refusal(stream) != "accepted");
  stream.pipelines[0].primitive_restart = true;
  CHECK(refusal(stream) == "accepted");
}

TEST_CASE("validate: objects") {
  expect({
      {"image 0 'white': 12 bytes of texels where 2x2", [](auto& s) { s.images[0].height = 2; }},
      {"image 0: size 0x1", [](auto& s) { s.images[0].width = 0; }},
      {"image 0: size 16385x1", [](auto& s) { s.images[0].width = 16385; }},
      {"3 mip levels", [](auto& s) { s.images[0].levels = 3; }},
      {"0 mip levels", [](auto& s) { s.images[0].levels = 0; }},
      {"image 0 'white': its format", [](auto& s) { s.images[0].format = Format::kD24UnormS8Uint; }},
      {"sampler 0: lod bias", [](auto& s) { s.samplers[0].lod_bias = kNan; }},
      {"sampler 0: lod range", [](auto& s) { s.samplers[0].min_lod = 1001; }},
      {"shader 1 'f': its words", [](auto& s) { s.shaders[1].spirv[0] = 1; }},
      {"shader 0 'v': its words", [](auto& s) { s.shaders[0].spirv.clear(); }},
      {"vertex shader 2 does not exist", [](auto& s) { s.pipelines[0].vertex_shader = 2; }},
      {"fragment shader 4294967295 does not exist", [](auto& s) { s.pipelines[0].fragment_shader = kNone; }},
      {"shader 1 is not a vertex shader", [](auto& s) { s.pipelines[0].vertex_shader = 1; }},
      {"binding 0 is given twice",
       [](auto& s) {
         s.pipelines[0].bindings.push_back({0, 4, false});
       }},
      {"binding 16 is outside",
       [](auto& s) {
         s.pipelines[0].bindings.push_back({16, 4, false});
       }},
      {"has stride 2052", [](auto& s) { s.pipelines[0].bindings[0].stride = 2052; }},
      {"location 0 is given twice",
       [](auto& s) {
         s.pipelines[0].attributes.push_back({0, 0, Format::kR32Float, 0});
       }},
      {"location 16 is outside", [](auto& s) { s.pipelines[0].attributes[0].location = 16; }},
      {"reads binding 4, which is not declared", [](auto& s) { s.pipelines[0].attributes[0].binding = 4; }},
      {"not one of an attribute",
       [](auto& s) { s.pipelines[0].attributes[0].format = Format::kR8G8B8A8Srgb; }},
      {"has offset 2048", [](auto& s) { s.pipelines[0].attributes[0].offset = 2048; }},
      {"write mask 0x1f", [](auto& s) { s.pipelines[0].blend[0].write_mask = 0x1f; }},
      {"buffer 3 does not exist", [](auto& s) { s.descriptor_sets[0].uniforms[0].buffer = 3; }},
      {"bytes 32+48", [](auto& s) { s.descriptor_sets[0].uniforms[0].offset = 32; }},
      {"bytes 4294967280+48", [](auto& s) { s.descriptor_sets[0].uniforms[0].offset = 0xfffffff0u; }},
      {"bytes 16+0", [](auto& s) { s.descriptor_sets[0].uniforms[0].range = 0; }},
      {"offset 8 is not a multiple", [](auto& s) { s.descriptor_sets[0].uniforms[0].offset = 8; }},
      {"descriptor set 0: binding 0 is given twice",
       [](auto& s) { s.descriptor_sets[0].textures[0].binding = 0; }},
      {"image 3 does not exist", [](auto& s) { s.descriptor_sets[0].textures[0].image = 3; }},
      {"image 1 'colour' is not for sampling", [](auto& s) { s.descriptor_sets[0].textures[0].image = 1; }},
      {"sampler 1 does not exist", [](auto& s) { s.descriptor_sets[0].textures[0].sampler = 1; }},
      {"image 1: size 64x0", [](auto& s) { s.images[1].height = 0; }},
      {"image 1 'colour': its format D32_SFLOAT is not one of a colour attachment",
       [](auto& s) { s.images[1].format = Format::kD32Float; }},
      {"image 2 'depth': its format R32_SFLOAT is not one of a depth attachment",
       [](auto& s) { s.images[2].format = Format::kR32Float; }},
      {"image 0 'white': its format R32G32B32_SFLOAT is not one of a texture",
       [](auto& s) { s.images[0].format = Format::kR32G32B32Float; }},
      {"image 1 'colour': usage 0x0 is not a set", [](auto& s) { s.images[1].usage = 0; }},
      {"image 1 'colour': usage 0x8 is not a set", [](auto& s) { s.images[1].usage = 8; }},
      {"image 1 'colour': 8 mip levels; 64x32 allows 1..7", [](auto& s) { s.images[1].levels = 8; }},
      {"image 0 'white': 257 layers; 1..256 are possible", [](auto& s) { s.images[0].layers = 257; }},
      {"image 0 'white': depth 2; 1..1 are possible", [](auto& s) { s.images[0].depth = 2; }},
      {"image 1 'colour': an attachment that is a volume",
       [](auto& s) { s.images[1].kind = ImageKind::k3D; }},
      {"a view '3d' of", [](auto& s) { s.descriptor_sets[0].textures[0].view = ViewKind::k3D; }},
      {"1 layers in a view 'cube'", [](auto& s) { s.descriptor_sets[0].textures[0].view = ViewKind::kCube; }},
      {"layers 0+2 of image 0", [](auto& s) { s.descriptor_sets[0].textures[0].layers = 2; }},
      {"sampler 0: 17 samples along an axis", [](auto& s) { s.samplers[0].max_anisotropy = 17; }},
      {"image 1 'colour': 0 layers; 1..256 are possible", [](auto& s) { s.images[1].layers = 0; }},
      {"image 1 'colour': 257 layers", [](auto& s) { s.images[1].layers = 257; }},
      {"levels 2+0 of image 0 'white', which has 2",
       [](auto& s) { s.descriptor_sets[0].textures[0].first_level = 2; }},
      {"levels 1+2 of image 0 'white', which has 2",
       [](auto& s) {
         s.descriptor_sets[0].textures[0].first_level = 1;
         s.descriptor_sets[0].textures[0].levels = 2;
       }},
      {"layer 1 of image 0 'white', which has 1",
       [](auto& s) { s.descriptor_sets[0].textures[0].layer = 1; }},
      {"image 1 'colour': 8191 bytes of texels where 64x32 with 1 levels takes 8192",
       [](auto& s) { s.images[1].texels.resize(std::size_t{4} * 64 * 32 - 1); }},
      {"image 1 'colour': an attachment of 4 samples a pixel brings texels; one of 1 may",
       [](auto& s) {
         s.images[1].texels.resize(std::size_t{4} * 64 * 32);
         s.images[1].samples = 4;
       }},
      {"image 1 'colour': an attachment that is packed",
       [](auto& s) { s.images[1].packed = std::make_shared<const UnpackTexels>(); }},
      {"image 2 'depth': it begins with a depth of 2, which is outside 0..1",
       [](auto& s) {
         const float depth = 2;
         s.images[2].texels.resize(std::size_t{4} * 64 * 32);
         std::memcpy(&s.images[2].texels[400], &depth, sizeof depth);
       }},
  });
}

TEST_CASE("validate: passes and bound state") {
  expect({
      {"command 1: a render pass begins inside another", [](auto& s) { s.commands[1] = BeginPass{}; }},
      {"the last render pass is not ended", [](auto& s) { s.commands.pop_back(); }},
      {"command 11: a render pass ends that has not begun",
       [](auto& s) { s.commands.emplace_back(EndPass{}); }},
      {"there is no render pass", [](auto& s) { s.commands.clear(); }},
      {"command 0: draw outside a render pass", [](auto& s) { s.commands[0] = Draw{}; }},
      {"image 7 does not exist", [](auto& s) { command<BeginPass>(s, 0).colors[0].image = 7; }},
      {"depth attachment: image 7 does not exist", [](auto& s) { command<BeginPass>(s, 0).depth.image = 7; }},
      {"colour attachment: image 0 'white' is not for that use",
       [](auto& s) { command<BeginPass>(s, 0).colors[0].image = 0; }},
      {"depth attachment: image 1 'colour' is not for that use",
       [](auto& s) { command<BeginPass>(s, 0).depth.image = 1; }},
      {"depth attachment: image 2 of 64x31 beside one of 64x32", [](auto& s) { s.images[2].height = 31; }},
      {"image 1 is attached twice",
       [](auto& s) {
         auto& colors = command<BeginPass>(s, 0).colors;
         colors.push_back(colors[0]);
       }},
      {"9 colour attachments", [](auto& s) { command<BeginPass>(s, 0).colors.resize(9); }},
      {"a render pass without attachments", [](auto& s) { command<BeginPass>(s, 0) = {}; }},
      {"the last render pass has no colours to show",
       [](auto& s) { command<BeginPass>(s, 0).colors.clear(); }},
      {"image 1 is loaded before a pass has stored it",
       [](auto& s) { command<BeginPass>(s, 0).colors[0].load = LoadOp::kLoad; }},
      {"image 2 is loaded before a pass has stored it",
       [](auto& s) {
         command<BeginPass>(s, 0).depth.store = StoreOp::kDiscard;
         BeginPass again = command<BeginPass>(s, 0);
         again.depth.load = LoadOp::kLoad;
         s.commands.emplace_back(again);
         s.commands.emplace_back(EndPass{});
       }},
      {"clear colour is not finite", [](auto& s) { command<BeginPass>(s, 0).colors[0].clear[2] = kNan; }},
      {"clear depth", [](auto& s) { command<BeginPass>(s, 0).depth.clear = kNan; }},
      {"command 8: draw without a viewport", [](auto& s) { s.commands[1] = s.commands[4]; }},
      {"command 8: draw without a scissor", [](auto& s) { s.commands[2] = s.commands[4]; }},
      {"command 8: draw without a pipeline", [](auto& s) { s.commands[3] = s.commands[4]; }},
      {"command 8: draw without a vertex buffer at binding 0",
       [](auto& s) { s.commands[5] = s.commands[4]; }},
      {"command 8: indexed draw without an index buffer", [](auto& s) { s.commands[6] = s.commands[4]; }},
      {"pipeline 1 does not exist", [](auto& s) { command<BindPipeline>(s, 3).pipeline = 1; }},
      {"descriptor set number 4", [](auto& s) { command<BindDescriptorSet>(s, 4).set = 4; }},
      {"descriptor set 1 does not exist", [](auto& s) { command<BindDescriptorSet>(s, 4).descriptors = 1; }},
      {"vertex binding 16", [](auto& s) { command<BindVertexBuffer>(s, 5).binding = 16; }},
      {"buffer 9 does not exist", [](auto& s) { command<BindVertexBuffer>(s, 5).buffer = 9; }},
      {"offset 37 is beyond buffer 0", [](auto& s) { command<BindVertexBuffer>(s, 5).offset = 37; }},
      {"index buffer 9 does not exist", [](auto& s) { command<BindIndexBuffer>(s, 6).buffer = 9; }},
      {"index offset 1 is not a multiple",
       [](auto& s) {
         s.commands[6] = BindIndexBuffer{1, 1, IndexType::kUint16};
       }},
      {"pipeline 0 'p': 0 viewports; 1..16 are possible", [](auto& s) { s.pipelines[0].viewports = 0; }},
      {"pipeline 0 'p': 17 viewports", [](auto& s) { s.pipelines[0].viewports = 17; }},
      {"command 8: draw without a viewport 1", [](auto& s) { s.pipelines[0].viewports = 2; }},
      {"command 8: draw without a scissor 1",
       [](auto& s) {
         s.pipelines[0].viewports = 2;
         s.commands[4] = SetViewport{0, 0, 8, 8, 0, 1, 1};
       }},
      {"command 1: viewport 16 is set; there are 16", [](auto& s) { command<SetViewport>(s, 1).index = 16; }},
      {"command 2: scissor 16 is set", [](auto& s) { command<SetScissor>(s, 2).index = 16; }},
      {"viewport", [](auto& s) { command<SetViewport>(s, 1).x = kNan; }},
      {"viewport", [](auto& s) { command<SetViewport>(s, 1).width = kNan; }},
      {"viewport", [](auto& s) { command<SetViewport>(s, 1).height = 0; }},
      {"viewport", [](auto& s) { command<SetViewport>(s, 1).width = 16385; }},
      {"viewport depth", [](auto& s) { command<SetViewport>(s, 1).max_depth = 1.5F; }},
      {"scissor corner", [](auto& s) { command<SetScissor>(s, 2).x = -1; }},
      {"outside the target of 64x32", [](auto& s) { command<SetScissor>(s, 2).x = 1; }},
      {"outside the target of 64x32",
       [](auto& s) {
         command<SetScissor>(s, 2) = {0x7fffffff, 0, 0xffffffffu, 1};
       }},
      {"push constants", [](auto& s) { command<PushConstants>(s, 7).offset = 244; }},
      {"push constants", [](auto& s) { command<PushConstants>(s, 7).offset = 0xfffffff0u; }},
      {"push constants", [](auto& s) { command<PushConstants>(s, 7).offset = 2; }},
      {"push constants", [](auto& s) { command<PushConstants>(s, 7).data.clear(); }},
      {"without depth", [](auto& s) { command<BeginPass>(s, 0).depth.image = kNone; }},
  });
}

TEST_CASE("validate: bytes that a draw would fetch") {
  expect({
      {"vertex 3 at location 0 ends at byte 48 of buffer 0, which has 36",
       [](auto& s) { command<Draw>(s, 9).count = 4; }},
      {"vertex 3 at location 0", [](auto& s) { s.buffers[1].data[1] = std::byte{3}; }},
      {"vertex 3 at location 0", [](auto& s) { command<Draw>(s, 8).vertex_offset = 1; }},
      {"vertices -1..1", [](auto& s) { command<Draw>(s, 8).vertex_offset = -1; }},
      {"indices 1+3 reach beyond", [](auto& s) { command<Draw>(s, 8).first = 1; }},
      {"indices 4294967295+3 reach beyond", [](auto& s) { command<Draw>(s, 8).first = 0xffffffffu; }},
      {"indices 0+4 reach beyond", [](auto& s) { command<Draw>(s, 8).count = 4; }},
      {"ends at byte 37", [](auto& s) { s.pipelines[0].attributes[0].offset = 1; }},
      {"ends at byte 40", [](auto& s) { command<BindVertexBuffer>(s, 5).offset = 4; }},
      {"vertex number 4294967297", [](auto& s) { command<Draw>(s, 9).first = 0xffffffffu; }},
      {"instance number 4294967296",
       [](auto& s) { command<Draw>(s, 9).instances = 2, command<Draw>(s, 9).first_instance = 0xffffffffu; }},
      {"more than 4294967296 vertices", [](auto& s) { command<Draw>(s, 9).instances = 0xffffffffu; }},
      {"instance 3 at location 0",
       [](auto& s) { s.pipelines[0].bindings[0].per_instance = true, command<Draw>(s, 9).instances = 4; }},
  });
}

TEST_CASE("validate: only the indices that a draw uses count") {
  CommandStream stream = small_stream();
  stream.buffers[1].data = {std::byte{255}, std::byte{0}, std::byte{1}, std::byte{2}, std::byte{255}};
  command<Draw>(stream, 8).first = 1;
  REQUIRE(refusal(stream) == "accepted");
  command<Draw>(stream, 8).first = 2;
  REQUIRE_THAT(refusal(stream), Catch::Contains("vertex 255"));
}

TEST_CASE("validate: an empty draw fetches nothing") {
  CommandStream stream = small_stream();
  command<Draw>(stream, 8) = Draw{true, 0, 1000, -5, 1, 0, ""};
  command<Draw>(stream, 9) = Draw{false, 1000, 1000, 0, 0, 0, ""};
  REQUIRE(refusal(stream) == "accepted");
}
