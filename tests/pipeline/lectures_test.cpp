/// Pictures of the lectures' pipelines against closed forms: where light is evaluated, what the painter's
/// algorithm gets right and wrong, and pictures of values that can be read off.
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "models/rop/srgb.h"
#include "pipeline/render.h"
#include "scenes/builtin/builtin.h"
#include "scenes/builtin/mesh_builder.h"
#include "scenes/record/recorder.h"
#include "scenes/scene.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

constexpr std::uint32_t kSide = 96;
constexpr std::uint32_t kOpaque = 0xff000000U;

using Picture = std::vector<std::uint32_t>;

SceneOptions options_of(Shading shading, DrawOrder order = DrawOrder::kFile) {
  SceneOptions options;
  options.width = options.height = kSide;
  options.shading = shading;
  options.order = order;
  return options;
}

SceneOptions options_of(Showing shown, DrawOrder order = DrawOrder::kFile) {
  SceneOptions options = options_of(Shading::kPbr, order);
  options.shown = shown;
  return options;
}

Picture picture(const SceneData& scene, const SceneOptions& options) {
  return pipeline::render_functional_frame(Recorder(scene, options).record(), {}).image.color;
}

int channel(std::uint32_t pixel, int c) { return static_cast<int>(pixel >> (8 * c) & 255U); }

std::uint32_t at(const Picture& p, std::uint32_t x, std::uint32_t y) { return p[y * kSide + x]; }

/// The largest difference of a channel.
int apart(std::uint32_t a, std::uint32_t b) {
  int most = 0;
  for (int c = 0; c < 4; ++c) most = std::max(most, std::abs(channel(a, c) - channel(b, c)));
  return most;
}

int apart(const Picture& a, const Picture& b) {
  REQUIRE(a.size() == b.size());
  int most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, apart(a[i], b[i]));
  return most;
}

std::uint32_t background(const SceneData& scene) {
  std::uint32_t pixel = kOpaque;
  for (int c = 0; c < 3; ++c) pixel |= std::uint32_t{models::encode_srgb8(scene.background[c])} << (8 * c);
  return pixel;
}

/// A scene with a camera on the z axis, whose picture is two units wide where it is orthographic.
SceneData empty_scene(bool perspective) {
  SceneData scene;
  scene.name = "lecture";
  Material m;
  m.base_color = {0.6F, 0.3F, 0.2F, 1};
  scene.materials.push_back(m);
  Camera camera;
  camera.perspective = perspective;
  camera.half_height = 1;
  camera.near = perspective ? 0.5 : 0;
  camera.far = 10;
  camera.pose = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, 4));
  scene.cameras.push_back(camera);
  Light sun;
  sun.color = glm::vec3(2);
  sun.direction = glm::normalize(glm::vec3(-0.4F, -0.5F, -1));
  scene.lights.push_back(sun);
  return scene;
}

constexpr Streams kPlain{.normal = true, .tangent = false, .uv = true, .color = false};

SceneData box_scene(bool perspective) {
  SceneData scene = empty_scene(perspective);
  MeshBuilder mesh;
  mesh.box(glm::vec3(-0.5F), glm::vec3(0.5F), 1);
  place(scene, mesh.finish(scene, "box", 0, kPlain),
        glm::rotate(glm::mat4(1), 0.7F, glm::normalize(glm::vec3(1, 2, 0.3F))));
  return scene;
}

SceneData ball_scene(bool perspective, std::uint32_t columns, std::uint32_t rows) {
  SceneData scene = empty_scene(perspective);
  MeshBuilder mesh;
  mesh.patch(columns, rows, [](float u, float v) {
    const float around = 6.2831853F * u, down = 3.1415927F * v;
    return PatchPoint{0.8F * glm::vec3(std::sin(down) * std::sin(around), std::cos(down),
                                       std::sin(down) * std::cos(around)),
                      {u, v}};
  });
  place(scene, mesh.finish(scene, "ball", 0, kPlain));
  return scene;
}

/// A square of side two in the plane z = 0, of that many quads a side.
SceneData square_scene(std::uint32_t quads) {
  SceneData scene = empty_scene(false);
  MeshBuilder mesh;
  mesh.patch(quads, quads, [](float u, float v) { return PatchPoint{{2 * u - 1, 1 - 2 * v, 0}, {u, v}}; });
  place(scene, mesh.finish(scene, "square", 0, kPlain));
  return scene;
}

