/// Scenes from outside: counts of triangles and draws as their manifest states them.
#include <catch2/catch.hpp>

#include "scenes/image/mip_chain.h"
#include "scenes/scene.h"
#include "tests/scenes/scene_folder.h"
#include "traces/trace_file.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

struct Expected {
  const char* file;
  std::uint64_t triangles, draws;
};

constexpr Expected kScenes[] = {{"Box/Box.gltf", 12, 1},
                                {"BoxVertexColors/BoxVertexColors.glb", 12, 1},
                                {"BoxTextured_interleaved/BoxTextured.gltf", 12, 1},
                                {"TextureTransformTest/TextureTransformTest.gltf", 24, 12},
                                {"ManyCubes_u8idx/many-cubes.gltf", 6012, 501},
                                {"CornellBox/CornellBox.glb", 36, 6},
                                {"Engine2Cyl/2CylinderEngine.glb", 121496, 115},
                                {"Suzanne/Suzanne.gltf", 3936, 1},
                                {"FlightHelmet_512/FlightHelmet.gltf", 94722, 6},
                                {"TerrainBevy/terrain.glb", 31422, 1},
                                {"STK_CandelaCity/candela_city.gltf", 444434, 2873}};

}  // namespace

TEST_CASE("real scenes: triangles and draws are those of the manifest, in colour and in visibility mode") {
  const auto folder = scene_folder();
  if (!folder) {
    WARN("skipped: no folder of scenes");
    return;
  }
  for (const Expected& expected : kScenes) {
    CAPTURE(expected.file);
    for (const bool visibility : {false, true}) {
      SceneOptions options;
      options.visibility = visibility;
      const traces::StreamTotals totals =
          traces::stream_totals(load_scene((*folder / expected.file).string(), options));
      REQUIRE(totals.triangles == expected.triangles);
      REQUIRE(totals.draws == expected.draws);
    }
  }
}

TEST_CASE("real scenes: images are read with their size, levels and colour space") {
  const auto folder = scene_folder();
  if (!folder) {
    WARN("skipped: no folder of scenes");
    return;
  }
  const traces::CommandStream stream =
      load_scene((*folder / "FlightHelmet_512/FlightHelmet.gltf").string(), {});
  REQUIRE(traces::texture_count(stream) == 15);
  std::size_t srgb = 0, large = 0;
  for (const traces::Image& image : stream.images) {
    if (image.is_attachment()) continue;
    REQUIRE(image.levels == full_chain_levels(image.width, image.height));
    large += image.width == 512 ? 1 : 0;
    srgb += image.format == traces::Format::kR8G8B8A8Srgb ? 1 : 0;
  }
  REQUIRE(srgb == 5);
  REQUIRE(large >= 12);
}
