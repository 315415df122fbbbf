/// The material layers against closed forms: what their shaders compute, as the double-precision reference
/// executes them.
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>

#include "models/reference/reference.h"
#include "scenes/builtin/mesh_builder.h"
#include "scenes/record/recorder.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

constexpr double kPi = 3.14159265358979;

/// A square seen by an orthographic camera from +z, turned by `angle` radians about the y axis.
struct Stage {
  Material material;
  glm::vec3 light{0};  ///< of one directional light from the camera
  float environment = 0;
  glm::vec3 background{0};
  double angle = 0;
};

/// The linear colour in the middle of the picture.
std::array<double, 3> seen(const Stage& stage) {
  SceneData scene;
  scene.name = "stage";
  scene.materials.push_back(stage.material);
  MeshBuilder mesh;
  mesh.patch(1, 1, [](float u, float v) { return PatchPoint{{40 * (u - 0.5F), 40 * (0.5F - v), 0}}; });
  place(scene,
        mesh.finish(scene, "square", 0, {.normal = true, .tangent = false, .uv = false, .color = false}),
        glm::rotate(glm::mat4(1), static_cast<float>(stage.angle), glm::vec3(0, 1, 0)));
  scene.lights.push_back({Light::Kind::kDirectional, stage.light, {}, {0, 0, -1}, 0, 0, 0.7F});
  // beside lights it counts 0.35
  scene.environment = {glm::vec3(stage.environment / 0.35F), glm::vec3(stage.environment / 0.35F)};
  scene.background = stage.background;
  Camera camera;
  camera.perspective = false;
  camera.near = 0;
  camera.far = 100;
  camera.pose = glm::translate(glm::mat4(1), glm::vec3(0, 0, 50));
  scene.cameras.push_back(camera);
  SceneOptions options;
  options.width = options.height = 4;
  const auto result = models::reference::render(Recorder(scene, options).record(), {});
  return {result.color_linear[4 * 5], result.color_linear[4 * 5 + 1], result.color_linear[4 * 5 + 2]};
}

Material dielectric(float color, float roughness) {
  Material m;
  m.base_color = {color, color, color, 1};
  m.metallic = 0;
  m.roughness = roughness;
  return m;
}

Approx near(double value) { return Approx(value).epsilon(2e-3).margin(1e-4); }

/// Trowbridge-Reitz at the peak, light and eye on the normal: distribution times visibility, times pi.
double peak(double roughness) {
  const double alpha = std::max(roughness * roughness, 0.002);
  return 0.5 / (2 + 1e-4) / (alpha * alpha);
}

}  // namespace

TEST_CASE("material layers: the index of refraction sets the reflection, and 1 means none") {
  for (const double ior : {1.0, 1.2, 1.8, 3.0}) {
    Stage stage{dielectric(0.5F, 0.5F), glm::vec3(0.4F)};
    const double f0 = (ior - 1) / (ior + 1) * (ior - 1) / (ior + 1);
    stage.material.layers.specular = true;
    stage.material.layers.specular_color = glm::vec3(static_cast<float>(f0));
    REQUIRE(seen(stage)[0] == near(0.4 / kPi * (0.5 * (1 - f0) + f0 * peak(0.5))));
  }
}

TEST_CASE("material layers: weight and colour of the specular reflection, which metals do not heed") {
  Stage stage{dielectric(0.5F, 0.6F), glm::vec3(0.4F)};
  MaterialLayers& layers = stage.material.layers;
  layers.specular = true;
  layers.specular_color = glm::vec3(2, 0.2F, 0.1F);  // limited to 1 before the weight
  layers.specular_weight = 0.5F;
  const auto color = seen(stage);
  REQUIRE(color[0] == near(0.4 / kPi * (0.5 * 0.5 + 0.5 * peak(0.6))));
  REQUIRE(color[1] == near(0.4 / kPi * (0.5 * 0.5 + 0.1 * peak(0.6))));
  stage.material.metallic = 1;
  REQUIRE(seen(stage)[0] == near(0.4 / kPi * 0.5 * peak(0.6)));
}

TEST_CASE(
    "material layers: specular-glossiness is its diffuse part less the strongest reflectance, and the "
    "reflection") {
  Stage stage{dielectric(0.5F, 0.4F), glm::vec3(0.4F)};
  stage.material.layers.specular = stage.material.layers.specular_glossiness = true;
  stage.material.layers.specular_color = {0.3F, 0.1F, 0.05F};
  REQUIRE(seen(stage)[1] == near(0.4 / kPi * (0.5 * (1 - 0.3) * (1 - 0.3) + 0.1 * peak(0.4))));
}

TEST_CASE("material layers: a clear coat takes its share of the light from what lies below") {
  const double below = seen({dielectric(0.5F, 0.7F), glm::vec3(0.4F)})[0];
  for (const float weight : {0.25F, 1.0F}) {
    Stage stage{dielectric(0.5F, 0.7F), glm::vec3(0.4F)};
    stage.material.layers.clearcoat = weight;
    stage.material.layers.clearcoat_roughness = 0.3F;
    const double coat = 0.04 * static_cast<double>(weight);
    REQUIRE(seen(stage)[0] == near(below * (1 - coat) + coat * 0.4 / kPi * peak(0.3)));
  }
}

