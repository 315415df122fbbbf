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
  const auto side = [](std::uint32_t pixels) { return static_cast<std::int32_t>(2 * pixels) * kGrid; };
  return repeated({width, height, {{0, 0}, {side(width), 0}, {0, side(height)}}, {{0, 1, 2}}}, times);
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

std::string storage_shader(const std::string& body) {
  return fmt::format(R"(#version 450
layout(location = 0) out vec4 o;
layout(std430, set = 0, binding = 1) buffer B {{ uint w[]; }} b;
void main() {{ {} }})",
                     body);
}

std::string sampling_shader(const DrawTexture& texture, const TextureWalk& walk) {
  const double u = 1.0 / texture.width, v = 1.0 / texture.height;
  return fmt::format(
      "#version 450\nlayout(set = 0, binding = 0) uniform sampler2D image;\n"
      "layout(location = 0) out vec4 color;\nvoid main() {{\n"
      "vec2 at = gl_FragCoord.xy * vec2({:.9f}, {:.9f});\n"
      "at.x += float(gl_PrimitiveID) * {:.9f};\ncolor = textureLod(image, at, {:.3f});\n}}\n",
      walk.right * u, walk.down * v, walk.triangle * u, walk.level);
}

}  // namespace quadrille::studies::experiments
