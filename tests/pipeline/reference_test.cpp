/// The machine against the double-precision reference in *given* mode: the same snapped triangles and
/// precisions, none of the same code.
#include "models/reference/compare.h"
#include "scenes/scene.h"
#include "studies/given_reference.h"
#include "tests/pipeline/random_stream.h"
#include "tests/scenes/scene_folder.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <filesystem>

using namespace quadrille;
namespace ref = models::reference;

namespace {

constexpr std::uint32_t kWidth = 400, kHeight = 225;

void check_scene(const std::string& scene, scenes::SceneOptions options = {}) {
  INFO(scene);
  options.width = kWidth;
  options.height = kHeight;
  const auto color = studies::render_with_reference(scenes::load_scene(scene, options), {});
  const auto difference =
      ref::compare_images({kWidth, kHeight, color.machine.color}, {kWidth, kHeight, color.reference.color});
  CHECK(difference.fraction_within(2) >= 0.999);
  CHECK(difference.bad_blocks == 0);

  options.visibility = true;
  const auto ids = studies::render_with_reference(scenes::load_scene(scene, options), {});
  std::size_t other_coverage = 0, alpha_ties = 0;
  for (std::size_t i = 0; i < ids.machine.color.size(); ++i) {
    if ((ids.machine.color[i] == 0) == (ids.reference.color[i] == 0)) continue;
    // An alpha within one code of its cut-off may fall on either side.
    ++(ids.reference.alpha_margin[i] <= 1.0f / 255.0f ? alpha_ties : other_coverage);
  }
  CHECK(other_coverage == 0);
  CHECK(alpha_ties <= kWidth * kHeight / 1000);
}

}  // namespace

TEST_CASE("machine: built-in scenes equal the reference in given mode") {
  for (const char* scene :
       {"builtin:triangle", "builtin:quad", "builtin:cubes", "builtin:outlines", "builtin:shadow",
        "builtin:deferred", "builtin:glow", "builtin:overdraw", "builtin:fill", "builtin:cycle",
        "builtin:flag", "builtin:courtyard", "builtin:materials", "builtin:primitives", "builtin:glass"})
    check_scene(scene);
}

TEST_CASE("machine: the lectures' pipelines equal the reference in given mode") {
  using namespace scenes;
  for (const char* scene : {"builtin:cubes", "builtin:flag", "builtin:cycle"}) {
    for (const Shading shading : {Shading::kMinimal, Shading::kFlat, Shading::kGouraud, Shading::kPhong}) {
      SceneOptions options;
      options.shading = shading;
      check_scene(scene, options);
    }
    SceneOptions painter;
    painter.order = DrawOrder::kPainter;
    check_scene(scene, painter);
    for (const Showing shown : {Showing::kDepth, Showing::kOverdraw, Showing::kUv, Showing::kNormal,
                                Showing::kTriangle, Showing::kSamples, Showing::kLevel}) {
      SceneOptions options;
      options.shown = shown;
      check_scene(scene, options);
    }
  }
}

TEST_CASE(
    "machine: scenes of four samples, by sample and covered by alpha, equal the reference in given mode") {
  for (const char* scene : {"builtin:cubes", "builtin:flag", "builtin:courtyard"}) {
    for (const bool by_sample : {false, true}) {
      scenes::SceneOptions options;
      options.width = 200;
      options.height = 112;
      options.alpha_to_coverage = true;
      traces::CommandStream stream = scenes::load_scene(scene, options);
      traces::use_samples(stream, 4);
      if (by_sample) traces::use_sample_shading(stream);
      const auto both = studies::render_with_reference(stream, {});
      const auto difference =
          ref::compare_images({both.machine.width, both.machine.height, both.machine.color},
                              {both.machine.width, both.machine.height, both.reference.color});
      INFO(scene << (by_sample ? ", by sample" : ", by pixel"));
      CHECK(difference.fraction_within(2) >= 0.999);
      CHECK(difference.bad_blocks == 0);
    }
  }
}

TEST_CASE("machine: random points, lines and triangles equal the reference in given mode") {
  std::size_t pixels = 0, other = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const auto both = studies::render_with_reference(pipeline::test::random_primitives(seed), {});
    const auto& ours = both.machine;
    const auto difference = ref::compare_images({ours.width, ours.height, ours.color},
                                                {ours.width, ours.height, both.reference.color});
    pixels += ours.color.size();
    other += ours.color.size() - static_cast<std::size_t>(std::lround(
                                     difference.fraction_within(2) * static_cast<double>(ours.color.size())));
    INFO("seed " << seed << ": within 2: " << difference.fraction_within(2));
    CHECK(difference.bad_blocks == 0);
  }
  CHECK(static_cast<double>(other) <= 0.001 * static_cast<double>(pixels));
}

TEST_CASE("machine: real scenes equal the reference in given mode") {
  const auto folder = scenes::scene_folder();
  if (!folder) {
    WARN("skipped: the folder of real scenes is absent");
    return;
  }
  for (const char* scene :
       {"Box/Box.gltf", "BoxVertexColors/BoxVertexColors.glb", "BoxTextured_interleaved/BoxTextured.gltf",
        "CornellBox/CornellBox.glb", "TextureTransformTest/TextureTransformTest.gltf", "Suzanne/Suzanne.gltf",
        "ManyCubes_u8idx/many-cubes.gltf", "TerrainBevy/terrain.glb", "Engine2Cyl/2CylinderEngine.glb",
        "FlightHelmet_512/FlightHelmet.gltf", "STK_CandelaCity/candela_city.gltf"}) {
    check_scene((*folder / scene).string());
  }
}
