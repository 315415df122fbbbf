/// Textures of materials that blend: what is transparent in them shows nowhere, at no size.
#include <catch2/catch.hpp>

#include <glm/ext/matrix_transform.hpp>

#include "pipeline/render.h"
#include "scenes/builtin/mesh_builder.h"
#include "scenes/record/recorder.h"
#include "scenes/scene.h"

#include <algorithm>
#include <array>

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

/// A card before the plain background, with a texture of opaque red squares on transparent green.
SceneData card(AlphaMode alpha) {
  SceneData scene;
  scene.name = "card";
  Rgba8Image picture{64, 64, {}};
  for (std::uint32_t i = 0; i < 64 * 64; ++i) {
    const bool red = (i / 8 + i / 512) % 2 == 0;
    const std::array<std::uint8_t, 4> texel =
        red ? std::array<std::uint8_t, 4>{255, 0, 0, 255} : std::array<std::uint8_t, 4>{0, 255, 0, 0};
    picture.pixels.insert(picture.pixels.end(), texel.begin(), texel.end());
  }
  scene.images.emplace_back("squares", picture);
  Material m;
  m.unlit = true;
  m.alpha = alpha;
  m.texture(TextureSlot::kBaseColor).image = 0;
  scene.materials.push_back(m);
  MeshBuilder mesh;
  mesh.box(glm::vec3(-1, -1, -0.1F), glm::vec3(1, 1, 0), 1);
  place(scene, mesh.finish(scene, "card", 0, {}), glm::mat4(1));
  Camera camera;
  camera.pose = glm::translate(glm::mat4(1), glm::vec3(0, 0, 3));
  scene.cameras.push_back(camera);
  return scene;
}

struct Colors {
  int most_green = 0, most_red = 0, background_green = 0;
};

Colors drawn(AlphaMode alpha, std::uint32_t size) {
  SceneOptions options;
  options.width = options.height = size;
  const SceneData scene = card(alpha);
  const pipeline::FrameImage image =
      pipeline::render_functional_frame(Recorder(scene, options).record(), {}).image;
  Colors colors;
  colors.background_green = static_cast<int>(image.color[0] >> 8 & 255);
  for (const std::uint32_t pixel : image.color) {
    colors.most_red = std::max(colors.most_red, static_cast<int>(pixel & 255));
    colors.most_green = std::max(colors.most_green, static_cast<int>(pixel >> 8 & 255));
  }
  return colors;
}

}  // namespace

TEST_CASE("premultiplied textures: a blended texture's transparent texels bring no colour, near or far") {
  for (const std::uint32_t size : {400u, 96u, 24u, 6u}) {
    INFO(size << " pixels");
    const Colors blended = drawn(AlphaMode::kBlend, size), opaque = drawn(AlphaMode::kOpaque, size);
    CHECK(blended.most_green <= blended.background_green);
    CHECK(blended.most_red > blended.background_green + 20);
    CHECK(opaque.most_green >
          opaque.background_green + 10);  // as the file has them, where alpha counts for nothing
  }
}
