/// A texture is unpacked when something first samples it, and not at all when nothing does.
#include <catch2/catch.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "models/base/error.h"
#include "pipeline/render.h"
#include "scenes/scene.h"
#include "tests/hw/contract.h"
#include "traces/trace_file.h"

namespace quadrille {
namespace {

scenes::SceneOptions small(bool packed) {
  scenes::SceneOptions options;
  options.width = 64;
  options.height = 36;
  options.keep_packed = packed;
  return options;
}

/// The scene with its textures packed; `unpacked` counts how often one is asked for.
traces::CommandStream counted(scenes::SceneOptions options, const std::shared_ptr<int>& unpacked) {
  options.keep_packed = true;
  traces::CommandStream stream = scenes::load_scene("builtin:cubes", options);
  REQUIRE(traces::texture_count(stream) > 0);
  for (traces::Image& image : stream.images) {
    if (image.is_attachment()) continue;
    REQUIRE(image.packed);
    CHECK(image.texels.empty());
    image.packed = std::make_shared<const traces::UnpackTexels>(
        [inner = image.packed, unpacked](const traces::LevelSink& sink) {
          ++*unpacked;
          (*inner)(sink);
        });
  }
  return stream;
}

/// A view from within the void, away from the scene: no fragment of it.
scenes::SceneOptions looking_away() {
  scenes::SceneOptions options = small(true);
  options.eye = glm::vec3(0, 500, 0);
  options.at = glm::vec3(0, 1000, 1);
  return options;
}

bool names_texels(const pipeline::Figures& figures) {
  return std::ranges::any_of(figures.left_out, [](const pipeline::LeftOut& l) { return l.what == "texels"; });
}

/// The picture of a machine as text, and what it unpacked; or its error.
std::string exact(const traces::CommandStream& stream, const std::shared_ptr<int>& unpacked,
                  bool leave_out = true) {
  return hw::contract::in_child([&]() -> std::string {
    try {
      const pipeline::RenderedFrame frame = pipeline::render_exact(stream, {}, {.leave_out = leave_out});
      return fmt::format("{} {} {} {}", frame.figures.frame.cycles, fmt::join(frame.image.color, " "),
                         *unpacked, names_texels(frame.figures));
    } catch (const UserError& error) { return error.what(); }
  });
}

TEST_CASE(
    "texture fill: each texture that fragments sample is unpacked once, and the picture is that of an "
    "unpacked stream") {
  const auto unpacked = std::make_shared<int>(0);
  const traces::CommandStream stream = counted(small(true), unpacked);
  const pipeline::RenderedFrame frame = pipeline::render_functional_frame(stream, {});
  CHECK(*unpacked == static_cast<int>(traces::texture_count(stream)));
  CHECK_FALSE(names_texels(frame.figures));
  const traces::CommandStream whole = scenes::load_scene("builtin:cubes", small(false));
  CHECK(frame.image.color == pipeline::render_functional_frame(whole, {}).image.color);
  *unpacked = 0;
  // what the other side will have counted
  const auto one = std::make_shared<int>(static_cast<int>(traces::texture_count(whole)));
  CHECK(exact(stream, unpacked) == exact(whole, one));
}

TEST_CASE("texture fill: a texture that no fragment samples is never unpacked, and the report says so") {
  const auto unpacked = std::make_shared<int>(0);
  const traces::CommandStream stream = counted(looking_away(), unpacked);
  const pipeline::RenderedFrame frame = pipeline::render_functional_frame(stream, {});
  CHECK(*unpacked == 0);
  CHECK(names_texels(frame.figures));
  CHECK_THAT(exact(stream, unpacked), Catch::EndsWith(" 0 true"));
  CHECK_THAT(exact(stream, unpacked, false),
             Catch::EndsWith(fmt::format(" {} false", traces::texture_count(stream))));
}

TEST_CASE(
    "texture fill: an image that cannot be unpacked ends the run with its own error, where something samples "
    "it") {
  const auto broken = [](const scenes::SceneOptions& options) {
    traces::CommandStream stream = scenes::load_scene("builtin:cubes", options);
    for (traces::Image& image : stream.images) {
      if (image.is_attachment()) continue;
      image.packed = std::make_shared<const traces::UnpackTexels>(
          [](const traces::LevelSink&) { throw user_error("a.png: torn"); });
    }
    return stream;
  };
  const auto none = std::make_shared<int>(0);
  CHECK_THROWS_WITH(pipeline::render_functional_frame(broken(small(true)), {}), "a.png: torn");
  CHECK(exact(broken(small(true)), none) == "a.png: torn");
  CHECK_NOTHROW(pipeline::render_functional_frame(broken(looking_away()), {}));
}

TEST_CASE("texture fill: packed and unpacked streams hold the same, and a trace holds texels") {
  traces::CommandStream packed = scenes::load_scene("builtin:cubes", small(true));
  const traces::CommandStream whole = scenes::load_scene("builtin:cubes", small(false));
  CHECK(traces::stream_totals(packed).image_bytes == traces::stream_totals(whole).image_bytes);
  for (traces::Image& image : packed.images) traces::unpack(image);
  CHECK(packed == whole);
  CHECK(traces::decode_trace(traces::encode_trace(packed), "t") == whole);
}

}  // namespace
}  // namespace quadrille
