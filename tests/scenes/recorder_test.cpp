#include "scenes/record/recorder.h"
#include "scenes/scene.h"

#include <catch2/catch.hpp>
#include <cstring>

#include <glm/ext/matrix_transform.hpp>

#include "models/base/error.h"
#include "scenes/builtin/mesh_builder.h"
#include "tests/scenes/gltf_text.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

/// Boxes along z, nearest first; every second one is blended.
SceneData row_of_boxes() {
  SceneData scene;
  scene.name = "row";
  scene.materials.resize(2);
  scene.materials[1].alpha = AlphaMode::kBlend;
  for (int i = 0; i < 2; ++i) {
    MeshBuilder mesh;
    mesh.box(glm::vec3(-0.5F), glm::vec3(0.5F), 1);
    (void)mesh.finish(scene, i == 0 ? "solid" : "clear", i, {});
  }
  for (int i = 0; i < 6; ++i)
    place(scene, static_cast<std::uint32_t>(i % 2),
          glm::translate(glm::mat4(1), glm::vec3(0.01F * static_cast<float>(i), 0, -2 * i)));
  scene.cameras.resize(1);
  scene.cameras[0].pose = glm::translate(glm::mat4(1), glm::vec3(0, 0, 5));
  return scene;
}

/// Draws in order, with what is bound at each.
struct Drawn {
  std::string label;
  traces::Pipeline pipeline;
  DrawConstants constants;
};

std::vector<Drawn> draws(const traces::CommandStream& stream) {
  std::vector<Drawn> result;
  Drawn current;
  for (const traces::Command& command : stream.commands) {
    if (const auto* bind = std::get_if<traces::BindPipeline>(&command))
      current.pipeline = stream.pipelines[bind->pipeline];
    if (const auto* push = std::get_if<traces::PushConstants>(&command))
      std::memcpy(static_cast<void*>(&current.constants), push->data.data(), push->data.size());
    if (const auto* draw = std::get_if<traces::Draw>(&command)) {
      current.label = draw->label;
      result.push_back(current);
    }
  }
  return result;
}

}  // namespace

TEST_CASE(
    "recorder: opaque draws first in scene order, then blended ones from back to front without depth "
    "writes") {
  const SceneData scene = row_of_boxes();
  const std::vector<Drawn> drawn = draws(Recorder(scene, {}).record());
  REQUIRE(drawn.size() == 6);
  std::vector<float> z;
  for (std::size_t i = 0; i < 6; ++i) {
    REQUIRE(drawn[i].label == (i < 3 ? "solid" : "clear"));
    REQUIRE(drawn[i].pipeline.blend[0].enable == (i >= 3));
    REQUIRE(drawn[i].pipeline.depth.write == (i < 3));
    z.push_back(drawn[i].constants.model[3].z);
  }
  REQUIRE(z == std::vector<float>{0, -4, -8, -10, -6, -2});
}

TEST_CASE("recorder: draw ids count up, and first_triangle sums the triangles before") {
  const SceneData scene = row_of_boxes();
  const std::vector<Drawn> drawn = draws(Recorder(scene, {}).record());
  for (std::uint32_t i = 0; i < drawn.size(); ++i) {
    REQUIRE(drawn[i].constants.draw_id == i);
    REQUIRE(drawn[i].constants.first_triangle == 12 * i);
  }
}

TEST_CASE(
    "recorder: in visibility mode blended draws are solid, in the same order, into an UNORM target cleared "
    "to zero") {
  const SceneData scene = row_of_boxes();
  SceneOptions options;
  options.visibility = true;
  const traces::CommandStream stream = Recorder(scene, options).record();
  REQUIRE(traces::shown_target(stream).color == traces::Format::kR8G8B8A8Unorm);
  REQUIRE(std::get<traces::BeginPass>(stream.commands[0]).colors[0].clear ==
          std::array<float, 4>{0, 0, 0, 0});
  const std::vector<Drawn> drawn = draws(stream);
  REQUIRE(drawn[3].label == "clear");
  for (const Drawn& d : drawn) REQUIRE((!d.pipeline.blend[0].enable && d.pipeline.depth.write));
}

TEST_CASE("recorder: visibility is not blended under a vertex shader of the user's") {
  const TempGltf vert(
      "#version 450\nlayout(location = 0) in vec3 p;\nvoid main() { gl_Position = vec4(p, 1.0); }\n",
      "p.vert");
  SceneOptions options;
  options.visibility = true;
  options.vertex_shader = vert.path();
  for (const Drawn& d : draws(Recorder(row_of_boxes(), options).record()))
    REQUIRE((!d.pipeline.blend[0].enable && d.pipeline.depth.write));
}

TEST_CASE("recorder: instances share buffers, and a mirrored one turns the front face and the handedness") {
  SceneData scene = row_of_boxes();
  const std::size_t buffers = Recorder(scene, {}).record().buffers.size();
  place(scene, 0, glm::scale(glm::mat4(1), glm::vec3(-1, 1, 1)));
  const traces::CommandStream stream = Recorder(scene, {}).record();
  REQUIRE(stream.buffers.size() == buffers);
  const std::vector<Drawn> drawn = draws(stream);
  REQUIRE(drawn[3].pipeline.front == traces::FrontFace::kClockwise);
  REQUIRE(drawn[3].constants.handedness == -1);
  REQUIRE(drawn[0].pipeline.front == traces::FrontFace::kCounterClockwise);
  // a normal along x turns with the mirror
  REQUIRE(drawn[3].constants.normal_matrix[0] == glm::vec4(-1, 0, 0, 0));
  REQUIRE(drawn[3].constants.normal_matrix[1] == glm::vec4(0, 1, 0, 0));
}

TEST_CASE("recorder: the triangle colour is a bijection that can be undone") {
  for (const std::uint32_t number : {0U, 1U, 444433U, 0x7fffffffU, 0xfffffffeU}) {
    REQUIRE(triangle_from_color(triangle_id_color(number)) == number + 1);
    REQUIRE(triangle_id_color(number) != 0);
  }
  REQUIRE(triangle_from_color(0) == 0);
}

TEST_CASE("recorder: sizes outside the limits are refused") {
  SceneOptions options;
  options.width = 0;
  REQUIRE_THROWS_AS(load_scene("builtin:triangle", options), UserError);
  options.width = 16385;
  REQUIRE_THROWS_AS(load_scene("builtin:triangle", options), UserError);
}