TEST_CASE("material layers: the fit of the sheen's albedo is that of its lobe, integrated") {
  for (const double roughness : {0.2, 0.4, 0.7, 1.0}) {
    for (const double n_dot_v : {0.1, 0.3, 0.6, 1.0}) {
      CAPTURE(roughness, n_dot_v);
      // A black base in white light shows the sheen alone.
      Stage stage{dielectric(0, 1), glm::vec3(0), 1, {}, std::acos(n_dot_v)};
      const double without = seen(stage)[0];
      stage.material.layers.sheen_color = glm::vec3(1);
      stage.material.layers.sheen_roughness = static_cast<float>(roughness);
      // with = without * (1 - E) + E
      const double with = seen(stage)[0], fit = (with - without) / (1 - without);
      const double exponent = 1 / (roughness * roughness), sine = std::sqrt(1 - n_dot_v * n_dot_v);
      double integral = 0;
      constexpr int kSteps = 96;
      for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps; ++j) {
          const double z = (i + 0.5) / kSteps, phi = kPi * (j + 0.5) / kSteps, s = std::sqrt(1 - z * z);
          const double hx = s * std::cos(phi) + sine, hy = s * std::sin(phi), hz = z + n_dot_v;
          const double cosine = hz / std::sqrt(hx * hx + hy * hy + hz * hz);
          const double d =
              (2 + exponent) * std::pow(std::sqrt(std::max(0.0, 1 - cosine * cosine)), exponent) / (2 * kPi);
          integral += d / (4 * (z + n_dot_v - z * n_dot_v)) * z * 2 * kPi / kSteps / kSteps;
        }
      }
      REQUIRE(std::abs(fit - std::min(integral, 1.0)) < 0.06);
    }
  }
}

TEST_CASE(
    "material layers: clear glass shows what lies behind less what it reflects, tinted glass takes the rest "
    "from the sky") {
  Stage stage{dielectric(1, 0), glm::vec3(0), 0, glm::vec3(0.6F, 0.4F, 0.2F)};
  stage.material.layers.transmission = 1;
  const auto clear = seen(stage);
  REQUIRE(clear[0] > 0.9 * 0.6);
  for (int i = 0; i < 3; ++i)
    REQUIRE(clear[static_cast<std::size_t>(i)] / static_cast<double>(stage.background[i]) ==
            Approx(clear[0] / 0.6).epsilon(0.015));  // the background has eight bits
  stage.environment = 1;
  stage.background = glm::vec3(1);
  for (const double angle : {0.0, 0.8, 1.3}) {
    stage.angle = angle;
    REQUIRE(seen(stage)[0] == near(1));  // white around: neither lost nor made
  }
  stage.angle = 0;
  stage.material.base_color = {1, 0.5F, 0.25F, 1};
  const auto tinted = seen(stage);
  REQUIRE(tinted[0] == near(1));
  REQUIRE(tinted[1] == Approx(0.5 * clear[0] / 0.6 + (1 - clear[0] / 0.6)).epsilon(0.015));
}

TEST_CASE("material layers: what a volume absorbs multiplies what passes") {
  Stage stage{dielectric(1, 0), glm::vec3(0), 0, glm::vec3(0.5F)};
  stage.material.layers.transmission = 1;
  const double clear = seen(stage)[0];
  stage.material.layers.absorption = glm::vec3(-1.5F);
  REQUIRE(seen(stage)[0] == near(clear * std::exp2(-1.5)));
}

TEST_CASE("material layers: in white light no layer adds to what the plain material gives") {
  for (const double angle : {0.0, 0.5, 1.0, 1.3, 1.5}) {
    for (const float roughness : {0.1F, 0.5F, 1.0F}) {
      CAPTURE(angle, roughness);
      Stage stage{dielectric(1, roughness), glm::vec3(0), 1, glm::vec3(1), angle};
      stage.material.metallic = 1;
      const double plain = seen(stage)[0];
      REQUIRE(plain < 1.01);
      Material& m = stage.material;
      m.layers.clearcoat = 1;
      m.layers.clearcoat_roughness = 1 - roughness;
      REQUIRE(seen(stage)[0] < 1.01);
      m.layers.sheen_color = {1, 0.5F, 0.25F};
      m.layers.sheen_roughness = roughness;
      REQUIRE(seen(stage)[0] < 1.01);
      m.metallic = 0;
      m.layers.transmission = 1;
      REQUIRE(seen(stage)[0] < 1.01);
    }
  }
}

TEST_CASE("material layers: a layer of weight zero is the plain material") {
  Material plain = dielectric(0.5F, 0.5F), layered = plain;
  layered.layers.clearcoat_roughness = 0.5F;
  layered.layers.sheen_roughness = 0.5F;
  layered.layers.absorption = glm::vec3(-1);
  Primitive primitive;
  primitive.attributes = {0, 1, 2, 3, 4, 5};
  REQUIRE(choose_variant(layered, primitive, ShaderSet::kMaterial) ==
          choose_variant(plain, primitive, ShaderSet::kMaterial));
}
