/// Builds meshes for the built-in scenes: patches over a parameter square, boxes, single quads.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scenes/data/scene_data.h"

namespace quadrille::scenes {

/// What a patch function answers for a point (u, v) of the unit square.
struct PatchPoint {
  glm::vec3 position{0};
  glm::vec2 uv{0};
  glm::vec4 color{1};
};
using PatchFunction = std::function<PatchPoint(float u, float v)>;

/// Which streams a finished primitive gets besides positions.
struct Streams {
  bool normal = true, tangent = false, uv = true, color = false;
};

class MeshBuilder {
 public:
  struct Vertex {
    glm::vec3 position{0}, normal{0, 0, 1};
    glm::vec4 tangent{1, 0, 0, 1};
    glm::vec2 uv{0};
    glm::vec4 color{1};
  };

  std::uint32_t vertex(const Vertex& v);
  /// Counter-clockwise seen from the front.
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  /// A grid of `columns` x `rows` quads. Seen from the front, u goes right and v down; normals and tangents
  /// come from differences of the positions.
  void patch(std::uint32_t columns, std::uint32_t rows, const PatchFunction& point);
  /// An axis-aligned box, each face one quad with `uv_scale` texture repeats a metre.
  void box(const glm::vec3& low, const glm::vec3& high, float uv_scale,
           const glm::vec4& color = glm::vec4(1));
  [[nodiscard]] std::size_t triangles() const { return indices_.size() / 3; }

  /// Adds the mesh to the scene; returns its number. Indices take the smallest type that holds them.
  std::uint32_t finish(SceneData& scene, const std::string& name, int material, const Streams& streams) const;

 private:
  std::vector<Vertex> vertices_;
  std::vector<std::uint32_t> indices_;
};

/// Adds an instance of a primitive, labelled by its name.
void place(SceneData& scene, std::uint32_t primitive, const glm::mat4& world = glm::mat4(1));
/// Adds a texture; returns its image number.
int add_image(SceneData& scene, const std::string& name, Rgba8Image image);

}  // namespace quadrille::scenes
