/// Frames of the units' benchmarks: small pictures drawn over many times, so that the beginning and the end of
/// a frame are a small part of it.
#pragma once

#include <string>

#include "studies/experiments/triangle_mesh.h"

namespace quadrille::studies::experiments {

/// Triangles of one pixel each over the whole frame, so many times.
[[nodiscard]] TriangleMesh pixel_triangles(std::uint32_t width, std::uint32_t height, std::uint32_t times);
/// The whole frame as two triangles, so many times at the same depth.
[[nodiscard]] TriangleMesh covered_frame(std::uint32_t width, std::uint32_t height, std::uint32_t times);
/// The whole frame once, and so many times behind that.
[[nodiscard]] TriangleMesh hidden_frame(std::uint32_t width, std::uint32_t height, std::uint32_t times);

/// A fragment shader of `steps` multiply-adds one after the other on each of `chains` components (1 to 4).
[[nodiscard]] std::string chain_shader(int chains, int steps);
/// Its warp instructions: a step of each chain, one to read the pixel's place and one to write a colour for
/// each component that is needed.
[[nodiscard]] int chain_instructions(int chains, int steps);
/// Samples its texture at level `lod`, `dx` and `dy` texels farther for each pixel to the right and down;
/// then `steps` multiply-adds on each component.
[[nodiscard]] std::string sampling_shader(const DrawTexture& texture, int dx, int dy, double lod,
                                          int steps = 0);

}  // namespace quadrille::studies::experiments