/// Squares that fill the picture, by distance from the plane z = 0 towards the viewer, of one draw.
SceneData layers(const std::vector<float>& heights, const std::vector<glm::vec4>& colors, AlphaMode alpha) {
  SceneData scene = empty_scene(false);
  scene.materials[0].base_color = glm::vec4(1);
  scene.materials[0].unlit = true;
  scene.materials[0].alpha = alpha;
  MeshBuilder mesh;
  for (std::size_t i = 0; i < heights.size(); ++i)
    mesh.patch(1, 1, [&](float u, float v) {
      return PatchPoint{{2 * u - 1, 1 - 2 * v, heights[i]}, {u, v}, colors[i]};
    });
  place(scene,
        mesh.finish(scene, "layers", 0, {.normal = true, .tangent = false, .uv = false, .color = true}));
  return scene;
}

}  // namespace

TEST_CASE("lectures: the minimal pipeline draws one colour beside the background, whatever the material") {
  for (const char* name : {"cubes", "courtyard", "flag", "primitives", "overdraw"}) {
    CAPTURE(name);
    const SceneData scene = build_builtin(name);
    std::set<std::uint32_t> colors;
    for (const std::uint32_t pixel : picture(scene, options_of(Shading::kMinimal)))
      if (pixel != background(scene)) colors.insert(pixel);
    CHECK(colors.size() == 1);
  }
}

TEST_CASE("lectures: flat shading gives every triangle exactly one colour") {
  SceneData scene = ball_scene(true, 12, 8);
  Light lamp;
  lamp.kind = Light::Kind::kPoint;
  lamp.color = glm::vec3(4);
  lamp.position = {1, 1, 2};
  scene.lights.push_back(lamp);
  scene.instances[0].world = glm::translate(glm::dmat4(1), glm::dvec3(-0.5, 0.3, 0));
  place(scene, 0,
        glm::scale(glm::translate(glm::mat4(1), glm::vec3(0.8F, -0.6F, 0)), glm::vec3(-0.6F, 0.6F, 0.6F)));
  const auto triangles_of = [&](const Picture& colors) {
    SceneOptions ids = options_of(Shading::kFlat);
    ids.visibility = true;
    const Picture numbers = picture(scene, ids);
    std::map<std::uint32_t, std::set<std::uint32_t>> by_triangle;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (numbers[i] != 0) by_triangle[numbers[i]].insert(colors[i]);
    return by_triangle;
  };
  const auto flat = triangles_of(picture(scene, options_of(Shading::kFlat)));
  CHECK(flat.size() > 60);
  std::set<std::uint32_t> all;
  for (const auto& [triangle, colors] : flat) {
    CHECK(colors.size() == 1);
    all.insert(colors.begin(), colors.end());
  }
  CHECK(all.size() > flat.size() / 3);  // and not one for all
  const auto smooth = triangles_of(picture(scene, options_of(Shading::kGouraud)));
  CHECK(std::ranges::count_if(smooth, [](const auto& t) { return t.second.size() > 1; }) > 40);
}

TEST_CASE("lectures: where normals do not change, it does not matter where light is evaluated") {
  // Neither light nor view change over a face: the sun shines, and the camera is orthographic.
  const SceneData scene = box_scene(false);
  const Picture flat = picture(scene, options_of(Shading::kFlat)),
                gouraud = picture(scene, options_of(Shading::kGouraud)),
                phong = picture(scene, options_of(Shading::kPhong));
  CHECK(apart(gouraud, phong) <= 1);
  CHECK(apart(flat, phong) <= 1);
  CHECK(std::ranges::count(phong, background(scene)) < static_cast<std::ptrdiff_t>(phong.size()));
}

TEST_CASE("lectures: a highlight between vertices is lost at vertices and found at fragments") {
  SceneData scene = square_scene(1);
  scene.lights[0].kind = Light::Kind::kPoint;
  scene.lights[0].position = {0, 0, 0.4};
  scene.lights[0].color = glm::vec3(0.3F);
  const Picture coarse = picture(scene, options_of(Shading::kGouraud)),
                phong = picture(scene, options_of(Shading::kPhong));
  const std::uint32_t middle = kSide / 2;
  CHECK(channel(at(phong, middle, middle), 1) > channel(at(coarse, middle, middle), 1) + 60);
  // Many vertices find it too.
  scene.instances.clear();
  SceneData fine = square_scene(64);
  fine.lights = scene.lights;
  CHECK(apart(at(picture(fine, options_of(Shading::kGouraud)), middle, middle), at(phong, middle, middle)) <=
        4);
}

