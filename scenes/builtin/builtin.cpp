/// The list of built-in scenes, and the small ones.
#include "scenes/builtin/builtin.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <glm/ext/matrix_transform.hpp>

#include "models/base/error.h"
#include "models/base/near_name.h"
#include "scenes/builtin/mesh_builder.h"
#include "scenes/builtin/procedural_texture.h"
#include "scenes/data/rounded_math.h"

namespace quadrille::scenes {
namespace {

struct Entry {
  BuiltinScene scene;
  SceneData (*build)(double time);
  double length = 0;                     ///< seconds
  RecordPasses record_passes = nullptr;  ///< its frames have passes of their own
};

constexpr std::array<Entry, 16> kEntries{{
    {{"triangle", "one triangle with a colour at each corner: the smallest frame that exercises every unit"},
     [](double) { return build_triangle(); }},
    {{"quad", "one textured quad in perspective: mip levels and filtering are seen at a glance"},
     [](double) { return build_quad(); }},
    {{"cubes", "a field of 125 lit and textured cubes: many small draws, depth complexity of a few"},
     [](double) { return build_cubes(); }},
    {{"outlines",
      "the cubes as a drawing: a second pass reads colours and depths of the first, so targets are textures "
      "too"},
     [](double) { return build_outlines(); }},
    {{"courtyard",
      "a sunlit courtyard with fountain, arcades, trees and glass: 15 materials, normal maps, MASK and "
      "BLEND, 380 thousand triangles"},
     [](double) { return build_courtyard(); }},
    {{"overdraw", "sixteen translucent layers over the whole screen: blending and colour bandwidth"},
     [](double) { return build_overdraw(); }},
    {{"glass", "twelve panes of coloured glass that cut through each other: sorting draws cannot be right"},
     [](double) { return build_glass(); }},
    {{"fill",
      "eight untextured layers over the whole screen, without depth or blending: raw fill rate, and most "
      "units left out"},
     [](double) { return build_fill(); }},
    {{"cycle", "three triangles, each in front of the next: no order of drawing is right, a depth buffer is"},
     [](double) { return build_cycle(); }},
    {{"materials",
      "a wall of 49 spheres: each row one extension of glTF's materials, from clear coat to coloured glass"},
     [](double) { return build_materials(); }},
    {{"primitives",
      "a card of points, lines and triangles: sizes, widths, three ways to draw a line, strips, fans, and a "
      "ball "
      "by its edges and corners"},
     [](double) { return build_primitives(); }},
    {{"flag",
      "a flag in the wind, two seconds that repeat: a skin of 25 joints and two morph targets, posed by the "
      "vertex shader"},
     build_flag,
     kFlagSeconds},
    {{"shadow",
      "columns in the sun: a shadow map of 1024x1024, the lit scene in 16-bit floats, and a pass for tones "
      "and "
      "glare"},
     [](double) { return build_rotunda(); },
     0,
     record_shadow},
    {{"deferred",
      "the same columns at night: colours, normals and depths first, then 48 lamps added up over them, then "
      "tones"},
     [](double) { return build_rotunda(); },
     0,
     record_deferred},
    {{"glow",
      "the lamps of the columns by night, in and out of focus: mip levels and layers of an image, drawn each "
      "from the one above"},
     [](double) { return build_rotunda(); },
     0,
     record_glow},
    {{"blends",
      "a card of blending: six ways to mix, layers one by one and as a group, see-through textures both "
      "ways"},
     [](double) { return build_blends(); },
     0,
     record_blends},
}};

/// An unlit quad that fills the picture of `flat_camera`, at distance `depth`.
std::uint32_t screen_quad(SceneData& scene, const std::string& name, int material, float depth) {
  MeshBuilder mesh;
  mesh.patch(1, 1, [&](float u, float v) {
    return PatchPoint{{40 * (u - 0.5F), 20 * (0.5F - v), -depth}, {u, v}};
  });
  return mesh.finish(scene, name, material, {.normal = false, .tangent = false, .uv = false, .color = false});
}

Camera flat_camera() {
  Camera camera;
  camera.name = "flat";
  camera.perspective = false;
  camera.half_height = 1;
  camera.near = 0;
  camera.far = 100;
  camera.pose = glm::mat4(1);
  return camera;
}

Material unlit(const std::string& name, const glm::vec4& color) {
  Material m;
  m.name = name;
  m.base_color = color;
  m.unlit = true;
  return m;
}

Rgba8Image checker(std::uint32_t size, int squares, const glm::vec3& light, const glm::vec3& dark) {
  return paint(size, true, [&](glm::vec2 uv) {
    const glm::ivec2 square(uv * static_cast<float>(squares));
    return glm::vec4((square.x + square.y) % 2 == 0 ? light : dark, 1);
  });
}

}  // namespace

SceneData build_triangle() {
  SceneData scene;
  scene.materials.push_back(unlit("vertex colours", glm::vec4(1)));
  MeshBuilder mesh;
  const std::array<glm::vec3, 3> corners{{{0, 0.8F, -1}, {-0.9F, -0.7F, -1}, {0.9F, -0.7F, -1}}};
  for (int i = 0; i < 3; ++i) {
    MeshBuilder::Vertex v;
    v.position = corners[static_cast<std::size_t>(i)];
    v.color = glm::vec4(0, 0, 0, 1);
    v.color[i] = 1;
    mesh.vertex(v);
  }
  mesh.triangle(0, 1, 2);
  place(scene,
        mesh.finish(scene, "triangle", 0, {.normal = false, .tangent = false, .uv = false, .color = true}));
  scene.cameras.push_back(flat_camera());
  scene.background = {0.02F, 0.02F, 0.03F};
  return scene;
}

SceneData build_quad() {
  SceneData scene;
  Material m = unlit("checker", glm::vec4(1));
  m.texture(TextureSlot::kBaseColor).image =
      add_image(scene, "checker", checker(256, 8, {0.85F, 0.83F, 0.78F}, {0.05F, 0.08F, 0.15F}));
  m.double_sided = true;
  scene.materials.push_back(m);
  MeshBuilder mesh;
  mesh.patch(1, 1, [](float u, float v) {
    return PatchPoint{{30 * (u - 0.5F), -1, 1 - 40 * (1 - v)}, {8 * u, 10 * v}};
  });
  place(scene,
        mesh.finish(scene, "floor", 0, {.normal = false, .tangent = false, .uv = true, .color = false}));
  Camera camera;
  camera.name = "low";
  camera.pose = glm::mat4(1);
  scene.cameras.push_back(camera);
  return scene;
}

SceneData build_cubes() {
  SceneData scene;
  const int image = add_image(
      scene, "crate", paint(256, true, [](glm::vec2 uv) {
        const glm::vec2 edge = glm::vec2(0.5F) - glm::abs(uv - 0.5F);
        const float frame = smooth_ramp(0.075F, 0.085F, std::min(edge.x, edge.y));
        const float grain = tiling_noise({uv.x * 8, uv.y * 64}, 8, 3, 5);
        return glm::vec4(glm::mix(glm::vec3(0.75F), glm::vec3(1), frame) * (0.7F + 0.3F * grain), 1);
      }));
  constexpr std::array<glm::vec3, 5> kColors{{{0.80F, 0.25F, 0.18F},
                                              {0.90F, 0.66F, 0.20F},
                                              {0.25F, 0.55F, 0.30F},
                                              {0.20F, 0.42F, 0.72F},
                                              {0.75F, 0.72F, 0.68F}}};
  std::array<std::uint32_t, 5> cubes{};
  for (std::size_t i = 0; i < kColors.size(); ++i) {
    Material m;
    m.name = fmt::format("paint {}", i);
    m.base_color = glm::vec4(kColors[i], 1);
    m.metallic = 0;
    m.roughness = 0.25F + 0.15F * static_cast<float>(i);
    m.texture(TextureSlot::kBaseColor).image = image;
    scene.materials.push_back(m);
    MeshBuilder mesh;
    mesh.box(glm::vec3(-0.5F), glm::vec3(0.5F), 1);
    cubes[i] = mesh.finish(scene, fmt::format("cube {}", i), static_cast<int>(i), {});
  }
  for (int i = 0; i < 125; ++i) {
    const glm::ivec3 cell(i % 5 - 2, i / 5 % 5 - 2, i / 25 - 2);
    const glm::vec3 at = 1.7F * glm::vec3(cell);
    const glm::mat4 turned =
        glm::translate(glm::mat4(1), at) * rotation(6.2831853F * lattice_random(i, 0, 3),
                                                    glm::normalize(glm::vec3(1, 2, lattice_random(i, 1, 3))));
    place(scene, cubes[static_cast<std::size_t>(i) % kColors.size()], turned);
  }
  return scene;
}

SceneData build_outlines() {
  SceneData scene = build_cubes();
  // Ink where the distance jumps between neighbours; the picture with a darker rim elsewhere.
  // 1 / (1 - depth) grows as the distance does.
  scene.post_shader = R"(#version 450
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 result;
layout(set = 0, binding = 0) uniform sampler2D color;
layout(set = 0, binding = 1) uniform sampler2D depth;
float distance_at(vec2 at) { return 1.0 / (1.0005 - textureLod(depth, at, 0.0).r); }
void main() {
  vec2 pixel = 1.0 / vec2(textureSize(depth, 0));
  float here = distance_at(uv);
  float jump = abs(distance_at(uv + vec2(pixel.x, 0.0)) + distance_at(uv - vec2(pixel.x, 0.0)) - 2.0 * here) +
               abs(distance_at(uv + vec2(0.0, pixel.y)) + distance_at(uv - vec2(0.0, pixel.y)) - 2.0 * here);
  float ink = smoothstep(0.02, 0.08, jump / here);
  vec3 tone = textureLod(color, uv, 0.0).rgb;
  float rim = 1.0 - 0.6 * dot(uv - 0.5, uv - 0.5);
  result = vec4(mix(tone * rim, vec3(0.01, 0.01, 0.02), ink), 1.0);
}
)";
  return scene;
}

