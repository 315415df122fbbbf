/// Instanced draws: many copies of one primitive in a single command.
#include <algorithm>
#include <cstring>

#include <glm/geometric.hpp>

#include "scenes/record/recorder.h"
#include "traces/trace_file.h"

namespace quadrille::scenes {
namespace {

/// What the vertex shader reads for an instance (scenes/material/shaders/material.vert).
struct CopyStreams {
  std::array<glm::vec4, 3> model_rows, normal_columns;
};

CopyStreams copy_streams(const glm::mat4& world, bool mirrored) {
  CopyStreams streams{{}, normal_matrix(world, mirrored)};
  for (int row = 0; row < 3; ++row)
    streams.model_rows[static_cast<std::size_t>(row)] =
        glm::vec4(world[0][row], world[1][row], world[2][row], world[3][row]);
  return streams;
}

}  // namespace

std::vector<glm::mat4> Recorder::ordered_copies(const Instance& instance, bool sorted) const {
  std::vector<glm::mat4> copies;
  for (const glm::dmat4& copy : placed_.at.copies[static_cast<std::size_t>(instance.copies)])
    copies.emplace_back(copy);
  if (!sorted) return copies;
  const glm::vec4 center(scene_.model_box(instance).center(), 1);
  const auto distance = [&](const glm::mat4& m) {
    return glm::dot(view_.eye - glm::vec3(m * center), view_.toward_viewer);
  };
  std::ranges::stable_sort(copies, std::ranges::greater{}, distance);
  return copies;
}

traces::Index Recorder::copies_buffer(const Instance& instance, bool sorted, bool mirrored) {
  if (const auto found = copies_buffers_.find(instance.copies); !sorted && found != copies_buffers_.end())
    return found->second;
  const std::vector<glm::mat4> copies = ordered_copies(instance, sorted);
  std::vector<std::byte> data(copies.size() * sizeof(CopyStreams));
  for (std::size_t i = 0; i < copies.size(); ++i) {
    const CopyStreams streams = copy_streams(copies[i], mirrored);
    std::memcpy(&data[i * sizeof(streams)], &streams, sizeof(streams));
  }
  stream_.buffers.push_back({instance.label + " instances", std::move(data)});
  const auto buffer = static_cast<traces::Index>(stream_.buffers.size() - 1);
  if (!sorted) copies_buffers_[instance.copies] = buffer;
  return buffer;
}

void Recorder::record_copies(const Instance& instance, Geometry g) {
  const bool sorted =
      scene_.materials[static_cast<std::size_t>(scene_.primitives[instance.primitive].material)]
          .see_through();
  if (options_.visibility || !options_.vertex_shader.empty()) {
    bind(instance, g);
    for (const glm::mat4& copy : ordered_copies(instance, sorted)) record_draw(instance, g, copy, 1);
    return;
  }
  g.variant.instanced = true;
  bind(instance, g);
  bind_once(traces::BindVertexBuffer{kCopiesBinding, copies_buffer(instance, sorted, g.mirrored), 0},
            kVertexSlot + kCopiesBinding);
  const std::vector<glm::dmat4>& copies = placed_.at.copies[static_cast<std::size_t>(instance.copies)];
  record_draw(instance, g, glm::mat4(copies.front()), static_cast<std::uint32_t>(copies.size()));
}

}  // namespace quadrille::scenes
