/// Instanced draws and layered materials through the machine: the same picture as without them, and on every
/// machine.
#include <catch2/catch.hpp>

#include <glm/ext/matrix_transform.hpp>

#include "pipeline/compiler/compile.h"
#include "pipeline/render.h"
#include "pipeline/report/report.h"
#include "scenes/builtin/mesh_builder.h"
#include "scenes/record/recorder.h"
#include "scenes/scene.h"
#include "tests/hw/contract.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

/// Boxes turned, stretched and, some of them, mirrored; as copies of instanced draws or one by one.
SceneData boxes(bool instanced, bool blended, bool mirrors = true) {
  SceneData scene;
  scene.name = "boxes";
  Material m;
  m.metallic = 0;
  m.base_color = {0.9F, 0.6F, 0.3F, 0.5F};
  if (blended) m.alpha = AlphaMode::kBlend;
  scene.materials.push_back(m);
  MeshBuilder mesh;
  mesh.box(glm::vec3(-0.5F), glm::vec3(0.5F, 0.25F, 0.5F), 1);
  const std::uint32_t box = mesh.finish(scene, "box", 0, {});
  Camera camera;
  camera.pose = glm::translate(glm::mat4(1), glm::vec3(2, 2, 6));
  scene.cameras.push_back(camera);
  std::array<std::vector<glm::dmat4>, 2> sides;
  for (int i = 0; i < 12; ++i) {
    const glm::mat4 at = glm::translate(
        glm::mat4(1), glm::vec3(1.5F * static_cast<float>(i % 4), 1.5F * static_cast<float>(i / 4),
                                -0.3F * static_cast<float>(i)));
    const glm::mat4 turned = glm::rotate(at, 0.4F * static_cast<float>(i), glm::vec3(0.6F, 0.8F, 0));
    const bool mirrored = mirrors && i % 3 == 0;
    sides[mirrored ? 1 : 0].emplace_back(
        glm::scale(turned, glm::vec3(mirrored ? -1.0F : 1.0F, 0.4F + 0.1F * static_cast<float>(i), 1)));
  }
  for (const auto& side : sides) {
    if (side.empty()) continue;
    if (instanced) {
      scene.instances.push_back({box, glm::mat4(1), "boxes", static_cast<int>(scene.copies.size())});
      scene.copies.push_back(side);
    } else {
      for (const glm::dmat4& world : side) place(scene, box, glm::mat4(world));
    }
  }
  return scene;
}

SceneOptions small(std::uint32_t width, std::uint32_t height) {
  SceneOptions options;
  options.width = width;
  options.height = height;
  return options;
}

pipeline::FrameImage functional(const traces::CommandStream& stream) {
  return pipeline::render_functional_frame(stream, {}).image;
}

std::size_t differing(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  std::size_t count = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) count += a[i] == b[i] ? 0 : 1;
  return count;
}

/// Empty where the machine's picture is `expected` and it keeps all laws.
std::string exact_differs(const traces::CommandStream& stream, const std::string& machine,
                          const std::vector<std::uint32_t>& expected) {
  return hw::contract::in_child([&]() -> std::string {
    pipeline::MachineConfig config;
    pipeline::load_machine(config, machine);
    const pipeline::RenderedFrame frame = pipeline::render_exact(stream, config);
    if (frame.image.color != expected) return "another picture";
    if (!frame.figures.checks_hold()) return pipeline::failed_checks(frame.figures);
    return "";
  });
}

}  // namespace

TEST_CASE("instanced draws: the picture is that of the copies one by one, mirrored and stretched ones too") {
  const SceneOptions options = small(160, 120);
  const SceneData together = boxes(true, false), apart = boxes(false, false);
  const traces::CommandStream stream = Recorder(together, options).record();
  const pipeline::FrameImage image = functional(stream);
  CHECK(differing(image.color, functional(Recorder(apart, options).record()).color) == 0);
  CHECK(exact_differs(stream, "default", image.color) == "");
  SceneOptions ids = options;
  ids.visibility = true;
  CHECK(differing(functional(Recorder(together, ids).record()).color,
                  functional(Recorder(apart, ids).record()).color) == 0);
}

