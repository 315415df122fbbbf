/// Textures of glTF materials: which image, through which sampler, at which coordinates.
#pragma once

#include <string>

#include "scenes/data/scene_data.h"
#include "scenes/gltf/file.h"
#include "scenes/gltf/value.h"

namespace quadrille::scenes {

/// A material's mention of a texture, wherever it stands in the JSON.
struct TextureMention {
  int index = -1;  ///< into the file's textures; -1: none
  int uv_set = 0;
  const tinygltf::Value* transform = nullptr;  ///< KHR_texture_transform
};

/// Any of tinygltf's three texture-info types.
template <class Info>
[[nodiscard]] TextureMention mention_of(const Info& info) {
  const auto found = info.extensions.find("KHR_texture_transform");
  return {info.index, info.texCoord, found == info.extensions.end() ? nullptr : &found->second};
}

/// The texture info that an extension's object has as `name`; none where it lacks it.
[[nodiscard]] TextureMention mention_of(const GltfObject& object, const char* name);

/// What the mention at `place` ("materials[0].normalTexture") leads to. An image of EXT_texture_webp or
/// MSFT_texture_dds goes before the texture's own `source`; a texture that has only KHR_texture_basisu is
/// refused. Throws `UserError`.
[[nodiscard]] TextureUse read_texture(const GltfFile& file, const TextureMention& mention,
                                      const std::string& place);

}  // namespace quadrille::scenes
