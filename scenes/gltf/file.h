/// A glTF file as tinygltf parses it, with the encoded bytes of its images beside it; and how errors name a
/// place in it.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenes/gltf/tiny_gltf.h"

namespace quadrille::scenes {

struct Elements;

struct GltfFile {
  std::string path;
  /// its buffers and images are filled in by us; an image's `uri` is empty where it is data
  tinygltf::Model model;
  std::vector<std::optional<std::string>> image_uris;  ///< as the file has them
  /// buffer views that were compressed, by number [EXT_meshopt_compression]
  std::map<int, std::vector<std::byte>> decoded_views;
  /// accessors that were compressed, by number [KHR_draco_mesh_compression]
  std::map<int, std::shared_ptr<const Elements>> decoded_accessors;
  std::vector<std::string> notes;  ///< what is drawn otherwise than the file says, a line each
};

/// Prints the notes to standard error and forgets them; for when nothing can be refused any more, since a
/// refusal is one line.
void print_notes(GltfFile& file);

/// Reads and parses the file and the buffers it names, expands what is compressed, and checks what it
/// requires. Throws `UserError` whatever goes wrong.
[[nodiscard]] GltfFile read_gltf_file(const std::string& path);

/// The bytes of buffer view `index`. Throws `UserError` with `place` when it or its range does not exist.
[[nodiscard]] std::span<const std::byte> buffer_view_bytes(const GltfFile& file, int index,
                                                           const std::string& place);

}  // namespace quadrille::scenes