TEST_CASE("lectures: a surface that faces eye and light has the colour of the model, in all three places") {
  SceneData scene = square_scene(1);
  scene.lights[0].direction = {0, 0, -1};
  for (const Shading shading : {Shading::kFlat, Shading::kGouraud, Shading::kPhong}) {
    const Picture p = picture(scene, options_of(shading));
    for (int c = 0; c < 3; ++c) {
      // Sky and ground count 0.35 beside lights of the file. Light is divided by pi; half of it is reflected
      // at the half vector.
      const double ambient = 0.35 * 0.5 *
                             static_cast<double>(scene.environment.sky[c] + scene.environment.ground[c]),
                   light = 2 / 3.14159265358979;
      const double color =
          static_cast<double>(scene.materials[0].base_color[c]) * (ambient + light) + 0.5 * light;
      const int expected = models::encode_srgb8(static_cast<float>(color));
      CHECK(std::abs(channel(at(p, 20, 70), c) - expected) <= 1);
    }
  }
}

TEST_CASE("lectures: double-sided surfaces are lit from the side that is seen") {
  for (const Shading shading : {Shading::kFlat, Shading::kGouraud, Shading::kPhong}) {
    SceneData front = square_scene(2);
    front.materials[0].double_sided = true;
    SceneData back = front;
    back.instances[0].world = glm::rotate(glm::dmat4(1), 3.141592653589793, glm::dvec3(0, 1, 0));
    CHECK(apart(picture(front, options_of(shading)), picture(back, options_of(shading))) <= 1);
    back.materials[0].double_sided = false;
    CHECK(picture(back, options_of(shading)) == Picture(kSide * kSide, background(back)));
  }
}

TEST_CASE("lectures: a posed mesh covers what it covers with the materials' own shading") {
  const SceneData scene = build_builtin("flag", 0.6);
  const Picture pbr = picture(scene, options_of(Shading::kPbr));
  for (const Shading shading : {Shading::kFlat, Shading::kGouraud, Shading::kPhong}) {
    const Picture other = picture(scene, options_of(shading));
    std::size_t apart_by_coverage = 0;
    for (std::size_t i = 0; i < pbr.size(); ++i)
      apart_by_coverage += (pbr[i] == background(scene)) != (other[i] == background(scene)) ? 1 : 0;
    CHECK(apart_by_coverage <= 2);  // the host poses in double
  }
}

TEST_CASE("lectures: the alpha test holds in every shading but the minimal one") {
  SceneData scene = square_scene(1);
  scene.materials[0].alpha = AlphaMode::kMask;
  scene.materials[0].base_color.a = 0.4F;
  const Picture nothing(kSide * kSide, background(scene));
  for (const Shading shading : {Shading::kFlat, Shading::kGouraud, Shading::kPhong})
    CHECK(picture(scene, options_of(shading)) == nothing);
  CHECK(picture(scene, options_of(Shading::kMinimal)) != nothing);
}

TEST_CASE("painter: on a convex object the picture is that of the depth buffer") {
  for (const bool perspective : {false, true}) {
    const SceneData ball = ball_scene(perspective, 24, 16);
    SceneData box = box_scene(perspective);
    for (const Shading shading : {Shading::kFlat, Shading::kPhong, Shading::kPbr}) {
      for (const SceneData& scene : {ball, box})
        CHECK(picture(scene, options_of(shading, DrawOrder::kPainter)) ==
              picture(scene, options_of(shading)));
    }
    // With its far sides drawn, and drawn over.
    box.materials[0].double_sided = true;
    CHECK(picture(box, options_of(Shading::kPhong, DrawOrder::kPainter)) ==
          picture(box, options_of(Shading::kPhong)));
  }
}

