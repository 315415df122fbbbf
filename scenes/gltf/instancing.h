/// EXT_mesh_gpu_instancing: a node that draws its mesh many times.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <glm/ext/matrix_double4x4.hpp>

#include "scenes/data/scene_data.h"
#include "scenes/gltf/file.h"

namespace quadrille::scenes {

/// The matrices of the extension's instances relative to their node, at most 2^20: as many as any of its
/// attributes has elements. What attributes other than TRANSLATION, ROTATION and SCALE hold is passed over;
/// where those three are absent, the copies lie in the node's place. None without an attribute. Throws
/// `UserError` for accessors of other types, of unequal counts, or with values that are not finite.
/// [EXT_mesh_gpu_instancing]
[[nodiscard]] std::vector<glm::dmat4> read_instances(const GltfFile& file, const tinygltf::Value& extension,
                                                     const std::string& place);

/// What one visit of all nodes has placed, and what the visits share.
struct PlacedCopies {
  /// copies times primitives; the visitor puts it to zero
  std::uint64_t drawn = 0;
  /// by the node's extension: read once
  std::map<const tinygltf::Value*, std::vector<glm::dmat4>> matrices = {};
};

/// Turns the instances of `scene` from `first` on, which a node with the matrix `world` placed, into
/// instanced draws: one of the copies that mirror and one of those that do not, since they face the other
/// way. At most 2^20 copies of primitives a scene. False, and nothing is changed, where the extension has no
/// attribute to say how many. Throws `UserError` for a matrix that is not finite.
[[nodiscard]] bool place_copies(const GltfFile& file, const tinygltf::Value& extension,
                                const std::string& place, const glm::dmat4& world, std::size_t first,
                                SceneData& scene, PlacedCopies& placed);

}  // namespace quadrille::scenes
