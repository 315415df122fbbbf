#include "studies/experiments/draw_meshes.h"

#include <meshoptimizer.h>

#include <cstring>
#include <unordered_map>

#include "models/geometry/primitive_walk.h"
#include "pipeline/driver/frame_builder.h"
#include "pipeline/machine/machine_config.h"

namespace quadrille::studies::experiments {
namespace {

std::uint32_t vertex_number(const hw::DrawState& draw, const models::DeviceMemory& memory,
                            std::uint32_t position) {
  if (!draw.indexed) return position;
  std::uint32_t index = 0;
  std::memcpy(
      &index,
      memory.read(draw.index_address + std::uint64_t{position} * draw.index_bytes, draw.index_bytes).data(),
      draw.index_bytes);
  return index;
}

DrawMesh mesh_of(const hw::DrawState& draw, const models::DeviceMemory& memory) {
  DrawMesh mesh;
  mesh.instances = draw.instances;
  std::unordered_map<std::uint32_t, std::uint32_t> numbers;
  models::PrimitiveWalk walk;
  walk.start(draw.topology, draw.count, draw.restarts);
  const auto ends_run = [&](std::uint32_t position) {
    return vertex_number(draw, memory, position) == models::restart_index(draw.index_bytes);
  };
  for (; walk.look(ends_run, [](std::uint32_t) {}); walk.advance()) {
    for (const std::uint32_t position : walk.positions()) {
      const auto next = static_cast<std::uint32_t>(numbers.size());
      mesh.corners.push_back(numbers.emplace(vertex_number(draw, memory, position), next).first->second);
    }
  }
  mesh.vertices = static_cast<std::uint32_t>(numbers.size());
  return mesh;
}

}  // namespace

std::vector<DrawMesh> draw_meshes(const traces::CommandStream& stream) {
  const pipeline::MachineConfig machine;
  pipeline::DeviceFrame device(std::uint64_t{1} << 34);  // as much as a machine may have
  pipeline::build_frame(stream, machine.precision(), device);
  std::vector<DrawMesh> meshes;
  for (const hw::DrawState& draw : device.frame.draws) {
    if (draw.primitives.assembled != models::PieceKind::kTriangle || draw.instances == 0) continue;
    if (DrawMesh mesh = mesh_of(draw, device.memory); !mesh.corners.empty())
      meshes.push_back(std::move(mesh));
  }
  return meshes;
}

std::uint64_t analysed_vertices(const DrawMesh& mesh, unsigned cache, unsigned warp, unsigned group) {
  const auto counted =
      meshopt_analyzeVertexCache(mesh.corners.data(), mesh.corners.size(), mesh.vertices, cache, warp, group);
  return std::uint64_t{mesh.instances} * counted.vertices_transformed;
}

}  // namespace quadrille::studies::experiments
