/// Posed pictures: by the vertex shader and by the host, on the machine and in the reference.
#include <catch2/catch.hpp>

#include <glm/ext/matrix_transform.hpp>

#include "models/reference/compare.h"
#include "models/reference/reference.h"
#include "pipeline/render.h"
#include "scenes/gltf/loader.h"
#include "scenes/material/shader_sources.h"
#include "scenes/record/recorder.h"
#include "scenes/scene.h"
#include "tests/scenes/gltf_builder.h"
#include "tests/scenes/gltf_text.h"

using namespace quadrille;
namespace ref = models::reference;

namespace {

scenes::ArmOptions eight_joints() {
  scenes::ArmOptions options;
  options.second_set = true;
  options.wide_joints = true;
  return options;
}

constexpr std::uint32_t kSide = 160;

std::vector<std::uint32_t> picture(const std::string& file, double time,
                                   const std::string& vertex_shader = "") {
  scenes::SceneOptions options;
  options.width = options.height = kSide;
  options.time = time;
  options.vertex_shader = vertex_shader;
  return pipeline::render_functional_frame(scenes::load_scene(file, options), {}).image.color;
}

/// The materials' own vertex shader without its part about poses, as a user might give it.
class PlainShader {
 public:
  PlainShader()
      : file_(std::string(scenes::kInterfaceGlsl) + std::string(scenes::kMaterialVert), "plain.vert") {}
  [[nodiscard]] std::string path() const { return file_.path(); }

 private:
  scenes::TempGltf file_;
};

/// Equal but for edges and shades that a last place of a position or normal decides.
void require_same(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  const auto difference = ref::compare_images({kSide, kSide, a}, {kSide, kSide, b});
  CHECK(difference.fraction_within(1) >= 0.9995);
  CHECK(difference.bad_blocks == 0);
}

void require_other(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  CHECK(ref::compare_images({kSide, kSide, a}, {kSide, kSide, b}).fraction_within(8) < 0.99);
}

/// The whole arm hung on a root that mirrors it.
std::string mirrored_arm() {
  std::string text = scenes::arm_gltf();
  const auto put = [&](const std::string& what, const std::string& with) {
    text.replace(text.find(what), what.size(), with);
  };
  put(R"({"name":"lower")", R"({"name":"lower","scale":[-1,1,1])");
  put(R"("doubleSided":true)", R"("doubleSided":false)");
  return text;
}

}  // namespace

TEST_CASE(
    "posed pictures: the vertex shader and the host pose alike, for skins, mirrored skins, morph targets and "
    "both") {
  const PlainShader plain;
  for (const std::string& text : {scenes::arm_gltf(), scenes::arm_gltf(eight_joints()), mirrored_arm(),
                                  scenes::morph_gltf(4, "[0,0,0,0]")}) {
    const scenes::TempGltf file(text);
    const auto by_shader = picture(file.path(), 0.6);
    require_same(by_shader, picture(file.path(), 0.6, plain.path()));
    require_other(by_shader, picture(file.path(), 0.1));
  }
  require_same(picture("builtin:flag", 0.3), picture("builtin:flag", 0.3, plain.path()));
  require_other(picture("builtin:flag", 0.3), picture("builtin:flag", 0.9));
}

TEST_CASE(
    "posed pictures: weights that do not sum to one draw what those divided by their sum do, by the vertex "
    "shader and by the host") {
  const PlainShader plain;
  const scenes::TempGltf whole(scenes::arm_gltf());
  for (const int bits : {8, 16, 32}) {
    for (const float weight : {0.9F, 0.0F}) {
      CAPTURE(bits, weight);
      scenes::ArmOptions options;
      options.weight_bits = bits;
      options.weight = weight;
      const scenes::TempGltf file(scenes::arm_gltf(options));
      require_same(picture(file.path(), 0.6), picture(whole.path(), 0.6));
      require_same(picture(file.path(), 0.6, plain.path()), picture(whole.path(), 0.6));
    }
  }
}

TEST_CASE("posed pictures: a mirrored skin shows its front faces, and is lit from the same side") {
  const scenes::TempGltf mirrored(mirrored_arm()), plain(scenes::arm_gltf());
  // a rectangle is its own mirror image
  const auto a = picture(mirrored.path(), 0), b = picture(plain.path(), 0);
  require_same(a, b);
}