TEST_CASE("instanced draws: blended copies are drawn as the copies one by one, from back to front") {
  const SceneOptions options = small(160, 120);
  const traces::CommandStream stream = Recorder(boxes(true, true, false), options).record();
  const pipeline::FrameImage image = functional(stream);
  CHECK(differing(image.color, functional(Recorder(boxes(false, true, false), options).record()).color) == 0);
  CHECK(differing(image.color, functional(Recorder(boxes(true, false, false), options).record()).color) > 0);
  CHECK(exact_differs(stream, "default", image.color) == "");
  // Those that mirror are a draw of their own, behind the others or before them.
  const traces::CommandStream sides = Recorder(boxes(true, true), options).record();
  CHECK(exact_differs(sides, "small", functional(sides).color) == "");
}

namespace {

/// Every texture, transformed, every layer and every kind of light at once.
SceneData everything(bool metallic_roughness) {
  SceneData scene;
  scene.name = "everything";
  Material m;
  m.emissive = glm::vec3(0.1F);
  m.double_sided = true;
  m.alpha = AlphaMode::kBlend;
  const int image = add_image(scene, "grey", {2, 2, std::vector<std::uint8_t>(16, 200)});
  for (std::size_t slot = 0; slot < kTextureSlots; ++slot) {
    m.textures[slot].image = image;
    m.textures[slot].transformed = true;
    m.textures[slot].u_row = {1, 0.01F * static_cast<float>(slot), 0};
  }
  m.layers.specular = true;
  m.layers.specular_glossiness = !metallic_roughness;
  m.layers.clearcoat = 0.7F;
  m.layers.clearcoat_roughness = 0.4F;
  m.layers.sheen_color = {0.3F, 0.2F, 0.1F};
  m.layers.sheen_roughness = 0.5F;
  m.layers.transmission = 0.5F;
  m.layers.absorption = glm::vec3(-0.5F);
  scene.materials.push_back(m);
  MeshBuilder mesh;
  mesh.box(glm::vec3(-0.5F), glm::vec3(0.5F), 1);
  place(scene, mesh.finish(scene, "box", 0,
                           {.normal = true, .tangent = metallic_roughness, .uv = true, .color = true}));
  for (const Light::Kind kind : {Light::Kind::kDirectional, Light::Kind::kPoint, Light::Kind::kSpot})
    scene.lights.push_back({kind, glm::vec3(1), {1, 1, 2}, {0, -0.6F, -0.8F}, 9, 0.2F, 0.7F});
  return scene;
}

}  // namespace

TEST_CASE(
    "material layers: all of them together fit the registers of every machine, and draw the same picture "
    "there") {
  for (const bool metallic_roughness : {true, false}) {
    const traces::CommandStream stream = Recorder(everything(metallic_roughness), small(48, 48)).record();
    REQUIRE(stream.shaders.size() == 2);
    const auto compiled =
        pipeline::compile_pipeline(stream.shaders[0].spirv, "vertex", stream.shaders[1].spirv, "fragment");
    CHECK(compiled.fragment.num_regs <= 128);
    const pipeline::FrameImage image = functional(stream);
    for (const char* machine : {"small", "default", "large"}) {
      INFO(machine);
      CHECK(exact_differs(stream, machine, image.color) == "");
    }
  }
}

TEST_CASE(
    "material layers: every machine that comes with the program draws builtin:materials as the functional "
    "rendering does") {
  const traces::CommandStream stream = load_scene("builtin:materials", small(140, 140));
  const pipeline::FrameImage image = functional(stream);
  for (const char* machine : {"small", "default", "large"}) {
    INFO(machine);
    CHECK(exact_differs(stream, machine, image.color) == "");
  }
}
