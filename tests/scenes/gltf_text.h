/// Small glTF files written by the tests themselves: JSON with buffers as data URIs.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scenes/gltf/loader.h"

namespace quadrille::scenes {

/// `data:application/octet-stream;base64,...`
[[nodiscard]] std::string data_uri(std::span<const std::byte> bytes);

template <class T>
[[nodiscard]] std::string data_uri_of(const std::vector<T>& values) {
  return data_uri(std::as_bytes(std::span(values)));
}

/// A file in a folder of its own that goes away with the object.
class TempGltf {
 public:
  explicit TempGltf(const std::string& text, const std::string& name = "t.gltf");
  ~TempGltf();
  TempGltf(const TempGltf&) = delete;
  TempGltf& operator=(const TempGltf&) = delete;
  [[nodiscard]] std::string path() const { return (folder_ / name_).string(); }

 private:
  std::filesystem::path folder_;
  std::string name_;
};

/// One triangle as a complete file. `primitive` is put into its primitive, `extra` at the top level (both
/// with a leading comma, or empty).
[[nodiscard]] std::string triangle_gltf(const std::string& primitive = "", const std::string& extra = "",
                                        const std::string& node = "");

/// The message of the UserError that loading the text raises, or "loaded".
[[nodiscard]] std::string load_result(const std::string& text, const GltfChoice& choice = {});
/// The same, posed by the file's first animation.
[[nodiscard]] std::string animated_result(const std::string& text);

}  // namespace quadrille::scenes
