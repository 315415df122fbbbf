/// A test card of points, lines and triangles, each kind in a field of its own.
///
/// Angles are computed in double and positions rounded once. Six columns and three rows, seen from straight
/// ahead: what a picture shows wrong is named by its field.
#include <array>
#include <cmath>
#include <cstring>
#include <functional>

#include <fmt/format.h>

#include <glm/vec3.hpp>

#include "scenes/builtin/builtin.h"
#include "scenes/builtin/mesh_builder.h"

namespace quadrille::scenes {
namespace {

using traces::LineMode;
using traces::PolygonMode;
using traces::Topology;

constexpr int kColumns = 6, kRows = 3;
constexpr double kTurn = 6.283185307179586;

/// Vertices of one field, whose coordinates run from -1 to 1, with a colour each.
class Field {
 public:
  Field(SceneData& scene, int column, int row) : scene_(scene) {
    centre_ = {(static_cast<float>(column) - 0.5F * (kColumns - 1)) * kPitch,
               (0.5F * (kRows - 1) - static_cast<float>(row)) * kPitch, -1};
  }
  void add(double x, double y, const glm::vec3& color, double z = 0) {
    positions_.push_back(
        centre_ + kHalf * glm::vec3(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)));
    colors_.emplace_back(color, 1.0F);
  }
  /// Of 16 bits; 65535 ends a strip or fan.
  void index(std::uint16_t i) { indices_.push_back(i); }
  void finish(const std::string& name, Topology topology, const RasterStyle& style) {
    Primitive p;
    p.name = name;
    p.topology = topology;
    p.style = style;
    p.attributes[static_cast<std::size_t>(Semantic::kPosition)] =
        array(name + " positions", traces::Format::kR32G32B32Float, positions_);
    p.attributes[static_cast<std::size_t>(Semantic::kColor)] =
        array(name + " colours", traces::Format::kR32G32B32A32Float, colors_);
    p.count = static_cast<std::uint32_t>(positions_.size());
    if (!indices_.empty()) {
      p.indices = array(name + " indices", traces::Format::kUndefined, indices_);
      p.count = static_cast<std::uint32_t>(indices_.size());
      p.restarts = topology == Topology::kTriangleStrip || topology == Topology::kTriangleFan ||
                   topology == Topology::kLineStrip;
    }
    for (const glm::vec3& position : positions_) p.bounds.add(position);
    scene_.primitives.push_back(std::move(p));
    place(scene_, static_cast<std::uint32_t>(scene_.primitives.size() - 1));
  }

 private:
  static constexpr float kPitch = 0.62F, kHalf = 0.27F;

  template <class T>
  int array(const std::string& name, traces::Format format, const std::vector<T>& values) {
    Array a{name, format, static_cast<std::uint32_t>(values.size()),
            std::vector<std::byte>(values.size() * sizeof(T))};
    std::memcpy(a.data.data(), values.data(), a.data.size());
    scene_.arrays.push_back(std::move(a));
    return static_cast<int>(scene_.arrays.size() - 1);
  }

