/// Built-in frames of several passes: which passes they have, and what they refuse.
#include <catch2/catch.hpp>

#include <algorithm>

#include "models/base/error.h"
#include "scenes/scene.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

std::vector<traces::BeginPass> passes_of(const traces::CommandStream& stream) {
  std::vector<traces::BeginPass> passes;
  for (const traces::Command& command : stream.commands)
    if (const auto* begin = std::get_if<traces::BeginPass>(&command)) passes.push_back(*begin);
  return passes;
}

SceneOptions small() {
  SceneOptions options;
  options.width = 64;
  options.height = 36;
  return options;
}

/// Does a draw of the stream read the image as a texture?
bool sampled(const traces::CommandStream& stream, traces::Index image) {
  return std::ranges::any_of(stream.descriptor_sets, [&](const traces::DescriptorSet& set) {
    return std::ranges::find(set.textures, image, &traces::TextureDescriptor::image) != set.textures.end();
  });
}

}  // namespace

TEST_CASE("passes: the shadow map is a pass of depths alone that the next one samples") {
  const traces::CommandStream stream = load_scene("builtin:shadow", small());
  const std::vector<traces::BeginPass> passes = passes_of(stream);
  REQUIRE(passes.size() == 3);
  CHECK(passes[0].colors.empty());
  CHECK(stream.images[passes[0].depth.image].width == 1024);
  CHECK(sampled(stream, passes[0].depth.image));
  CHECK(stream.images[passes[1].colors[0].image].format == traces::Format::kR16G16B16A16Float);
  CHECK(sampled(stream, passes[1].colors[0].image));
  CHECK(stream.images[passes[2].colors[0].image].format == traces::Format::kR8G8B8A8Srgb);
}

TEST_CASE("passes: deferred shading draws surfaces first, and every light reads them") {
  SceneOptions options = small();
  options.depth_format = traces::Format::kD16Unorm;
  options.color_format = traces::Format::kB8G8R8A8Srgb;
  const traces::CommandStream stream = load_scene("builtin:deferred", options);
  const std::vector<traces::BeginPass> passes = passes_of(stream);
  REQUIRE(passes.size() == 3);
  REQUIRE(passes[0].colors.size() == 2);
  for (const traces::ColorAttachmentUse& color : passes[0].colors) CHECK(sampled(stream, color.image));
  CHECK(sampled(stream, passes[0].depth.image));
  CHECK(stream.images[passes[0].depth.image].format == traces::Format::kD16Unorm);
  CHECK(passes[1].depth.image == traces::kNone);
  CHECK(stream.images[passes[2].colors[0].image].format == traces::Format::kB8G8R8A8Srgb);
  CHECK(stream.images[passes[2].colors[0].image].width == 64);
}

TEST_CASE("passes: the camera moves what they show") {
  SceneOptions options = small();
  options.eye = glm::vec3(3, 2, 1);
  const auto uniforms = [](const traces::CommandStream& stream) {
    const auto frame = std::ranges::find(stream.buffers, "frame", &traces::Buffer::name);
    REQUIRE(frame != stream.buffers.end());
    return frame->data;
  };
  CHECK(uniforms(load_scene("builtin:shadow", options)) != uniforms(load_scene("builtin:shadow", small())));
}

TEST_CASE("passes: other pictures and shaders are refused, a picture of triangles is one pass") {
  for (const char* scene : {"builtin:shadow", "builtin:deferred", "builtin:glow"}) {
    const auto refused = [&](const auto& change, const char* what) {
      SceneOptions options = small();
      change(options);
      CHECK_THROWS_WITH(load_scene(scene, options), Catch::Contains(scene) && Catch::Contains(what));
    };
    refused([](SceneOptions& o) { o.shading = Shading::kFlat; }, "--shading");
    refused([](SceneOptions& o) { o.order = DrawOrder::kPainter; }, "--order");
    refused([](SceneOptions& o) { o.shown = Showing::kNormal; }, "--view");
    refused([](SceneOptions& o) { o.alpha_to_coverage = true; }, "--alpha-to-coverage");
    refused([](SceneOptions& o) { o.fragment_shader = "mine.frag"; }, "a shader of yours");
    SceneOptions ids = small();
    ids.visibility = true;
    CHECK(passes_of(load_scene(scene, ids)).size() == 1);
  }
}
