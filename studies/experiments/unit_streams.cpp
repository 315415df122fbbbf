#include "studies/experiments/unit_streams.h"

#include <fmt/format.h>

#include "studies/experiments/measured_meshes.h"

namespace quadrille::studies::experiments {

TriangleMesh pixel_triangles(std::uint32_t width, std::uint32_t height, std::uint32_t times) {
  // A tile of 2x1 pixels is two triangles of one pixel each. Eight in a row share nine corners, so that two
  // rows, 32 triangles, fill a batch of vertices.
  return repeated(tiled_frame(width, height, 2, 1, 8), times);
}

TriangleMesh covered_frame(std::uint32_t width, std::uint32_t height, std::uint32_t times) {
  return repeated(layers(width, height, 1, true), times);
}

TriangleMesh hidden_frame(std::uint32_t width, std::uint32_t height, std::uint32_t times) {
  TriangleMesh mesh = layers(width, height, 2, true);
  const std::array behind{mesh.triangles[2], mesh.triangles[3]};
  for (std::uint32_t i = 1; i < times; ++i)
    mesh.triangles.insert(mesh.triangles.end(), behind.begin(), behind.end());
  return mesh;
}

std::string chain_shader(int chains, int steps) {
  const std::string type = chains == 1 ? "float" : fmt::format("vec{}", chains);
  const std::string components = std::string("xyzw").substr(0, static_cast<std::size_t>(chains));
  std::string text = fmt::format(
      "#version 450\nlayout(location = 0) out vec4 color;\nvoid main() {{\n{} c = gl_FragCoord.{};\n", type,
      components);
  for (int i = 0; i < steps; ++i) text += "c = c * 0.99 + 0.25;\n";
  const std::string rest[] = {"vec4(c, 0, 0, 1)", "vec4(c, 0, 1)", "vec4(c, 1)", "c"};
  return text + fmt::format("color = {};\n}}\n", rest[chains - 1]);
}

int chain_instructions(int chains, int steps) {
  constexpr int kOutputs = 4;
  return chains * (steps + 1) + kOutputs;
}

std::string sampling_shader(const DrawTexture& texture, int dx, int dy, double lod, int steps) {
  std::string text = fmt::format(
      "#version 450\nlayout(set = 0, binding = 0) uniform sampler2D image;\n"
      "layout(location = 0) out vec4 color;\nvoid main() {{\n"
      "vec4 c = textureLod(image, gl_FragCoord.xy * vec2({:.9f}, {:.9f}), {:.3f});\n",
      static_cast<double>(dx) / texture.width, static_cast<double>(dy) / texture.height, lod);
  for (int i = 0; i < steps; ++i) text += "c = c * 0.99 + 0.25;\n";
  return text + "color = c;\n}\n";
}

}  // namespace quadrille::studies::experiments
