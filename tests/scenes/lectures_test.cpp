/// The lectures' pipelines as commands: meshes taken apart for the normals of their faces, the painter's
/// order, and the depths of a frame.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

#include "scenes/builtin/builtin.h"
#include "scenes/builtin/mesh_builder.h"
#include "scenes/data/vertex_values.h"
#include "scenes/record/depth_range.h"
#include "scenes/record/facets.h"
#include "scenes/record/recorder.h"
#include "scenes/scene.h"

using namespace quadrille;
using namespace quadrille::scenes;

namespace {

constexpr std::size_t kPosition = 0, kNormal = 1;

const Array& stream(const SceneData& scene, const Primitive& primitive, std::size_t semantic) {
  REQUIRE(primitive.attributes[semantic] >= 0);
  return scene.arrays[static_cast<std::size_t>(primitive.attributes[semantic])];
}

glm::dvec3 xyz(const Array& array, std::size_t vertex) {
  const auto v = values_at(array, vertex);
  return {v[0], v[1], v[2]};
}

/// Every three vertices are a face, and each has its unit normal.
void require_facets(const SceneData& scene, const Primitive& primitive) {
  REQUIRE(primitive.topology == traces::Topology::kTriangleList);
  REQUIRE(primitive.indices == -1);
  const Array &positions = stream(scene, primitive, kPosition), &normals = stream(scene, primitive, kNormal);
  REQUIRE(positions.count == primitive.count);
  REQUIRE(normals.count == primitive.count);
  for (std::uint32_t i = 0; i < primitive.count; i += 3) {
    const glm::dvec3 a = xyz(positions, i),
                     cross = glm::cross(xyz(positions, i + 1) - a, xyz(positions, i + 2) - a);
    for (std::uint32_t c = 0; c < 3; ++c) {
      const glm::dvec3 n = xyz(normals, i + c);
      REQUIRE(glm::dot(n, cross) >= (1 - 1e-6) * glm::length(cross));
    }
  }
}

/// A scene of one material and one mesh.
SceneData scene_of(const MeshBuilder& mesh, const Streams& streams) {
  SceneData scene;
  scene.name = "mesh";
  scene.materials.resize(1);
  place(scene, mesh.finish(scene, "mesh", 0, streams));
  return scene;
}

/// Squares one behind the other, at these distances, in one mesh.
MeshBuilder squares(const std::vector<float>& distances) {
  MeshBuilder mesh;
  for (const float distance : distances)
    mesh.patch(1, 1, [&](float u, float v) { return PatchPoint{{u - 0.5F, 0.5F - v, -distance}, {u, v}}; });
  return mesh;
}

/// Seen along z.
SceneOptions painter() {
  SceneOptions options;
  options.eye = glm::vec3(0, 0, 5);
  options.at = glm::vec3(0, 0, 0);
  options.width = options.height = 16;
  options.order = DrawOrder::kPainter;
  return options;
}

std::vector<traces::Draw> draws(const traces::CommandStream& stream) {
  std::vector<traces::Draw> all;
  for (const traces::Command& command : stream.commands)
    if (const auto* draw = std::get_if<traces::Draw>(&command)) all.push_back(*draw);
  return all;
}

std::vector<std::uint32_t> painter_indices(const traces::CommandStream& stream) {
  for (const traces::Buffer& buffer : stream.buffers) {
    if (buffer.name != "painter's order") continue;
    std::vector<std::uint32_t> indices(buffer.data.size() / 4);
    if (!indices.empty()) std::memcpy(indices.data(), buffer.data.data(), buffer.data.size());
    return indices;
  }
  return {};
}

}  // namespace

TEST_CASE("corners: strips and fans are taken apart as primitive assembly does, ended by the special index") {
  SceneData scene;
  const std::vector<std::uint8_t> indices{0, 1, 2, 3, 255, 4, 5, 255, 6, 7, 8};
  Array array{"indices", traces::Format::kUndefined, 11, std::vector<std::byte>(11)};
  std::memcpy(array.data.data(), indices.data(), indices.size());
  scene.arrays.push_back(array);
  Primitive p;
  p.indices = 0;
  p.index_type = traces::IndexType::kUint8;
  p.count = 11;
  p.restarts = true;
  p.topology = traces::Topology::kTriangleStrip;
  CHECK(corners_of(scene, p).vertices == std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2, 6, 7, 8});
  p.topology = traces::Topology::kTriangleFan;
  CHECK(corners_of(scene, p).vertices == std::vector<std::uint32_t>{1, 2, 0, 2, 3, 0, 7, 8, 6});
  p.topology = traces::Topology::kLineStrip;
  const Corners lines = corners_of(scene, p);
  CHECK(lines.per_piece == 2);
  CHECK(lines.vertices == std::vector<std::uint32_t>{0, 1, 1, 2, 2, 3, 4, 5, 6, 7, 7, 8});
  p.indices = -1;
  p.restarts = false;
  p.count = 3;
  p.topology = traces::Topology::kPointList;
  CHECK(corners_of(scene, p).vertices == std::vector<std::uint32_t>{0, 1, 2});
  CHECK(corners_of(scene, p).pieces() == 3);
}

