/// Frames of the units' benchmarks: small pictures drawn over many times, so that the beginning and the end
/// of a frame are a small part of it.
#pragma once

#include <string>

#include "studies/experiments/triangle_mesh.h"

namespace quadrille::studies::experiments {

/// Triangles of one pixel each over the whole frame, so many times.
[[nodiscard]] TriangleMesh pixel_triangles(std::uint32_t width, std::uint32_t height, std::uint32_t times);
/// The whole frame as one triangle that reaches beyond it, so many times at the same depth: no quad is shared
/// by two triangles.
[[nodiscard]] TriangleMesh covered_frame(std::uint32_t width, std::uint32_t height, std::uint32_t times);
/// The whole frame once, and so many times behind that.
[[nodiscard]] TriangleMesh hidden_frame(std::uint32_t width, std::uint32_t height, std::uint32_t times);

/// A fragment shader of `steps` multiply-adds one after the other on each of `chains` components (1 to 4).
[[nodiscard]] std::string chain_shader(int chains, int steps);
/// Its warp instructions: a step of each chain, one to read the pixel's place and one to write a colour for
/// each component that is needed.
[[nodiscard]] int chain_instructions(int chains, int steps);
/// A fragment shader around `body`, which reads and writes the words `b.w` and writes `o`.
[[nodiscard]] std::string storage_shader(const std::string& body);
/// How a fragment shader walks over its texture, in texels.
struct TextureWalk {
  int right = 1, down = 1;  ///< farther for each pixel to the right, and down
  int triangle = 0;         ///< farther to the right for each triangle of the draw
  double level = 0;
};
[[nodiscard]] std::string sampling_shader(const DrawTexture& texture, const TextureWalk& walk);

}  // namespace quadrille::studies::experiments
