/// Bumps and faces from both sides: a frame derived on the screen equals the one that tangents give, and a
/// face without normals is its own.
#include <catch2/catch.hpp>

#include <glm/ext/matrix_transform.hpp>

#include "models/reference/compare.h"
#include "pipeline/render.h"
#include "scenes/builtin/mesh_builder.h"
#include "scenes/record/recorder.h"

using namespace quadrille;
using namespace quadrille::scenes;
namespace ref = models::reference;

namespace {

constexpr std::uint32_t kSide = 96;

struct Sheet {
  bool tangents = false, normals = true, mirrored = false, back = false;
  TextureSlot slot = TextureSlot::kNormal;
  AlphaMode alpha = AlphaMode::kOpaque;
};

/// Ridges that slant, so that both of their directions count.
Rgba8Image ridges() {
  Rgba8Image image{32, 32, {}};
  for (std::uint32_t y = 0; y < 32; ++y) {
    for (std::uint32_t x = 0; x < 32; ++x) {
      const auto up = static_cast<std::uint8_t>((x + y) % 16 < 8 ? 190 : 66),
                 side = static_cast<std::uint8_t>((2 * x + y) % 16 < 8 ? 170 : 86);
      image.pixels.insert(image.pixels.end(), {up, side, 220, 255});
    }
  }
  return image;
}

SceneData scene_of(const Sheet& sheet) {
  SceneData scene;
  scene.name = "sheet";
  Material m;
  m.base_color = {0.8F, 0.6F, 0.3F, 0.9F};
  m.metallic = 0.2F;
  m.roughness = 0.5F;
  m.double_sided = true;
  m.alpha = sheet.alpha;
  m.texture(sheet.slot).image = add_image(scene, "ridges", ridges());
  if (sheet.slot == TextureSlot::kClearcoatNormal)
    m.layers.clearcoat = 1, m.layers.clearcoat_roughness = 0.4F;
  scene.materials.push_back(m);
  MeshBuilder mesh;
  for (int corner = 0; corner < 4; ++corner) {
    const auto u = static_cast<float>(corner & 1), v = static_cast<float>(corner >> 1);
    MeshBuilder::Vertex vertex;
    vertex.position = {2 * u - 1, 1 - 2 * v, 0};
    vertex.uv = {sheet.mirrored ? 1 - u : u, v};
    vertex.tangent = sheet.mirrored ? glm::vec4(-1, 0, 0, -1) : glm::vec4(1, 0, 0, 1);
    mesh.vertex(vertex);
  }
  mesh.triangle(0, 2, 3);
  mesh.triangle(0, 3, 1);
  const glm::mat4 turn =
      glm::rotate(glm::mat4(1), (sheet.back ? 3.14159265F : 0.0F) + 0.5F, glm::vec3(0.2F, 0.95F, 0.1F));
  place(scene,
        mesh.finish(scene, "sheet", 0,
                    {.normal = sheet.normals, .tangent = sheet.tangents, .uv = true, .color = false}),
        turn);
  Light lamp;
  lamp.kind = Light::Kind::kPoint;
  lamp.color = glm::vec3(40);
  lamp.position = {2, 1.5, 3};
  scene.lights.push_back(lamp);
  Camera camera;
  camera.pose = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, 2.6));
  scene.cameras.push_back(camera);
  return scene;
}

std::vector<std::uint32_t> picture(const SceneData& scene) {
  SceneOptions options;
  options.width = options.height = kSide;
  return pipeline::render_functional_frame(Recorder(scene, options).record(), {}).image.color;
}

std::vector<std::uint32_t> picture(const Sheet& sheet) { return picture(scene_of(sheet)); }

ref::ImageDifference difference(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  return ref::compare_images({kSide, kSide, a}, {kSide, kSide, b});
}

}  // namespace

TEST_CASE("normal maps: without tangents a double-sided sheet is drawn as with them, on both sides") {
  for (const TextureSlot slot : {TextureSlot::kNormal, TextureSlot::kClearcoatNormal}) {
    for (const AlphaMode alpha : {AlphaMode::kOpaque, AlphaMode::kMask, AlphaMode::kBlend}) {
      for (const bool mirrored : {false, true}) {
        for (const bool back : {false, true}) {
          CAPTURE(static_cast<int>(slot), static_cast<int>(alpha), mirrored, back);
          Sheet sheet{.mirrored = mirrored, .back = back, .slot = slot, .alpha = alpha};
          const auto derived = picture(sheet);
          sheet.tangents = true;
          const auto given = picture(sheet);
          CHECK(difference(derived, given).fraction_within(2) >= 0.999);
          // Nor does it matter whether normals of a flat sheet are given.
          sheet.tangents = sheet.normals = false;
          CHECK(difference(picture(sheet), given).fraction_within(2) >= 0.999);
        }
      }
    }
  }
}

TEST_CASE("normal maps: the ridges are seen, and differ from side to side") {
  Sheet sheet;
  const auto front = picture(sheet);
  sheet.back = true;
  const auto back = picture(sheet);
  SceneData smooth = scene_of(sheet);
  smooth.materials[0].texture(TextureSlot::kNormal).image = -1;
  CHECK(difference(back, picture(smooth)).fraction_within(8) < 0.8);
  CHECK(difference(back, front).fraction_within(8) < 0.8);
}

namespace {

void put_zeros(SceneData& scene, std::size_t first, std::size_t count) {
  Primitive& primitive = scene.primitives[0];
  Array& normals = scene.arrays[static_cast<std::size_t>(primitive.attributes[1])];
  std::fill_n(normals.data.begin() + static_cast<std::ptrdiff_t>(sizeof(glm::vec3) * first),
              sizeof(glm::vec3) * count, std::byte{0});
  primitive.partial_normals = true;
}

}  // namespace

TEST_CASE(
    "faces whose normals are all zero are drawn with their own, on both sides, with bumps and without") {
  for (const bool back : {false, true}) {
    for (const bool bumps : {false, true}) {
      for (const bool tangents : {false, true}) {
        CAPTURE(back, bumps, tangents);
        SceneData with = scene_of({.tangents = tangents, .back = back}),
                  without = scene_of({.normals = false, .back = back});
        if (!bumps)
          with.materials[0].texture(TextureSlot::kNormal).image =
              without.materials[0].texture(TextureSlot::kNormal).image = -1;
        put_zeros(with, 0, 4);
        CHECK(difference(picture(with), picture(without)).fraction_within(2) >= 0.999);
      }
    }
  }
}

TEST_CASE("a vertex without a normal leaves the direction of its face's others") {
  SceneData whole = scene_of({}), partial = scene_of({});
  put_zeros(partial, 1, 1);
  CHECK(difference(picture(partial), picture(whole)).fraction_within(2) >= 0.995);
}
