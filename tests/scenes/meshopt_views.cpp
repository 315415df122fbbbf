#include "tests/scenes/meshopt_views.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

#include <cstring>

#include "scenes/gltf/loader.h"
#include "tests/scenes/gltf_text.h"

namespace quadrille::scenes {
namespace {

template <class Encode>
std::vector<std::byte> encoded(std::size_t bound, const Encode& encode) {
  std::vector<unsigned char> buffer(bound);
  buffer.resize(encode(buffer.data(), buffer.size()));
  std::vector<std::byte> bytes(buffer.size());
  std::memcpy(bytes.data(), buffer.data(), bytes.size());
  return bytes;
}

}  // namespace

View attributes_view(const void* data, std::size_t count, std::size_t stride, const std::string& filter) {
  const auto bytes =
      encoded(meshopt_encodeVertexBufferBound(count, stride), [&](unsigned char* out, std::size_t size) {
        return meshopt_encodeVertexBuffer(out, size, data, count, stride);
      });
  return {
      bytes, count * stride,
      fmt::format(R"("byteStride":{},"count":{},"mode":"ATTRIBUTES","filter":"{}")", stride, count, filter)};
}

View triangles_view(const Grid& grid) {
  const auto bytes =
      encoded(meshopt_encodeIndexBufferBound(grid.indices.size(), grid.vertices()),
              [&](unsigned char* out, std::size_t size) {
                return meshopt_encodeIndexBuffer(out, size, grid.indices.data(), grid.indices.size());
              });
  return {bytes, 4 * grid.indices.size(),
          fmt::format(R"("byteStride":4,"count":{},"mode":"TRIANGLES")", grid.indices.size())};
}

View sequence_view(const Grid& grid) {
  const auto bytes =
      encoded(meshopt_encodeIndexSequenceBound(grid.indices.size(), grid.vertices()),
              [&](unsigned char* out, std::size_t size) {
                return meshopt_encodeIndexSequence(out, size, grid.indices.data(), grid.indices.size());
              });
  return {bytes, 4 * grid.indices.size(),
          fmt::format(R"("byteStride":4,"count":{},"mode":"INDICES")", grid.indices.size())};
}

std::vector<View> packed_views(const Grid& grid) {
  return {attributes_view(grid.positions.data(), grid.vertices(), 12),
          attributes_view(grid.normals.data(), grid.vertices(), 12),
          attributes_view(grid.uvs.data(), grid.vertices(), 8), triangles_view(grid)};
}

SceneData load_text(const std::string& text) {
  const TempGltf file(text);
  return load_gltf(file.path());
}

const Array& stream(const SceneData& scene, Semantic semantic) {
  return scene
      .arrays[static_cast<std::size_t>(scene.primitives[0].attributes[static_cast<std::size_t>(semantic)])];
}

}  // namespace quadrille::scenes