TEST_CASE("painter: three triangles in a cycle have no order, and the depth buffer needs none") {
  const SceneData scene = build_builtin("cycle");
  const Picture right = picture(scene, options_of(Shading::kPbr)),
                wrong = picture(scene, options_of(Shading::kPbr, DrawOrder::kPainter));
  const auto color = [&](int i) {
    const glm::vec4& c = scene.materials[static_cast<std::size_t>(i)].base_color;
    std::uint32_t pixel = kOpaque;
    for (int k = 0; k < 3; ++k) pixel |= std::uint32_t{models::encode_srgb8(c[k])} << (8 * k);
    return pixel;
  };
  // On the tip of each wedge lies the blunt end of the next.
  int failures = 0;
  for (int i = 0; i < 3; ++i) {
    const double turn = 2.0943951023931953 * i;
    const double x = 0.55 * std::cos(turn) + 0.38 * std::sin(turn),
                 y = 0.55 * std::sin(turn) - 0.38 * std::cos(turn);
    const auto column = static_cast<std::uint32_t>((x + 1) / 2 * kSide),
               row = static_cast<std::uint32_t>((1 - y) / 2 * kSide);
    CHECK(at(right, column, row) == color((i + 1) % 3));
    failures += at(wrong, column, row) == color(i) ? 1 : 0;
  }
  CHECK(failures == 1);  // of two pairs the order happens to be right, and of the third it cannot be
}

TEST_CASE("painter: blended layers of one draw come out right in any order of the file") {
  const std::vector<glm::vec4> colors{{1, 0, 0, 0.5F}, {0, 1, 0, 0.25F}, {0, 0, 1, 0.5F}};
  SceneData nearest_first = layers({0.5F, 0.2F, -0.3F}, colors, AlphaMode::kBlend),
            farthest_first =
                layers({-0.3F, 0.2F, 0.5F}, {colors[2], colors[1], colors[0]}, AlphaMode::kBlend);
  nearest_first.background = farthest_first.background = glm::vec3(0);
  const Picture right = picture(farthest_first, options_of(Shading::kPbr));
  CHECK(picture(nearest_first, options_of(Shading::kPbr)) != right);
  CHECK(picture(nearest_first, options_of(Shading::kPbr, DrawOrder::kPainter)) == right);
  CHECK(picture(farthest_first, options_of(Shading::kPbr, DrawOrder::kPainter)) == right);
  // Over, from behind: blue 0.5, times 0.75 and then 0.5; green 0.25 times 0.5; red 0.5.
  const std::array<float, 3> expected{0.5F, 0.125F, 0.1875F};
  for (int c = 0; c < 3; ++c)
    CHECK(std::abs(channel(at(right, 5, 5), c) -
                   models::encode_srgb8(expected[static_cast<std::size_t>(c)])) <= 2);
}

TEST_CASE("values: a picture of texture coordinates holds them") {
  const Picture p = picture(square_scene(1), options_of(Showing::kUv));
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x) {
      CHECK(std::abs(channel(at(p, x, y), 0) - 255 * (x + 0.5) / kSide) <= 0.51);
      CHECK(std::abs(channel(at(p, x, y), 1) - 255 * (y + 0.5) / kSide) <= 0.51);
      CHECK(channel(at(p, x, y), 2) == 0);
    }
}

TEST_CASE("values: a picture of levels has a colour for each halving of the texture, and grey beyond it") {
  SceneData scene = square_scene(1);
  const auto middle_of = [&](std::uint32_t side) {
    Rgba8Image image{side, side, std::vector<std::uint8_t>(std::size_t{4} * side * side, 255)};
    scene.materials[0].texture(TextureSlot::kBaseColor).image = add_image(scene, "grey", std::move(image));
    return at(picture(scene, options_of(Showing::kLevel)), kSide / 2, kSide / 2);
  };
  const auto colour = [](double r, double g, double b) {
    const auto byte = [](double v) { return static_cast<std::uint32_t>(std::lround(255 * v)); };
    return byte(r) | byte(g) << 8 | byte(b) << 16 | 0xff000000u;
  };
  // the square fills the picture
  CHECK(apart(middle_of(kSide), colour(0.9, 0.1, 0.1)) <= 3);
  CHECK(apart(middle_of(2 * kSide), colour(0.9, 0.5, 0)) <= 3);
  CHECK(apart(middle_of(4 * kSide), colour(0.9, 0.9, 0.1)) <= 3);
  CHECK(apart(middle_of(8 * kSide), colour(0.1, 0.7, 0.1)) <= 3);
  CHECK(apart(middle_of(kSide / 4), colour(0.5, 0.5, 0.5)) <= 3);
  scene.materials[0].texture(TextureSlot::kBaseColor).image = -1;
  CHECK(at(picture(scene, options_of(Showing::kLevel)), kSide / 2, kSide / 2) == colour(0, 0, 0.25));
}

