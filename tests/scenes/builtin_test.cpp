#include "scenes/builtin/builtin.h"

#include <catch2/catch.hpp>
#include <set>

#include "models/base/error.h"
#include "scenes/scene.h"
#include "traces/trace_file.h"

using namespace quadrille;
using namespace quadrille::scenes;

TEST_CASE("built-in scenes: every listed one records, in colour and in visibility mode, the same twice") {
  for (const BuiltinScene& scene : builtin_scenes()) {
    CAPTURE(std::string(scene.name));
    const std::string name = "builtin:" + std::string(scene.name);
    SceneOptions options;
    const traces::CommandStream stream = load_scene(name, options);
    REQUIRE(traces::stream_totals(stream).triangles > 0);
    REQUIRE(load_scene(name, options) == stream);
    options.visibility = true;
    if (scene.name == "blends") {  // has no triangles of its own
      REQUIRE_THROWS_WITH(load_scene(name, options), Catch::Contains("a picture of its triangles"));
      continue;
    }
    // A second pass over the picture draws one triangle, and there is none over triangle numbers.
    const traces::StreamTotals totals = traces::stream_totals(stream);
    const std::uint64_t triangles = traces::stream_totals(load_scene(name, options)).triangles;
    if (totals.passes <= 2) REQUIRE(triangles == totals.triangles - (totals.passes - 1));
    else REQUIRE(triangles < totals.triangles);
  }
}

TEST_CASE("built-in scenes: an unknown name lists the legal ones") {
  REQUIRE_THROWS_WITH(load_scene("builtin:castle", {}),
                      Catch::Contains("builtin:courtyard") && Catch::Contains("builtin:fill"));
}

TEST_CASE("built-in scenes: the courtyard has what a front page needs") {
  const traces::CommandStream stream = load_scene("builtin:courtyard", {});
  REQUIRE(traces::stream_totals(stream).triangles >= 100000);
  REQUIRE(traces::texture_count(stream) >= 10);
  REQUIRE(std::ranges::any_of(stream.pipelines,
                              [](const traces::Pipeline& p) { return p.blend[0].enable && !p.depth.write; }));
  REQUIRE(std::ranges::any_of(stream.pipelines,
                              [](const traces::Pipeline& p) { return p.cull == traces::CullMode::kNone; }));
}

TEST_CASE("built-in scenes: fill needs no depth, blending or textures") {
  const traces::CommandStream stream = load_scene("builtin:fill", {});
  REQUIRE(std::ranges::all_of(stream.images, &traces::Image::is_attachment));
  REQUIRE(traces::shown_target(stream).depth == traces::Format::kUndefined);
  for (const traces::Pipeline& p : stream.pipelines) REQUIRE_FALSE((p.blend[0].enable || p.depth.test));
}
