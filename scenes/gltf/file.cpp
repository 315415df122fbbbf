#include "scenes/gltf/file.h"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <limits>

#include "models/base/error.h"
#include "models/base/say.h"
#include "scenes/gltf/container.h"
#include "scenes/gltf/draco.h"
#include "scenes/gltf/extensions.h"
#include "scenes/gltf/json.h"
#include "scenes/gltf/meshopt.h"
#include "scenes/gltf/uri.h"
#include "traces/whole_file.h"

namespace quadrille::scenes {
namespace {

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 31;

/// tinygltf's messages span several lines; ours are one.
std::string first_line(const std::string& text) {
  const std::string line = text.substr(0, text.find('\n'));
  return line.empty() ? "it is not valid glTF" : line;
}

/// The parser sees neither buffers nor images, so it opens no file.
void parse(GltfFile& file, const PreparedJson& json) {
  if (json.text.size() > std::numeric_limits<unsigned int>::max())
    throw user_error("{}: its JSON is too large", file.path);
  tinygltf::TinyGLTF loader;
  std::string error, warning;
  bool done = false;
  try {
    done = loader.LoadASCIIFromString(&file.model, &error, &warning, json.text.data(),
                                      static_cast<unsigned int>(json.text.size()), "");
  } catch (const std::exception& failure) {
    throw user_error("{}: cannot be parsed: {}", file.path, failure.what());
  }
  if (!done) throw user_error("{}: {}", file.path, first_line(error));
  for (const std::size_t i : json.viewless) {
    if (i < file.model.accessors.size()) file.model.accessors[i].bufferView = -1;
  }
}

/// The bytes of one buffer, cut to its length. Without a URI the first one of a binary file is its BIN chunk.
/// [glTF2.0 #glb-stored-buffer]
std::vector<std::byte> buffer_bytes(const GltfFile& file, const BufferSource& source, std::size_t index,
                                    const GltfContainer& container, std::uint64_t room) {
  const std::string place = fmt::format("{}: buffers[{}]", file.path, index);
  std::vector<std::byte> bytes;
  if (source.uri) {
    bytes = fetch_uri(file.path, *source.uri, place, room);
  } else if (index == 0 && container.binary) {
    bytes.assign(container.binary->begin(), container.binary->end());
  } else {
    return {};  // legal as long as nothing is read from it [glTF2.0 #buffers-and-buffer-views-overview]
  }
  if (bytes.size() < source.bytes)
    throw user_error("{}: byteLength {} where there are {} bytes", place, source.bytes, bytes.size());
  if (source.bytes > room) throw user_error("{}: the buffers take more than {} bytes", place, kMaxFileBytes);
  bytes.resize(source.bytes);
  return bytes;
}

void read_buffers(GltfFile& file, const PreparedJson& json, const GltfContainer& container) {
  std::uint64_t room = kMaxFileBytes;
  for (std::size_t i = 0; i < json.buffers.size(); ++i) {
    const std::vector<std::byte> bytes = buffer_bytes(file, json.buffers[i], i, container, room);
    room -= bytes.size();
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    file.model.buffers.emplace_back().data.assign(data, data + bytes.size());
  }
}

void list_images(GltfFile& file, const PreparedJson& json) {
  for (const ImageSource& source : json.images) {
    tinygltf::Image& image = file.model.images.emplace_back();
    image.name = source.name;
    image.bufferView = source.buffer_view;
    if (source.uri && !is_data_uri(*source.uri)) image.uri = *source.uri;
    file.image_uris.push_back(source.uri);
  }
}

}  // namespace

void print_notes(GltfFile& file) {
  for (const std::string& note : file.notes) say(one_line(fmt::format("{}: {}", file.path, note)) + "\n");
  file.notes.clear();
}

GltfFile read_gltf_file(const std::string& path) {
  GltfFile file;
  file.path = path;
  const std::vector<std::byte> bytes = traces::read_whole_file(
      path, kMaxFileBytes, [&](std::span<const std::byte> beginning) { look_at_gltf(path, beginning); });
  const GltfContainer container = split_gltf(path, bytes);
  const PreparedJson json = prepare_json(path, container.json);
  if (!json.note.empty()) file.notes.push_back(json.note);
  parse(file, json);
  check_extensions(file);
  read_buffers(file, json, container);
  list_images(file, json);
  decode_meshopt_views(file);
  decode_draco_primitives(file);
  return file;
}

std::span<const std::byte> buffer_view_bytes(const GltfFile& file, int index, const std::string& place) {
  const auto& views = file.model.bufferViews;
  if (index < 0 || static_cast<std::size_t>(index) >= views.size()) {
    throw user_error("{}: {}: bufferView {} does not exist (the file has {})", file.path, place, index,
                     views.size());
  }
  if (const auto decoded = file.decoded_views.find(index); decoded != file.decoded_views.end())
    return decoded->second;
  const tinygltf::BufferView& view = views[static_cast<std::size_t>(index)];
  if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= file.model.buffers.size()) {
    throw user_error("{}: {}: bufferViews[{}]: buffer {} does not exist (the file has {})", file.path, place,
                     index, view.buffer, file.model.buffers.size());
  }
  const std::vector<unsigned char>& data = file.model.buffers[static_cast<std::size_t>(view.buffer)].data;
  if (data.empty())
    throw user_error("{}: {}: bufferViews[{}]: buffer {} has no bytes (no uri, no BIN chunk)", file.path,
                     place, index, view.buffer);
  if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset) {
    throw user_error("{}: {}: bufferViews[{}]: bytes {}+{} reach beyond buffer {} of {} bytes", file.path,
                     place, index, view.byteOffset, view.byteLength, view.buffer, data.size());
  }
  return std::as_bytes(std::span(data)).subspan(view.byteOffset, view.byteLength);
}

}  // namespace quadrille::scenes
