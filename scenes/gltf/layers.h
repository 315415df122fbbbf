/// The extensions that add to a glTF material: index of refraction, specular, clearcoat, sheen, transmission,
/// volume, specular-glossiness.
#pragma once

#include <string>

#include "scenes/data/scene_data.h"
#include "scenes/gltf/file.h"

namespace quadrille::scenes {

/// Reads `source`'s extensions into `material.layers` and its textures; specular-glossiness replaces the
/// metallic-roughness values. What equals the plain material is left out, so that it is drawn by the plain
/// shaders. Throws `UserError` with `place` and the member.
void read_layers(const GltfFile& file, const tinygltf::Material& source, const std::string& place,
                 Material& material);

}  // namespace quadrille::scenes
