/// Tangents of triangles with texture coordinates, as normal maps expect them: by Mikkelsen's definition
/// [P: Mikkelsen 2008], which exporters and bakers share, so that what was baked in their frames is read in
/// the same ones.
///
/// Vertices of equal position, normal and coordinates are one, however often a mesh holds them. Around each,
/// triangles that touch at an edge and whose coordinates wind the same way form a group. A group has one
/// tangent: the directions in which u grows over its triangles, brought into the plane of the normal and
/// weighted by the triangles' angles there. Where the winding turns (mirrored coordinates) a vertex therefore
/// has two tangents, so the result is by corner.
///
/// - A triangle whose coordinates span no area joins any group that reaches it, and adds nothing.
/// - A triangle with two corners in one place takes the tangents that others have there.
/// - Where nothing gives a tangent: the x axis in the plane of the normal, or y where the normal is along x.
///
/// Computed in double without the host's transcendentals, and rounded once.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace quadrille::scenes {

struct TangentMesh {
  /// by vertex, model space. Normals need not be of unit length; those of length zero restrict nothing.
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec2> uvs;          ///< by vertex; v grows downward, as in glTF
  std::vector<std::uint32_t> corners;  ///< vertices, three a triangle
};

/// By corner: the tangent, of unit length, and in w the sign (1 or -1) of the bitangent, which is
/// cross(normal, tangent) * w and points to lesser v. [glTF2.0 #meshes-overview] Values that are not finite
/// count as coordinates without area. The order of the triangles does not matter where no edge has more than
/// two and every triangle has coordinates of some area.
[[nodiscard]] std::vector<glm::vec4> tangents_of(const TangentMesh& mesh);

}  // namespace quadrille::scenes
