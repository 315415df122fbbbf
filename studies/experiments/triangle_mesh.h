/// Meshes of flat triangles in the window, for experiments whose outcome follows from counting: what is
/// drawn, and the frame that draws it.
///
/// Corners lie on the grid of 1/256 pixel that the machine snaps to, so what a triangle covers is known
/// exactly.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "traces/command_stream.h"

namespace quadrille::studies::experiments {

inline constexpr std::int32_t kGrid = 256;  ///< steps of a pixel

struct WindowCorner {
  std::int32_t x = 0, y = 0;  ///< 1/256 pixel, y down
  float depth = 0.5F;
};

struct TriangleMesh {
  std::uint32_t width = 0, height = 0;  ///< of the frame, pixels
  std::vector<WindowCorner> corners;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  /// Two triangles that make up the rectangle between two corners, in pixels; its four corners are new.
  void rectangle(std::int32_t left, std::int32_t top, std::int32_t right, std::int32_t bottom, float depth);
};

/// The frame filled by pairs of triangles, each pair a tile of `tile_width` x `tile_height` pixels (cut at
/// the right and lower edge). Tiles come in columns of `column_tiles`, from top to bottom, and share their
/// corners within a column.
[[nodiscard]] TriangleMesh tiled_frame(std::uint32_t width, std::uint32_t height, std::uint32_t tile_width,
                                       std::uint32_t tile_height, std::uint32_t column_tiles = 4);

/// A texture at set 0, binding 0 of the fragment shader. What it shows does not matter: its texels are all
/// alike.
struct DrawTexture {
  std::uint32_t width = 0, height = 0;  ///< texels; 0: none
  std::uint32_t levels = 1;
  traces::Filter filter = traces::Filter::kNearest;  ///< within a level and between levels
  traces::Format format = traces::Format::kR8G8B8A8Unorm;
};

struct DrawOptions {
  /// what the mesh's indices are: triangles, or lines or points of the same corners
  traces::Topology topology = traces::Topology::kTriangleList;
  traces::CullMode cull = traces::CullMode::kNone;
  bool depth = false;     ///< test "less" and write
  bool discards = false;  ///< the fragment shader drops half of its fragments
  bool blends = false;    ///< over what is there, by alpha, so that each fragment reads the colour it changes
  std::string fragment_shader{};                           ///< GLSL; empty: one colour
  traces::Format format = traces::Format::kR8G8B8A8Unorm;  ///< of the colour attachment
  DrawTexture texture{};
  std::uint32_t storage_words = 0;  ///< of a storage buffer at set 0, binding 1, zeros; 0: there is none
  std::uint32_t draws = 1;          ///< so often, each a draw of its own
  traces::Format depth_format = traces::Format::kD32Float;  ///< where `depth` is asked for
};
/// An indexed draw of the mesh; the shaders hand positions through and write one colour.
[[nodiscard]] traces::CommandStream stream_of(const TriangleMesh& mesh, const DrawOptions& options = {});

}  // namespace quadrille::studies::experiments
