/// Buffer views that meshoptimizer's encoders packed, and scenes of them.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenes/data/scene_data.h"
#include "tests/scenes/compressed_gltf.h"

namespace quadrille::scenes {

[[nodiscard]] View attributes_view(const void* data, std::size_t count, std::size_t stride,
                                   const std::string& filter = "NONE");
[[nodiscard]] View triangles_view(const Grid& grid);
[[nodiscard]] View sequence_view(const Grid& grid);

/// The grid's four streams, packed.
[[nodiscard]] std::vector<View> packed_views(const Grid& grid);

[[nodiscard]] SceneData load_text(const std::string& text);

/// Of the scene's first primitive.
[[nodiscard]] const Array& stream(const SceneData& scene, Semantic semantic);

}  // namespace quadrille::scenes
