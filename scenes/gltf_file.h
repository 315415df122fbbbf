/// A glTF file as tinygltf parses it, with the encoded bytes of its images beside it; and how errors name a place in it.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "scenes/tiny_gltf.h"

namespace quadrille::scenes {

struct GltfFile {
  std::string path;
  tinygltf::Model model;
  std::vector<std::vector<std::byte>>
      image_bytes;  ///< of images that are files or data URIs; empty for the others and for files that are missing
};

/// Reads and parses the file and the buffers it names, and checks what it requires. Throws `UserError` whatever goes wrong.
[[nodiscard]] GltfFile read_gltf_file(const std::string& path);

/// The bytes of buffer view `index`. Throws `UserError` with `place` when it or its range does not exist.
[[nodiscard]] std::span<const std::byte> buffer_view_bytes(const GltfFile& file, int index, const std::string& place);

/// The encoded bytes of image `index`, from wherever it keeps them. Throws `UserError` when it has none.
[[nodiscard]] std::span<const std::byte> encoded_image(const GltfFile& file, std::size_t index);

}  // namespace quadrille::scenes