TEST_CASE("corners: where nothing is restarted, the last index of its type is a vertex like others") {
  SceneData scene;
  const std::array<std::uint8_t, 3> indices{0, 255, 1};
  Array array{"indices", traces::Format::kUndefined, 3, std::vector<std::byte>(3)};
  std::memcpy(array.data.data(), indices.data(), indices.size());
  scene.arrays.push_back(array);
  Primitive p;
  p.indices = 0;
  p.index_type = traces::IndexType::kUint8;
  p.count = 3;
  CHECK(corners_of(scene, p).vertices == std::vector<std::uint32_t>{0, 255, 1});
}

TEST_CASE("facets: flat shading gives every face three vertices of its own with the face's normal") {
  for (const char* name : {"cubes", "flag", "courtyard", "materials"}) {
    const SceneData scene = build_builtin(name);
    const auto faceted = with_facets(scene, ShaderSet::kFlat);
    REQUIRE(faceted);
    REQUIRE(faceted->instances.size() == scene.instances.size());
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
      const Primitive& before = scene.primitives[scene.instances[i].primitive];
      const Primitive& after = faceted->primitives[faceted->instances[i].primitive];
      if (scene.materials[static_cast<std::size_t>(before.material)].unlit) continue;
      require_facets(*faceted, after);
      REQUIRE(after.count == corners_of(scene, before).vertices.size());
    }
  }
}

TEST_CASE("facets: meshes that have their normals, and what has no faces, stay as they are in other sets") {
  const SceneData cubes = build_builtin("cubes"), points = build_builtin("primitives");
  for (const ShaderSet set :
       {ShaderSet::kGouraud, ShaderSet::kPhong, ShaderSet::kNormal, ShaderSet::kMaterial})
    CHECK_FALSE(with_facets(cubes, set));
  CHECK_FALSE(with_facets(points, ShaderSet::kFlat));  // unlit
  CHECK(with_facets(points, ShaderSet::kNormal));      // whose strips and fans have faces
  MeshBuilder mesh;
  mesh.box(glm::vec3(-1), glm::vec3(1), 1);
  const SceneData bare = scene_of(mesh, {.normal = false, .tangent = false, .uv = true, .color = false});
  for (const ShaderSet set : {ShaderSet::kGouraud, ShaderSet::kPhong, ShaderSet::kNormal}) {
    const auto faceted = with_facets(bare, set);
    REQUIRE(faceted);
    require_facets(*faceted, faceted->primitives[0]);
  }
}

TEST_CASE("facets: a mesh with some normals keeps those that it has") {
  SceneData scene = scene_of(squares({1}), {});
  Primitive& primitive = scene.primitives[0];
  primitive.partial_normals = true;
  Array& normals = scene.arrays[static_cast<std::size_t>(primitive.attributes[kNormal])];
  REQUIRE(normals.format == traces::Format::kR32G32B32Float);
  const glm::vec3 slanted(0.6F, 0, 0.8F);
  for (std::size_t i = 0; i < normals.count; ++i) {
    const glm::vec3 n = i == 0 ? slanted : glm::vec3(0);
    std::memcpy(&normals.data[i * sizeof(n)], &n, sizeof(n));
  }
  const auto faceted = with_facets(scene, ShaderSet::kGouraud);
  REQUIRE(faceted);
  const Array& after = stream(*faceted, faceted->primitives[0], kNormal);
  const Corners corners = corners_of(scene, primitive);
  for (std::size_t i = 0; i < corners.vertices.size(); ++i)
    CHECK(glm::vec3(xyz(after, i)) == (corners.vertices[i] == 0 ? slanted : glm::vec3(0, 0, 1)));
}

TEST_CASE("facets: the camera that frames a scene does not move with the shading") {
  const auto view_projection = [](const SceneData& scene, Shading shading) {
    SceneOptions options;
    options.shading = shading;
    const traces::CommandStream stream = Recorder(scene, options).record();
    for (const traces::Buffer& buffer : stream.buffers)
      if (buffer.name == "frame")
        return std::vector<std::byte>(buffer.data.begin(), buffer.data.begin() + 64);
    return std::vector<std::byte>();
  };
  for (const char* name : {"cubes", "flag"}) {
    SceneData scene = build_builtin(name);
    scene.cameras.clear();
    CHECK(view_projection(scene, Shading::kPbr) == view_projection(scene, Shading::kFlat));
    CHECK(view_projection(scene, Shading::kPbr).size() == 64);
  }
}