SceneData build_overdraw() {
  SceneData scene;
  scene.cameras.push_back(flat_camera());
  for (int i = 0; i < 16; ++i) {
    const float t = static_cast<float>(i) / 15;
    Material m = unlit(fmt::format("layer {}", i),
                       {0.9F - 0.7F * t, 0.3F + 0.4F * t * (1 - t) * 4, 0.2F + 0.7F * t, 0.25F});
    m.alpha = AlphaMode::kBlend;
    scene.materials.push_back(m);
    place(scene, screen_quad(scene, fmt::format("layer {}", i), i, 50 - static_cast<float>(i)),
          glm::translate(glm::mat4(1), {0.1F * static_cast<float>(i), 0, 0}));
  }
  return scene;
}

SceneData build_blends() {
  SceneData scene;
  scene.cameras.push_back(flat_camera());
  scene.background = {0.02F, 0.02F, 0.03F};
  scene.depth = false;
  return scene;
}

SceneData build_fill() {
  SceneData scene;
  scene.cameras.push_back(flat_camera());
  scene.depth = false;
  for (int i = 0; i < 8; ++i) {
    const float t = static_cast<float>(i) / 7;
    scene.materials.push_back(unlit(fmt::format("layer {}", i), {t, 0.35F, 1 - t, 1}));
    place(scene, screen_quad(scene, fmt::format("layer {}", i), i, 50 - static_cast<float>(i)));
  }
  return scene;
}

