/// Tangents for meshes whose materials have a normal map while the file has none: glTF asks for those of
/// MikkTSpace. [glTF2.0 #meshes-overview] [G: PR 2046: of the coordinates of that map]
#pragma once

#include "scenes/data/scene_data.h"

namespace quadrille::scenes {

/// What is made for a scene at most [G: seconds, a gigabyte]. Morph targets count as triangles of their own.
inline constexpr std::size_t kMostTangentTriangles = std::size_t{1} << 23;
inline constexpr std::size_t kMostOfPrimitive = std::size_t{1} << 22;

/// Gives tangents to every primitive of triangles that has normals and a normal map's coordinates but no
/// tangents. A vertex with several becomes several, in all its streams; a strip or fan that holds such a
/// vertex becomes a list of triangles. Texture transforms count. Morph targets that move positions or normals
/// get what they add to tangents.
/// Left without, so that their shaders derive a frame, are primitives without normals, whose normals are
/// those of the faces, and materials with two normal maps at different coordinates. So are primitives, or
/// morph targets of one, that are too many; returns how many primitives that concerns.
[[nodiscard]] std::size_t add_tangents(SceneData& scene);

}  // namespace quadrille::scenes