TEST_CASE(
    "values: a picture of normals holds them in world space, from both sides and without any in the mesh") {
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1), 0.5, glm::normalize(glm::dvec3(1, 2, 0)));
  const glm::dvec3 n(turn[2]);
  for (const bool normals : {true, false}) {
    SceneData scene = square_scene(3);
    if (!normals) scene.primitives[0].attributes[1] = -1;
    scene.materials[0].double_sided = true;
    for (const double half_turn : {0.0, 3.141592653589793}) {
      scene.instances[0].world = glm::rotate(turn, half_turn, glm::dvec3(0, 1, 0));
      const std::uint32_t middle = at(picture(scene, options_of(Showing::kNormal)), kSide / 2, kSide / 2);
      for (int c = 0; c < 3; ++c) CHECK(std::abs(channel(middle, c) - 255 * (n[c] * 0.5 + 0.5)) <= 1);
    }
  }
}

TEST_CASE("values: a picture of depths goes from white to black over the frame's range") {
  SceneData scene = square_scene(1);
  // Turned so that depth changes with x alone, and its ends are at the picture's borders.
  scene.instances[0].world = glm::dmat4(1);
  scene.instances[0].world[0] = glm::dvec4(1, 0, 2, 0);
  const Picture p = picture(scene, options_of(Showing::kDepth));
  for (std::uint32_t x = 0; x < kSide; ++x)
    CHECK(std::abs(channel(at(p, x, 40), 0) - 255 * (x + 0.5) / kSide) <= 0.6);
  const Picture painted = picture(scene, options_of(Showing::kDepth, DrawOrder::kPainter));
  CHECK(painted == p);
}

TEST_CASE("values: each triangle has the low 24 bits of its number's colour") {
  const SceneData scene = ball_scene(true, 24, 16);
  SceneOptions ids = options_of(Shading::kPbr);
  ids.visibility = true;
  const Picture numbers = picture(scene, ids), shown = picture(scene, options_of(Showing::kTriangle));
  std::set<std::uint32_t> triangles, colors;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    CHECK(shown[i] == (numbers[i] | kOpaque));
    triangles.insert(numbers[i]);
    colors.insert(shown[i]);
  }
  CHECK(triangles.size() > 100);
  CHECK(colors.size() == triangles.size());
}

TEST_CASE("values: overdraw counts what is written: by order and depth test, or everything by the painter") {
  const std::vector<glm::vec4> colors(3, glm::vec4(1));
  const auto count = [&](const std::vector<float>& heights, AlphaMode alpha, DrawOrder order) {
    const Picture p = picture(layers(heights, colors, alpha), options_of(Showing::kOverdraw, order));
    CHECK(std::ranges::count(p, p.front()) == static_cast<std::ptrdiff_t>(p.size()));
    return p.front();
  };
  const std::uint32_t one = count({0, 0, 0}, AlphaMode::kOpaque, DrawOrder::kFile),
                      three = count({-0.4F, 0, 0.4F}, AlphaMode::kOpaque, DrawOrder::kFile);
  CHECK(one != three);
  CHECK(count({0.4F, 0, -0.4F}, AlphaMode::kOpaque, DrawOrder::kFile) == one);
  CHECK(count({0.4F, 0, -0.4F}, AlphaMode::kOpaque, DrawOrder::kPainter) == three);
  // Blended layers do not hide each other.
  CHECK(count({0.4F, 0, -0.4F}, AlphaMode::kBlend, DrawOrder::kFile) == three);
  // Each number up to sixteen has its own colour, and from there on it is white.
  std::set<std::uint32_t> scale;
  for (std::size_t n = 1; n <= 17; ++n) {
    const SceneData scene =
        layers(std::vector<float>(n, 0), std::vector<glm::vec4>(n, glm::vec4(1)), AlphaMode::kBlend);
    const std::uint32_t pixel = picture(scene, options_of(Showing::kOverdraw)).front();
    scale.insert(pixel);
    if (n >= 16) CHECK(pixel == 0xffffffffU);
  }
  CHECK(scale.size() == 16);
  const SceneData none = empty_scene(false);
  CHECK(picture(none, options_of(Showing::kOverdraw)) == Picture(kSide * kSide, kOpaque));
}
