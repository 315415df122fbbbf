#include "scenes/gltf_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <filesystem>
#include <string_view>

#include "models/base/error.h"
#include "traces/whole_file.h"

namespace quadrille::scenes {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 31;
constexpr int kMaxJsonDepth = 128;  // the parser's walk over unknown members is recursive
constexpr std::array<std::string_view, 5> kExtensions{"KHR_texture_transform", "KHR_materials_unlit", "KHR_lights_punctual",
                                                      "KHR_mesh_quantization", "KHR_materials_emissive_strength"};

using Bytes = std::vector<std::vector<std::byte>>;

/// Keeps the encoded bytes of an image for later. A buffer view's are fetched later too, because tinygltf does not check its range.
bool keep_image(tinygltf::Image* image, const int index, std::string*, std::string*, int, int, const unsigned char* data, int size,
                void* user) {
  auto& kept = *static_cast<Bytes*>(user);
  const auto i = static_cast<std::size_t>(index);
  if (kept.size() <= i) kept.resize(i + 1);
  if (image->bufferView < 0 && size > 0)
    kept[i].assign(reinterpret_cast<const std::byte*>(data), reinterpret_cast<const std::byte*>(data) + size);
  return true;
}

bool file_exists(const std::string& path, void*) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

std::string same_path(const std::string& path, void*) { return path; }

bool read_file(std::vector<unsigned char>* out, std::string* error, const std::string& path, void*) {
  try {
    const std::vector<std::byte> bytes = traces::read_whole_file(path, kMaxFileBytes);
    out->resize(bytes.size());
    if (!bytes.empty()) std::memcpy(out->data(), bytes.data(), bytes.size());
    return true;
  } catch (const UserError& failure) {
    if (error != nullptr) *error += failure.what();
    return false;
  }
}

bool write_nothing(std::string*, const std::string&, const std::vector<unsigned char>&, void*) { return false; }

bool is_binary(std::span<const std::byte> bytes) { return bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0; }

/// The deepest nesting of brackets outside strings, whether or not the text is JSON.
int nesting_depth(std::string_view text) {
  int depth = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      deepest = std::max(deepest, ++depth);
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return deepest;
}

/// The JSON text: the whole file, or the first chunk of a binary one. [glTF2.0 #binary-gltf-layout: 12 bytes header, 8 bytes chunk header]
std::string_view json_text(std::span<const std::byte> bytes) {
  const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!is_binary(bytes) || bytes.size() < 20) return all;
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, sizeof(length));
  return all.substr(20, length);
}

/// tinygltf's messages span several lines; ours are one.
std::string first_line(const std::string& text) {
  const std::string line = text.substr(0, text.find('\n'));
  return line.empty() ? "it is not valid glTF" : line;
}

void parse(GltfFile& file, std::span<const std::byte> bytes) {
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keep_image, &file.image_bytes);
  loader.SetFsCallbacks({file_exists, same_path, read_file, write_nothing, nullptr});
  const std::string folder = std::filesystem::path(file.path).parent_path().string();
  const auto size = static_cast<unsigned int>(bytes.size());
  std::string error, warning;
  bool done = false;
  try {
    done =
        is_binary(bytes)
            ? loader.LoadBinaryFromMemory(&file.model, &error, &warning, reinterpret_cast<const unsigned char*>(bytes.data()), size, folder)
            : loader.LoadASCIIFromString(&file.model, &error, &warning, reinterpret_cast<const char*>(bytes.data()), size, folder);
  } catch (const std::exception& failure) { throw user_error("{}: cannot be parsed: {}", file.path, failure.what()); }
  if (!done) throw user_error("{}: {}", file.path, first_line(error));
}

void check_version(const GltfFile& file) {
  const tinygltf::Asset& asset = file.model.asset;
  if (!asset.version.starts_with("2.")) throw user_error("{}: asset.version '{}'; glTF 2.x is read", file.path, asset.version);
  if (!asset.minVersion.empty() && asset.minVersion != "2.0")
    throw user_error("{}: asset.minVersion '{}'; glTF 2.0 is read", file.path, asset.minVersion);
}

void check_extensions(const GltfFile& file) {
  std::string lacking;
  for (const std::string& name : file.model.extensionsRequired) {
    if (std::ranges::find(kExtensions, name) == kExtensions.end()) lacking += (lacking.empty() ? "" : ", ") + name;
  }
  if (!lacking.empty()) throw user_error("{}: extensionsRequired: {} not supported", file.path, lacking);
}

}  // namespace

GltfFile read_gltf_file(const std::string& path) {
  GltfFile file;
  file.path = path;
  const std::vector<std::byte> bytes = traces::read_whole_file(path, kMaxFileBytes);
  if (std::filesystem::path(path).extension() == ".glb" && !is_binary(bytes))
    throw user_error("{}: not a binary glTF file (by its first bytes)", path);
  if (nesting_depth(json_text(bytes)) > kMaxJsonDepth) throw user_error("{}: its JSON is nested deeper than {}", path, kMaxJsonDepth);
  parse(file, bytes);
  check_version(file);
  check_extensions(file);
  return file;
}

std::span<const std::byte> buffer_view_bytes(const GltfFile& file, int index, const std::string& place) {
  const auto& views = file.model.bufferViews;
  if (index < 0 || static_cast<std::size_t>(index) >= views.size()) {
    throw user_error("{}: {}: bufferView {} does not exist (the file has {})", file.path, place, index, views.size());
  }
  const tinygltf::BufferView& view = views[static_cast<std::size_t>(index)];
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= file.model.buffers.size()) {
    throw user_error("{}: {}: bufferViews[{}]: buffer {} does not exist (the file has {})", file.path, place, index, view.buffer,
                     file.model.buffers.size());
  }
  const std::vector<unsigned char>& data = file.model.buffers[static_cast<std::size_t>(view.buffer)].data;
  if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
    throw user_error("{}: {}: bufferViews[{}]: bytes {}+{} reach beyond buffer {} of {} bytes", file.path, place, index, view.byteOffset,
                     view.byteLength, view.buffer, data.size());
  }
  return std::as_bytes(std::span(data)).subspan(view.byteOffset, view.byteLength);
}

std::span<const std::byte> encoded_image(const GltfFile& file, std::size_t index) {
  const tinygltf::Image& image = file.model.images[index];
  if (image.bufferView >= 0) return buffer_view_bytes(file, image.bufferView, fmt::format("images[{}]", index));
  if (index >= file.image_bytes.size() || file.image_bytes[index].empty()) {
    throw user_error("{}: images[{}]: '{}' cannot be read", file.path, index, image.uri.substr(0, 200));
  }
  return file.image_bytes[index];
}

}  // namespace quadrille::scenes
