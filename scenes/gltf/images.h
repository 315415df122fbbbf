/// The images of a glTF file as pictures that are unpacked when they are first looked at.
///
/// Encoded bytes are fetched once for each place where they lie, however many images name it, and checked
/// before the next ones are fetched: a file brings no more memory about than its own bytes, and what may be
/// unpacked grows with these.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scenes/data/scene_data.h"
#include "scenes/gltf/file.h"
#include "scenes/image/image_header.h"

namespace quadrille::scenes {

class ImageReader {
 public:
  explicit ImageReader(const GltfFile& file);
  /// Image `index`, which must exist. Throws `UserError` for bytes that are not there or no image, and when
  /// all images so far are too many pixels or bytes.
  [[nodiscard]] SceneImage read(std::size_t index);

 private:
  struct Encoded {
    std::shared_ptr<const std::vector<std::byte>> bytes;
    ImageHeader header;
    std::shared_ptr<const TextureFile> file{};  ///< of one with blocks and levels
  };
  [[noreturn]] void fail(std::size_t index, const std::string& reason) const;
  [[nodiscard]] std::string image_name(std::size_t index) const;
  [[nodiscard]] std::string image_place(std::size_t index) const;
  [[nodiscard]] std::string source_of(std::size_t index) const;
  [[nodiscard]] std::vector<std::byte> fetch(std::size_t index);

  const GltfFile& file_;
  std::map<std::string, Encoded> encoded_;  ///< by source
  std::uint64_t view_room_ = 0, file_room_ = 0;
  std::uint64_t pixels_ = 0, bytes_ = 0;
};

}  // namespace quadrille::scenes
