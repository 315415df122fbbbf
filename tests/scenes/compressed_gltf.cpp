#include "tests/scenes/compressed_gltf.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>

#include "tests/scenes/gltf_text.h"

namespace quadrille::scenes {
namespace {

template <class T>
std::vector<std::byte> bytes_of(const std::vector<T>& values) {
  std::vector<std::byte> bytes(values.size() * sizeof(T));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

}  // namespace

Grid wavy_grid(int n) {
  Grid grid;
  for (int y = 0; y <= n; ++y) {
    for (int x = 0; x <= n; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(n),
                  v = static_cast<float>(y) / static_cast<float>(n);
      const float slope = 0.25F * (u - 0.5F), length = std::sqrt(1 + slope * slope);
      grid.positions.insert(grid.positions.end(), {u, 0.125F * (u - 0.5F) * (u - 0.5F), v});
      grid.normals.insert(grid.normals.end(), {-slope / length, 1 / length, 0});
      grid.uvs.insert(grid.uvs.end(), {u, 1 - v});
    }
  }
  const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const std::uint32_t a = at(x, y), b = at(x, y + 1), c = at(x + 1, y + 1), d = at(x + 1, y);
      grid.indices.insert(grid.indices.end(), {a, b, c, a, c, d});
    }
  }
  return grid;
}

std::vector<View> plain_views(const Grid& grid) {
  std::vector<View> views;
  for (const auto& bytes :
       {bytes_of(grid.positions), bytes_of(grid.normals), bytes_of(grid.uvs), bytes_of(grid.indices)})
    views.push_back({bytes, bytes.size(), ""});
  return views;
}

std::string grid_gltf(const Grid& grid, const std::vector<View>& views, const std::string& normals) {
  std::vector<std::byte> data;
  std::string table;
  std::size_t offset = 0;  // in the fallback buffer, number 1
  for (const View& view : views) {
    const std::string place =
        fmt::format(R"("byteOffset":{},"byteLength":{})", data.size(), view.bytes.size());
    if (view.extension.empty()) {
      table += fmt::format(R"({}{{"buffer":0,{}}})", table.empty() ? "" : ",", place);
    } else {
      table += fmt::format(
          R"({}{{"buffer":1,"byteOffset":{},"byteLength":{},"extensions":{{"EXT_meshopt_compression":{{"buffer":0,{},{}}}}}}})",
          table.empty() ? "" : ",", offset, view.expanded, place, view.extension);
    }
    offset += (view.expanded + 3) / 4 * 4;
    data.insert(data.end(), view.bytes.begin(), view.bytes.end());
    data.resize((data.size() + 3) / 4 * 4);
  }
  const std::size_t vertices = grid.vertices();
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],"extensionsRequired":["EXT_meshopt_compression"],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}},"indices":3}}]}}],"accessors":[)"
      R"({{"bufferView":0,"componentType":5126,"count":{0},"type":"VEC3"}},{{"bufferView":1,{1},"count":{0},"type":"VEC3"}},)"
      R"({{"bufferView":2,"componentType":5126,"count":{0},"type":"VEC2"}},{{"bufferView":3,"componentType":5125,"count":{2},"type":"SCALAR"}}],)"
      R"("bufferViews":[{3}],"buffers":[{{"byteLength":{4},"uri":"{5}"}},)"
      R"({{"byteLength":{6},"extensions":{{"EXT_meshopt_compression":{{"fallback":true}}}}}}]}})",
      vertices, normals, grid.indices.size(), table, data.size(), data_uri(data),
      std::max<std::size_t>(offset, 1));
}

}  // namespace quadrille::scenes
