/// Shaders of clears: a colour attachment of any number and of any kind of numbers gets the value.
#include <catch2/catch.hpp>

#include <cstring>

#include "models/precision.h"
#include "pipeline/frame_contents.h"
#include "traces/capture/own_shaders.h"
#include "traces/command_stream.h"

namespace quadrille::capture {
namespace {

/// Three attachments that are cleared to zeros; a draw clears the middle one to `color`.
traces::CommandStream stream_of(traces::Format format, OwnShader shader,
                                const std::array<std::uint32_t, 4>& color) {
  traces::CommandStream stream;
  traces::BeginPass pass;
  for (const traces::Format of : {traces::Format::kR8G8B8A8Unorm, format, traces::Format::kR8G8B8A8Unorm}) {
    traces::Image image;
    image.format = of;
    image.width = image.height = 4;
    image.usage = traces::kColorAttachment;
    pass.colors.emplace_back().image = static_cast<traces::Index>(stream.images.size());
    pass.colors.back().clear = {0, 0, 0, 0};
    pass.colors.back().clear_integers = {0, 0, 0, 0};
    stream.images.push_back(image);
  }
  stream.shaders.push_back({"area", traces::ShaderStage::kVertex, own_shader(OwnShader::kArea)});
  stream.shaders.push_back({"clear", traces::ShaderStage::kFragment, own_shader(shader, 1)});
  traces::Pipeline pipeline;
  pipeline.vertex_shader = 0;
  pipeline.fragment_shader = 1;
  for (std::size_t i = 0; i < pipeline.blend.size(); ++i) pipeline.blend[i].write_mask = i == 1 ? 0xf : 0;
  stream.pipelines.push_back(pipeline);
  traces::PushConstants push;
  push.data.resize(sizeof(AreaConstants));
  std::memcpy(push.data.data(), color.data(), sizeof color);
  traces::Draw draw;
  draw.count = 3;
  stream.commands = {pass,
                     traces::BindPipeline{0},
                     traces::SetViewport{0, 0, 4, 4, 0, 1},
                     traces::SetScissor{1, 2, 3, 2},
                     push,
                     draw,
                     traces::EndPass{}};
  traces::validate(stream);
  return stream;
}

}  // namespace

TEST_CASE("capture: a clear's shader writes floats and integers to the attachment of its location") {
  struct Case {
    traces::Format format;
    OwnShader shader;
    std::array<std::uint32_t, 4> color;
    std::vector<int> bytes;  ///< of a pixel
  };
  const std::vector<Case> cases{
      {traces::Format::kR8G8B8A8Unorm, OwnShader::kClear, {0x3f800000, 0, 0x3f800000, 0}, {255, 0, 255, 0}},
      {traces::Format::kR8G8B8A8Uint, OwnShader::kClearUnsigned, {7, 200, 3, 4}, {7, 200, 3, 4}},
      {traces::Format::kR8G8B8A8Sint, OwnShader::kClearSigned, {0xfffffffe, 5, 6, 7}, {254, 5, 6, 7}}};
  for (const Case& one : cases) {
    const traces::FrameContents left =
        pipeline::contents_after(stream_of(one.format, one.shader, one.color), models::Precision{});
    REQUIRE(left.parts.size() == 3);
    for (std::size_t attachment = 0; attachment < 3; ++attachment)
      for (std::size_t pixel = 0; pixel < 16; ++pixel)
        for (std::size_t c = 0; c < 4; ++c) {
          const bool written = attachment == 1 && pixel % 4 >= 1 && pixel / 4 >= 2;
          CAPTURE(attachment, pixel, c);
          CHECK(std::to_integer<int>(left.parts[attachment].texels[4 * pixel + c]) ==
                (written ? one.bytes[c] : 0));
        }
  }
}

}  // namespace quadrille::capture
