/// The container of a glTF file: JSON text alone, or a binary file of chunks.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace quadrille::scenes {

struct GltfContainer {
  std::string_view json;
  std::optional<std::span<const std::byte>> binary;  ///< the BIN chunk, with its padding
};

/// Throws `UserError` for what cannot be a glTF file by its first bytes, so that the rest need not be read.
void look_at_gltf(const std::string& path, std::span<const std::byte> beginning);

/// Splits the bytes of `path`, which must outlive the result. A binary file is known by its first bytes; its
/// chunks are JSON, then BIN where there is one, then chunks of other types, which are passed over. Throws
/// `UserError` when a chunk does not fit or is out of its place. [glTF2.0 #glb-file-format-specification]
[[nodiscard]] GltfContainer split_gltf(const std::string& path, std::span<const std::byte> bytes);

}  // namespace quadrille::scenes
