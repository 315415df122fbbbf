#include "scenes/gltf/images.h"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "models/base/error.h"
#include "scenes/gltf/uri.h"
#include "scenes/image/texture_file.h"

namespace quadrille::scenes {
namespace {

constexpr std::uint64_t kFreePixels = std::uint64_t{1} << 26,
                        // [G: half a gigabyte with mips, and flat textures of real scenes]
    kPixelsAByte = 32;
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 31;

/// Of the formats whose picture always has the size that the header checked here says: others have windows,
/// cubes and frames.
std::optional<SceneImage::Size> picture_size(const ImageHeader& header) {
  const bool sure = header.format == ImageFormat::kPng || header.format == ImageFormat::kJpeg;
  return sure ? std::optional(SceneImage::Size{header.width, header.height}) : std::nullopt;
}

}  // namespace

ImageReader::ImageReader(const GltfFile& file) : file_(file), file_room_(kMaxFileBytes) {
  for (const tinygltf::Buffer& buffer : file.model.buffers) view_room_ += buffer.data.size();
  for (const auto& [view, bytes] : file.decoded_views) view_room_ += bytes.size();
}

SceneImage ImageReader::read(std::size_t index) {
  const auto [entry, added] = encoded_.try_emplace(source_of(index));
  Encoded& encoded = entry->second;
  const std::string place = image_place(index);
  if (added) {
    encoded.bytes = std::make_shared<const std::vector<std::byte>>(fetch(index));
    if (is_texture_file(*encoded.bytes)) {
      encoded.file = std::make_shared<const TextureFile>(read_texture_file(*encoded.bytes, place));
      encoded.header.width = encoded.file->width;
      encoded.header.height = encoded.file->height;
    } else {
      encoded.header = check_image_header(*encoded.bytes, place);
    }
    bytes_ += encoded.bytes->size();
  }
  // A few bytes can say that they are many pixels: what a scene may unpack grows with what it brings.
  pixels_ += std::uint64_t{encoded.header.width} * encoded.header.height;
  if (pixels_ > kFreePixels + kPixelsAByte * bytes_)
    fail(index,
         fmt::format(
             "the images up to here are {} pixels in {} bytes of files; legal are {} and {} more a byte",
             pixels_, bytes_, kFreePixels, kPixelsAByte));
  if (encoded.file != nullptr) return {image_name(index), encoded.file};
  return {image_name(index), picture_size(encoded.header),
          [bytes = encoded.bytes, place] { return decode_image(*bytes, place); }};
}

void ImageReader::fail(std::size_t index, const std::string& reason) const {
  throw user_error("{}: images[{}]: {}", file_.path, index, reason);
}

/// Where the bytes lie: equal for two images that have the same.
std::string ImageReader::source_of(std::size_t index) const {
  const int view = file_.model.images[index].bufferView;
  if (view >= 0) {
    if (file_.decoded_views.contains(view) ||
        static_cast<std::size_t>(view) >= file_.model.bufferViews.size())
      return fmt::format("view {}", view);
    const tinygltf::BufferView& range = file_.model.bufferViews[static_cast<std::size_t>(view)];
    return fmt::format("buffer {} {} {}", range.buffer, range.byteOffset, range.byteLength);
  }
  const std::optional<std::string>& uri = file_.image_uris[index];
  if (!uri) fail(index, "it has neither uri nor bufferView");
  if (is_data_uri(*uri)) return *uri;
  const std::string path = uri_file(file_.path, *uri, fmt::format("{}: images[{}]", file_.path, index));
  std::error_code lost;
  const std::filesystem::path target = std::filesystem::weakly_canonical(path, lost);
  return "file " + (lost ? path : target.string());
}

std::vector<std::byte> ImageReader::fetch(std::size_t index) {
  const int view = file_.model.images[index].bufferView;
  if (view >= 0) {
    const std::span<const std::byte> bytes = buffer_view_bytes(file_, view, fmt::format("images[{}]", index));
    if (bytes.size() > view_room_)
      fail(index, "the images up to here have buffer views that overlap, and more bytes than all buffers");
    view_room_ -= bytes.size();
    return {bytes.begin(), bytes.end()};
  }
  std::vector<std::byte> bytes = fetch_uri(file_.path, *file_.image_uris[index],
                                           fmt::format("{}: images[{}]", file_.path, index), file_room_);
  file_room_ -= bytes.size();
  return bytes;
}

std::string ImageReader::image_name(std::size_t index) const {
  const tinygltf::Image& image = file_.model.images[index];
  if (!image.name.empty()) return image.name;
  return image.uri.empty() ? fmt::format("images[{}]", index) : image.uri;
}

std::string ImageReader::image_place(std::size_t index) const {
  const std::string& uri = file_.model.images[index].uri;
  return fmt::format("{}: images[{}]{}", file_.path, index,
                     uri.empty() ? "" : " '" + uri.substr(0, 200) + "'");
}

}  // namespace quadrille::scenes
