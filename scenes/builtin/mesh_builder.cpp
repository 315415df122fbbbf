#include "scenes/builtin/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/geometric.hpp>

namespace quadrille::scenes {
namespace {

template <class T, class Get>
int add_stream(SceneData& scene, const std::string& name, traces::Format format,
               const std::vector<MeshBuilder::Vertex>& vertices, const Get& get) {
  std::vector<std::byte> data(vertices.size() * sizeof(T));
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const T value = get(vertices[i]);
    std::memcpy(&data[i * sizeof(T)], &value, sizeof(T));
  }
  scene.arrays.push_back({name, format, static_cast<std::uint32_t>(vertices.size()), std::move(data)});
  return static_cast<int>(scene.arrays.size() - 1);
}

template <class T>
std::vector<std::byte> narrowed(const std::vector<std::uint32_t>& indices) {
  std::vector<std::byte> data(indices.size() * sizeof(T));
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const T value = static_cast<T>(indices[i]);
    std::memcpy(&data[i * sizeof(T)], &value, sizeof(T));
  }
  return data;
}

glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& fallback) {
  const float length = glm::length(v);
  return length > 1e-12F ? v / length : fallback;
}

}  // namespace

std::uint32_t MeshBuilder::vertex(const Vertex& v) {
  vertices_.push_back(v);
  return static_cast<std::uint32_t>(vertices_.size() - 1);
}

void MeshBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  indices_.insert(indices_.end(), {a, b, c});
}

void MeshBuilder::patch(std::uint32_t columns, std::uint32_t rows, const PatchFunction& point) {
  constexpr float kStep = 1.0F / 1024;
  const auto first = static_cast<std::uint32_t>(vertices_.size());
  for (std::uint32_t row = 0; row <= rows; ++row) {
    for (std::uint32_t column = 0; column <= columns; ++column) {
      const float u = static_cast<float>(column) / static_cast<float>(columns),
                  v = static_cast<float>(row) / static_cast<float>(rows);
      const PatchPoint p = point(u, v);
      // At a pole the direction of u vanishes: the differences are taken a little inside.
      const float inner_v = std::clamp(v, 2 * kStep, 1 - 2 * kStep);
      const glm::vec3 along_u = point(u + kStep, inner_v).position - point(u - kStep, inner_v).position;
      const glm::vec3 along_v = point(u, inner_v + kStep).position - point(u, inner_v - kStep).position;
      const glm::vec3 t = unit_or(along_u, {1, 0, 0});
      vertex({p.position, unit_or(glm::cross(along_v, along_u), {0, 1, 0}), glm::vec4(t, 1), p.uv, p.color});
    }
  }
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t a = first + row * (columns + 1) + column, b = a + columns + 1;
      triangle(a, b, b + 1);
      triangle(a, b + 1, a + 1);
    }
  }
}

void MeshBuilder::box(const glm::vec3& low, const glm::vec3& high, float uv_scale, const glm::vec4& color) {
  struct Face {
    glm::vec3 right, down;
  };
  constexpr std::array<Face, 6> kFaces{{{{1, 0, 0}, {0, -1, 0}},
                                        {{-1, 0, 0}, {0, -1, 0}},
                                        {{0, 0, -1}, {0, -1, 0}},
                                        {{0, 0, 1}, {0, -1, 0}},
                                        {{1, 0, 0}, {0, 0, 1}},
                                        {{1, 0, 0}, {0, 0, -1}}}};
  const glm::vec3 center = 0.5F * (low + high), half = 0.5F * (high - low);
  for (const Face& face : kFaces) {
    const glm::vec3 normal = glm::cross(face.down, face.right);
    const auto extent = [&](const glm::vec3& axis) { return std::abs(glm::dot(axis, half)); };
    patch(1, 1, [&](float u, float v) {
      const float x = (2 * u - 1) * extent(face.right), y = (2 * v - 1) * extent(face.down);
      return PatchPoint{center + normal * extent(normal) + face.right * x + face.down * y,
                        glm::vec2(x, y) * uv_scale + 0.5F, color};
    });
  }
}

std::uint32_t MeshBuilder::finish(SceneData& scene, const std::string& name, int material,
                                  const Streams& streams) const {
  Primitive p;
  p.name = name;
  p.material = material;
  p.count = static_cast<std::uint32_t>(indices_.size());
  const auto stream = [&]<class T>(Semantic semantic, bool wanted, const char* suffix, traces::Format format,
                                   T Vertex::*member) {
    if (wanted)
      p.attributes[static_cast<std::size_t>(semantic)] =
          add_stream<T>(scene, name + suffix, format, vertices_, [&](const Vertex& v) { return v.*member; });
  };
  stream(Semantic::kPosition, true, ".position", traces::Format::kR32G32B32Float, &Vertex::position);
  stream(Semantic::kNormal, streams.normal, ".normal", traces::Format::kR32G32B32Float, &Vertex::normal);
  stream(Semantic::kTangent, streams.tangent, ".tangent", traces::Format::kR32G32B32A32Float,
         &Vertex::tangent);
  stream(Semantic::kUv0, streams.uv, ".uv", traces::Format::kR32G32Float, &Vertex::uv);
  stream(Semantic::kColor, streams.color, ".color", traces::Format::kR32G32B32A32Float, &Vertex::color);
  const bool small = vertices_.size() <= 0xffff;
  p.index_type = small ? traces::IndexType::kUint16 : traces::IndexType::kUint32;
  scene.arrays.push_back({name + ".indices", traces::Format::kUndefined, p.count,
                          small ? narrowed<std::uint16_t>(indices_) : narrowed<std::uint32_t>(indices_)});
  p.indices = static_cast<int>(scene.arrays.size() - 1);
  for (const Vertex& v : vertices_) p.bounds.add(v.position);
  scene.primitives.push_back(std::move(p));
  return static_cast<std::uint32_t>(scene.primitives.size() - 1);
}

void place(SceneData& scene, std::uint32_t primitive, const glm::mat4& world) {
  scene.instances.push_back({primitive, world, scene.primitives[primitive].name});
}

int add_image(SceneData& scene, const std::string& name, Rgba8Image image) {
  scene.images.emplace_back(name, std::move(image));
  return static_cast<int>(scene.images.size() - 1);
}

}  // namespace quadrille::scenes
