/// Meshes whose faces share no vertices, so that every vertex can have its face's normal: what flat shading
/// draws, and what meshes without normals look like.
#pragma once

#include <optional>

#include "scenes/data/scene_data.h"
#include "scenes/material/material_variant.h"

namespace quadrille::scenes {

/// The scene with three vertices of its own for each triangle, where the shaders of `set` ask for normals
/// that the mesh does not have. For flat shading that is everywhere; in other sets the faces get normals only
/// where the file has none. Such a mesh is a list of triangles without indices, posed by the host. None:
/// nothing has to be changed. Throws `UserError` when the vertices take more than 768 MiB.
[[nodiscard]] std::optional<SceneData> with_facets(const SceneData& scene, ShaderSet set);

}  // namespace quadrille::scenes
