#include "cli/image_files.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <new>
#include <utility>

#include "cli/process.h"
#include "models/base/error.h"
#include "models/rop/srgb.h"
#include "scenes/image/image_io.h"
#include "scenes/image/plain_image.h"
#include "traces/whole_file.h"

namespace quadrille::cli {
namespace {

namespace fs = std::filesystem;

std::string lower_extension(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

constexpr std::uint32_t kOpaque = 0xff000000u;

scenes::Rgba8Image bytes_of(std::uint32_t width, std::uint32_t height,
                            const std::vector<std::uint32_t>& rgba) {
  scenes::Rgba8Image out{width, height, std::vector<std::uint8_t>(rgba.size() * 4)};
  std::memcpy(out.pixels.data(), rgba.data(), out.pixels.size());
  return out;
}

std::vector<std::uint32_t> with_alpha(const std::vector<std::uint32_t>& color, bool keep_alpha) {
  std::vector<std::uint32_t> out = color;
  if (!keep_alpha) std::ranges::for_each(out, [](std::uint32_t& pixel) { pixel |= kOpaque; });
  return out;
}

scenes::FloatImage linear_values(const pipeline::FrameImage& image, bool srgb, bool keep_alpha) {
  const std::uint32_t channels = keep_alpha ? 4 : 3;
  scenes::FloatImage out{image.width, image.height, channels, {}};
  out.pixels.reserve(image.color.size() * channels);
  for (const std::array<float, 4>& pixel : image.linear)
    out.pixels.insert(out.pixels.end(), pixel.begin(), pixel.begin() + channels);
  if (!image.linear.empty()) return out;
  for (const std::uint32_t pixel : image.color) {
    for (std::uint32_t c = 0; c < channels; ++c) {
      const auto code = static_cast<std::uint8_t>(pixel >> (8 * c));
      out.pixels.push_back(srgb && c < 3 ? models::decode_srgb8(code) : static_cast<float>(code) / 255.0F);
    }
  }
  return out;
}

std::uint8_t unorm(float value) {
  return static_cast<std::uint8_t>(
      std::lround(std::clamp(std::isnan(value) ? 0.0F : value, 0.0F, 1.0F) * 255.0F));
}

/// Grey by depth, stretched over the depths that the picture has.
std::vector<std::uint32_t> grey_of(const std::vector<float>& depth) {
  const auto [nearest, farthest] = std::ranges::minmax(depth);
  const float range = farthest > nearest ? farthest - nearest : 1.0F;
  std::vector<std::uint32_t> out;
  out.reserve(depth.size());
  for (const float d : depth) out.push_back(kOpaque | 0x010101u * unorm((farthest - d) / range));
  return out;
}

std::vector<std::byte> encoded(std::uint32_t width, std::uint32_t height,
                               const std::vector<std::uint32_t>& rgba) {
  std::optional<std::vector<std::byte>> file = scenes::encode_plain_png(bytes_of(width, height, rgba));
  if (!file) throw std::bad_alloc();  // nothing else fails there
  return std::move(*file);
}

std::string joined(const std::vector<std::string>& extensions) {
  std::string text;
  for (const std::string& e : extensions) text += (text.empty() ? "" : " or ") + e;
  return text;
}

}  // namespace

bool is_exr(const std::string& path) { return lower_extension(path) == ".exr"; }

void check_output(std::string_view flag, const std::string& path,
                  const std::vector<std::string>& extensions) {
  if (std::ranges::find(extensions, lower_extension(path)) == extensions.end()) {
    throw user_error("{}: {}: the name has to end in {}", flag, path, joined(extensions));
  }
  // a file system allows 255, and the name it has while it is written is longer
  constexpr std::size_t kMaxNameBytes = 200;
  const std::size_t name_bytes = fs::path(path).filename().string().size();
  if (name_bytes > kMaxNameBytes)
    throw user_error("{}: the file's name has {} bytes; legal are {}", flag, name_bytes, kMaxNameBytes);
  std::error_code failure;
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  if (!fs::is_directory(folder, failure))
    throw user_error("{}: {}: there is no folder {}", flag, path, folder.string());
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw user_error("{}: {}: no permission to write into {}", flag, path, folder.string());
  if (!fs::exists(path, failure)) return;
  if (!fs::is_regular_file(path, failure))
    throw user_error("{}: {}: exists and is not a plain file", flag, path);
  if (access(path.c_str(), W_OK) != 0) throw user_error("{}: {}: exists and is write-protected", flag, path);
}

bool is_standard_output(const std::string& path) { return path == "-"; }

void check_json_output(std::string_view flag, const std::string& path) {
  if (is_standard_output(path)) return;
  if (lower_extension(path) != ".json")
    throw user_error("{}: {}: the name has to end in .json, or be - for standard output", flag, path);
  check_output(flag, path, {".json"});
}

void check_distinct(const std::vector<std::pair<std::string_view, std::optional<std::string>>>& outputs) {
  const auto place = [](const std::string& path) { return fs::weakly_canonical(fs::absolute(path)); };
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!outputs[i].second || !outputs[j].second || place(*outputs[i].second) != place(*outputs[j].second))
        continue;
      throw user_error("{} and {}: both name {}", outputs[j].first, outputs[i].first, *outputs[i].second);
    }
  }
}

void write_text(const std::string& path, const std::string& text) {
  if (is_standard_output(path)) {
    (void)std::fwrite(text.data(), 1, text.size(), stdout);
    return flush_output();
  }
  traces::write_whole_file(path, std::as_bytes(std::span(text.data(), text.size())));
}

void write_color(const std::string& path, const pipeline::FrameImage& image, bool srgb, bool keep_alpha) {
  if (is_exr(path)) {
    scenes::save_exr(path, linear_values(image, srgb, keep_alpha));
  } else {
    scenes::save_png(path, bytes_of(image.width, image.height, with_alpha(image.color, keep_alpha)));
  }
}

void write_depth(const std::string& path, const pipeline::FrameImage& image) {
  if (is_exr(path)) {
    scenes::save_exr(path, {image.width, image.height, 1, image.depth});
  } else {
    scenes::save_png(path, bytes_of(image.width, image.height, grey_of(image.depth)));
  }
}

std::vector<std::byte> color_png(const pipeline::FrameImage& image) {
  return encoded(image.width, image.height, with_alpha(image.color, false));
}

std::vector<std::byte> depth_png(const pipeline::FrameImage& image) {
  return image.depth.empty() ? std::vector<std::byte>()
                             : encoded(image.width, image.height, grey_of(image.depth));
}

CodedImage read_coded(const std::string& path) {
  CodedImage out;
  if (!is_exr(path)) {
    const scenes::Rgba8Image image = scenes::load_image(path);
    out = {image.width, image.height, std::vector<std::uint32_t>(image.pixels.size() / 4)};
    std::memcpy(out.rgba.data(), image.pixels.data(), image.pixels.size());
    return out;
  }
  const scenes::FloatImage image = scenes::load_float_image(path);
  out = {image.width, image.height, {}};
  out.rgba.reserve(std::size_t{image.width} * image.height);
  for (std::size_t p = 0; p < image.pixels.size(); p += image.channels) {
    const auto code = [&](std::size_t c) {
      return std::uint32_t{models::encode_srgb8(image.pixels[p + (image.channels < 3 ? 0 : c)])};
    };
    const std::uint32_t alpha = image.channels == 4 ? unorm(image.pixels[p + 3]) : 255;
    out.rgba.push_back(code(0) | code(1) << 8 | code(2) << 16 | alpha << 24);
  }
  return out;
}

}  // namespace quadrille::cli