  SceneData& scene_;
  glm::vec3 centre_{0};
  std::vector<glm::vec3> positions_;
  std::vector<glm::vec4> colors_;
  std::vector<std::uint16_t> indices_;
};

/// Colours of a wheel, `t` in turns.
glm::vec3 hue(double t) {
  const auto part = [&](double shift) {
    return static_cast<float>(0.55 + 0.45 * std::cos(kTurn * (t + shift)));
  };
  return {part(0), part(2.0 / 3), part(1.0 / 3)};
}

void spiral_of_points(SceneData& scene, int column, float size, int points) {
  Field field(scene, column, 0);
  for (int i = 0; i < points; ++i) {
    const double t = (i + 0.5) / points, angle = 3 * kTurn * t;
    field.add(t * std::cos(angle), t * std::sin(angle), hue(t));
  }
  field.finish(fmt::format("points of {}", size), Topology::kPointList, {.point_size = size});
}

void star_of_lines(SceneData& scene, int column, LineMode mode, float width) {
  Field field(scene, column, 1);
  constexpr int kLines = 24;
  for (int i = 0; i < kLines; ++i) {
    const double t = static_cast<double>(i) / kLines, x = std::cos(kTurn * t), y = std::sin(kTurn * t);
    field.add(0.15 * x, 0.15 * y, hue(t));
    field.add(x, y, hue(t + 0.25));
  }
  field.finish(fmt::format("lines of mode {}, width {}", static_cast<int>(mode), width), Topology::kLineList,
               {.line_mode = mode, .line_width = width});
}

/// Two curves in one strip, with a special index between them.
void curves(SceneData& scene, int column, int row) {
  Field field(scene, column, row);
  constexpr std::uint16_t kPoints = 96;
  for (int curve = 0; curve < 2; ++curve) {
    for (int i = 0; i < kPoints; ++i) {
      const double t = static_cast<double>(i) / (kPoints - 1);
      field.add(std::sin(kTurn * (curve + 2) * t), std::cos(kTurn * 3 * t), hue(t + 0.5 * curve));
    }
  }
  for (std::uint16_t i = 0; i < 2 * kPoints; ++i) {
    if (i == kPoints) field.index(0xffff);
    field.index(i);
  }
  field.finish("two curves in a strip", Topology::kLineStrip, {});
}

/// Zigzags of triangles, in one strip with a special index between them.
void ribbons(SceneData& scene, int column, int row) {
  Field field(scene, column, row);
  constexpr int kSteps = 12;
  for (int ribbon = 0; ribbon < 2; ++ribbon) {
    if (ribbon > 0) field.index(0xffff);
    for (int i = 0; i < 2 * kSteps; ++i) {
      const double t = static_cast<double>(i) / (2 * kSteps - 1);
      field.add(2 * t - 1, 0.5 - ribbon + 0.25 * std::sin(kTurn * t) + (i % 2 == 0 ? 0.2 : -0.2), hue(t));
      field.index(static_cast<std::uint16_t>(2 * kSteps * ribbon + i));
    }
  }
  field.finish("two ribbons in a strip", Topology::kTriangleStrip, {});
}

void flower(SceneData& scene, int column, int row) {
  Field field(scene, column, row);
  field.add(0, 0, glm::vec3(1));
  constexpr int kPetals = 48;
  for (int i = 0; i <= kPetals; ++i) {
    const double t = static_cast<double>(i) / kPetals, r = 0.7 + 0.3 * std::cos(6 * kTurn * t);
    field.add(r * std::cos(kTurn * t), r * std::sin(kTurn * t), hue(t));
  }
  field.finish("a fan", Topology::kTriangleFan, {});
}

/// A ball whose far side is culled.
void ball(SceneData& scene, int column, int row, const RasterStyle& style, const std::string& name) {
  Field field(scene, column, row);
  constexpr std::uint16_t kMeridians = 16, kParallels = 10;
  for (int p = 0; p <= kParallels; ++p) {
    for (int m = 0; m <= kMeridians; ++m) {
      const double up = 0.5 * kTurn * p / kParallels, round = kTurn * m / kMeridians;
      field.add(std::sin(up) * std::cos(round), std::cos(up), hue(static_cast<double>(m) / kMeridians),
                std::sin(up) * std::sin(round));
    }
  }
  constexpr std::uint16_t kRow = kMeridians + 1;
  for (std::uint16_t p = 0; p < kParallels; ++p) {
    for (std::uint16_t m = 0; m < kMeridians; ++m) {
      const auto at = static_cast<std::uint16_t>(kRow * p + m);
      for (const int corner : {0, 1, static_cast<int>(kRow), static_cast<int>(kRow), 1, kRow + 1})
        field.index(static_cast<std::uint16_t>(at + corner));
    }
  }
  field.finish(name, Topology::kTriangleList, style);
}

}  // namespace

SceneData build_primitives() {
  SceneData scene;
  Material m;
  m.name = "vertex colours";
  m.unlit = true;
  scene.materials.push_back(m);
  constexpr std::array<float, kColumns> kSizes{1, 2, 3.5F, 6, 9, 16};
  for (int i = 0; i < kColumns; ++i)
    spiral_of_points(scene, i, kSizes[static_cast<std::size_t>(i)], 72 - 9 * i);
  star_of_lines(scene, 0, LineMode::kBresenham, 1);
  star_of_lines(scene, 1, LineMode::kBresenham, 4);
  star_of_lines(scene, 2, LineMode::kRectangular, 1);
  star_of_lines(scene, 3, LineMode::kRectangular, 6);
  star_of_lines(scene, 4, LineMode::kSmooth, 1);
  star_of_lines(scene, 5, LineMode::kSmooth, 4);
  curves(scene, 0, 2);
  ribbons(scene, 1, 2);
  flower(scene, 2, 2);
  ball(scene, 3, 2, {.polygon_mode = PolygonMode::kLine}, "a ball by its edges");
  ball(scene, 4, 2, {.polygon_mode = PolygonMode::kLine, .line_mode = LineMode::kSmooth, .line_width = 2},
       "a ball by smooth edges");
  ball(scene, 5, 2, {.polygon_mode = PolygonMode::kPoint, .point_size = 4}, "a ball by its corners");
  Camera camera;
  camera.name = "flat";
  camera.perspective = false;
  camera.half_height = 1;
  camera.near = 0;
  camera.far = 100;
  camera.pose = glm::mat4(1);
  scene.cameras.push_back(camera);
  scene.background = {0.02F, 0.02F, 0.03F};
  scene.depth = false;  // the balls' far sides are culled, and a shared edge must not depend on a last bit
  return scene;
}

}  // namespace quadrille::scenes