TEST_CASE(
    "posed pictures: a skin ten thousand kilometres away, between whole metres, is drawn as at the origin") {
  std::string text = scenes::arm_gltf();
  const scenes::TempGltf near(text);
  const std::string lower = R"({"name":"lower")";
  text.insert(text.find(lower) + lower.size(), R"(,"translation":[10000000.3,-10000000.4,10000000.6])");
  const scenes::TempGltf far(text);
  for (const double time : {0.1, 0.6}) require_same(picture(near.path(), time), picture(far.path(), time));
}

namespace {

/// The square of a morph target, posed, three times in one instanced draw.
scenes::SceneData posed_copies() {
  const scenes::TempGltf file(scenes::morph_gltf(3, "[0.3,0.2,0.1]"));
  scenes::SceneData scene = scenes::load_gltf(file.path());
  scene.materials[static_cast<std::size_t>(scene.primitives[0].material)].double_sided = true;
  scene.instances[0].copies = 0;
  scene.copies.emplace_back();
  for (int i = 0; i < 3; ++i) {
    const glm::dmat4 at = glm::translate(glm::dmat4(1), glm::dvec3(1.3 * i - 1.9, 0.3 * i - 0.9, -0.7 * i));
    scene.copies[0].push_back(glm::rotate(at, 0.3 * i, glm::dvec3(0.6, 0.8, 0)));
  }
  scene.cameras.resize(1);
  scene.cameras[0].pose = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, 4));
  return scene;
}

}  // namespace

TEST_CASE(
    "posed pictures: instanced and posed, colours and ids cover the same pixels, with a vertex shader of the "
    "user's too") {
  const PlainShader plain;
  const scenes::SceneData scene = posed_copies();
  const auto drawn = [&](bool visibility, const std::string& shader) {
    scenes::SceneOptions options;
    options.width = options.height = kSide;
    options.visibility = visibility;
    options.vertex_shader = shader;
    return pipeline::render_functional_frame(scenes::Recorder(scene, options).record(), {}).image.color;
  };
  const auto colors = drawn(false, ""), ids = drawn(true, "");
  CHECK(colors == drawn(false, plain.path()));
  CHECK(ids == drawn(true, plain.path()));
  std::size_t covered = 0, unlike = 0;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    covered += ids[i] != 0 ? 1 : 0;
    unlike += (ids[i] != 0) != (colors[i] != colors[0]) ? 1 : 0;
  }
  CHECK(covered > 1000);
  CHECK(unlike == 0);
}

TEST_CASE(
    "posed pictures: too many targets for the shader's locations are blended by the host, to the same "
    "picture") {
  // Twelve targets, of which each four move what one of three would.
  std::string many = "[";
  for (int i = 0; i < 12; ++i)
    many += (i == 0 ? "" : ",") + std::string(i % 3 == 0 ? "0.075" : i % 3 == 1 ? "0.05" : "0.025");
  const auto at_rest = [](const std::string& text) {
    const scenes::TempGltf file(text);
    scenes::SceneOptions options;
    options.width = options.height = kSide;
    options.eye = glm::vec3(1, 1, 4);
    options.at = glm::vec3(0.5F, 0.5F, 0);
    return pipeline::render_functional_frame(scenes::load_scene(file.path(), options), {}).image.color;
  };
  require_same(at_rest(scenes::morph_gltf(12, many + "]")),
               at_rest(scenes::morph_gltf(12, "[0.3,0.2,0.1,0,0,0,0,0,0,0,0,0]")));
}

TEST_CASE("posed pictures: integers that a shader reads are supplied as integers, or the draw is refused") {
  traces::CommandStream stream = scenes::load_scene("builtin:flag", {});
  for (traces::Pipeline& pipeline : stream.pipelines) {
    for (traces::VertexAttribute& a : pipeline.attributes) {
      if (a.format == traces::Format::kR8G8B8A8Uint) a.format = traces::Format::kR8G8B8A8UnormVertex;
    }
  }
  traces::validate(stream);
  CHECK_THROWS_WITH(pipeline::render_functional_frame(stream, {}),
                    Catch::Contains("location 6 as integers") && Catch::Contains("as floats"));
  CHECK_THROWS_WITH(ref::render(stream, {}), Catch::Contains("location 6"));
}