SceneData build_cycle() {
  SceneData scene;
  scene.cameras.push_back(flat_camera());
  constexpr std::array<glm::vec3, 3> kColors{
      {{0.85F, 0.2F, 0.15F}, {0.2F, 0.65F, 0.25F}, {0.2F, 0.35F, 0.85F}}};
  // A wedge from its blunt end, which is near, to its tip, which is far. The others are the same wedge turned
  // by a third, so that the blunt end of each lies over the tip of the one before.
  constexpr std::array<glm::vec3, 3> kWedge{{{-0.72F, -0.66F, -1}, {0.72F, -0.38F, -3}, {-0.72F, -0.1F, -1}}};
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    scene.materials.push_back(unlit(fmt::format("wedge {}", i), glm::vec4(kColors[k], 1)));
    MeshBuilder mesh;
    for (const glm::vec3& corner : kWedge) {
      MeshBuilder::Vertex v;
      v.position = glm::vec3(rotation(2.0943951F * static_cast<float>(i), {0, 0, 1}) * glm::vec4(corner, 1));
      mesh.vertex(v);
    }
    mesh.triangle(0, 1, 2);
    place(scene, mesh.finish(scene, fmt::format("wedge {}", i), i,
                             {.normal = false, .tangent = false, .uv = false, .color = false}));
  }
  scene.background = {0.02F, 0.02F, 0.03F};
  return scene;
}

std::string meant_builtin(std::string_view name) {
  std::vector<std::string> names;
  names.reserve(std::size(kEntries));
  for (const Entry& entry : kEntries) names.emplace_back(entry.scene.name);
  std::vector<std::string> near = near_names(name, names);
  for (std::string& one : near) one.insert(0, "builtin:");
  return near.empty() ? "" : fmt::format("; did you mean '{}'?", fmt::join(near, "' or '"));
}

const std::vector<BuiltinScene>& builtin_scenes() {
  static const std::vector<BuiltinScene> kScenes = [] {
    std::vector<BuiltinScene> scenes;
    scenes.reserve(std::size(kEntries));
    for (const Entry& entry : kEntries) scenes.push_back(entry.scene);
    return scenes;
  }();
  return kScenes;
}

namespace {

const Entry& entry_of(const std::string& name) {
  const auto found = std::ranges::find(kEntries, name, [](const Entry& entry) { return entry.scene.name; });
  if (found != kEntries.end()) return *found;
  std::vector<std::string> names;
  names.reserve(std::size(kEntries));
  for (const Entry& entry : kEntries) names.push_back(fmt::format("builtin:{}", entry.scene.name));
  throw user_error("builtin:{}: no such built-in scene; there are {}{}", name.substr(0, 60),
                   fmt::join(names, ", "), meant_builtin(name));
}

}  // namespace

SceneData build_builtin(const std::string& name, double time) { return entry_of(name).build(time); }

RecordPasses builtin_passes(const std::string& name) { return entry_of(name).record_passes; }

double builtin_length(const std::string& name) { return entry_of(name).length; }

}  // namespace quadrille::scenes
