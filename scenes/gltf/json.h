/// The JSON of a glTF file, made ready for tinygltf: buffers and images are taken out of it, so that this
/// project and not the parser decides what is read.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace quadrille::scenes {

struct BufferSource {
  std::uint64_t bytes = 0;  ///< `byteLength`
  /// none: the BIN chunk, or a buffer without bytes, as those are that compressed views stand for
  std::optional<std::string> uri;
};

struct ImageSource {
  std::string name;
  std::optional<std::string> uri;
  int buffer_view = -1;
};

struct PreparedJson {
  std::string text;  ///< for tinygltf
  std::vector<BufferSource> buffers;
  std::vector<ImageSource> images;
  std::string note;  ///< what counts otherwise than it is written, in a line; empty: nothing
  /// accessors that have no buffer view; in `text` they have number 0, since tinygltf refuses indices without
  /// one
  std::vector<std::size_t> viewless;
};

/// Parses `json`, the text of the file `path`. Throws `UserError` when it is not JSON in UTF-8, is nested
/// deeper than 128, or its buffers or images are malformed.
[[nodiscard]] PreparedJson prepare_json(const std::string& path, std::string_view json);

}  // namespace quadrille::scenes