TEST_CASE("painter: triangles of one mesh come from back to front, ties as the mesh has them, by one draw") {
  const traces::CommandStream stream = Recorder(scene_of(squares({2, 5, 3, 5}), {}), painter()).record();
  REQUIRE(draws(stream).size() == 1);
  std::vector<std::uint32_t> squares_drawn;
  const std::vector<std::uint32_t> indices = painter_indices(stream);
  REQUIRE(indices.size() == 24);
  for (std::size_t i = 0; i < indices.size(); i += 6) squares_drawn.push_back(indices[i] / 4);
  CHECK(squares_drawn == std::vector<std::uint32_t>{1, 3, 2, 0});
}

TEST_CASE("painter: what lies between two triangles of another draw is drawn between them") {
  SceneData scene;
  scene.name = "layers";
  scene.materials.resize(2);
  const std::uint32_t outer = squares({1, 3}).finish(scene, "outer", 0, {}),
                      inner = squares({2}).finish(scene, "inner", 1, {});
  place(scene, outer);
  place(scene, inner);
  const traces::CommandStream stream = Recorder(scene, painter()).record();
  std::vector<std::string> labels;
  std::uint32_t next = 0;
  for (const traces::Draw& draw : draws(stream)) {
    labels.push_back(draw.label);
    CHECK(draw.indexed);
    CHECK(draw.first == next);
    next += draw.count;
  }
  CHECK(labels == std::vector<std::string>{"outer", "inner", "outer"});
  CHECK(next == 18);
  CHECK(traces::shown_target(stream).depth == traces::Format::kUndefined);
  for (const traces::Pipeline& pipeline : stream.pipelines) CHECK_FALSE(pipeline.depth.test);
}

TEST_CASE("painter: copies of an instance are sorted with everything else") {
  SceneData scene;
  scene.name = "copies";
  scene.materials.resize(1);
  place(scene, squares({0}).finish(scene, "square", 0, {}));
  place(scene, 0);
  scene.instances[0].copies = 0;
  scene.copies.push_back({glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -1)),
                          glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -3))});
  scene.instances[1].world = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -2));
  const traces::CommandStream stream = Recorder(scene, painter()).record();
  std::vector<float> z;
  for (const traces::Command& command : stream.commands) {
    const auto* push = std::get_if<traces::PushConstants>(&command);
    if (push == nullptr) continue;
    DrawConstants constants;
    std::memcpy(static_cast<void*>(&constants), push->data.data(), push->data.size());
    z.push_back(constants.model[3].z);
  }
  CHECK(z == std::vector<float>{-3, -2, -1});
  for (const traces::Draw& draw : draws(stream)) CHECK(draw.instances == 1);
}

TEST_CASE("painter: points, lines, strips and fans become lists") {
  SceneData scene = build_builtin("primitives");
  const traces::CommandStream stream = Recorder(scene, painter()).record();
  traces::validate(stream);
  for (const traces::Pipeline& pipeline : stream.pipelines) {
    CHECK(list_of(pipeline.topology) == pipeline.topology);
    CHECK_FALSE(pipeline.primitive_restart);
  }
}

TEST_CASE("depth range: corners, edges cut by the view, and what is not seen") {
  const auto range = [](const std::vector<DepthRangeFinder::Triangle>& triangles) {
    DepthRangeFinder finder;
    for (const auto& t : triangles) finder.add(t);
    return finder.range();
  };
  const auto inside = range({{{{-0.5, 0, 0.25, 1}, {0.5, 0, 0.75, 1}, {0, 0.5, 0.5, 1}}}});
  REQUIRE(inside);
  CHECK(inside->nearest == 0.25F);
  CHECK(inside->farthest == 0.75F);
  // From x = -2 to x = 2 depth goes from 0 to 1; a half of that is in the picture.
  const auto cut = range({{{{-2, -0.1, 0, 1}, {2, -0.1, 1, 1}, {2, 0.1, 1, 1}}}});
  REQUIRE(cut);
  CHECK(cut->nearest == Approx(0.25).margin(0.02));
  CHECK(cut->farthest == 0.75F);
  CHECK_FALSE(range({}));
  CHECK_FALSE(range({{{{2, 0, 0.5, 1}, {3, 0, 0.5, 1}, {2, 1, 0.5, 1}}}}));
  // Behind the eye.
  CHECK_FALSE(range({{{{0, 0, -1, -1}, {0.1, 0, -1, -1}, {0, 0.1, -1, -1}}}}));
}

TEST_CASE("depth range: that of a frame is said, and only of a picture of depths") {
  SceneOptions options;
  options.width = options.height = 16;
  Scene colors("builtin:cycle", options);
  (void)colors.record({});
  CHECK_FALSE(colors.depth_range());
  options.shown = Showing::kDepth;
  Scene depths("builtin:cycle", options);
  (void)depths.record({});
  REQUIRE(depths.depth_range());
  // An orthographic camera from 0 to 100; the wedges reach from 1 to 3.
  CHECK(depths.depth_range()->first == Approx(0.01));
  CHECK(depths.depth_range()->second == Approx(0.03));
}
