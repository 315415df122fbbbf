/// Finds and loads the image module, and turns its answers into values and errors of ours.
#include "scenes/image/image_io.h"

#include <dlfcn.h>

#include <array>
#include <filesystem>
#include <memory>
#include <string_view>

#include "models/base/error.h"
#include "scenes/image/image_header.h"
#include "scenes/image/image_module.h"
#include "scenes/image/plain_image.h"
#include "traces/whole_file.h"

namespace quadrille::scenes {
namespace {

constexpr const char* kModuleName = "libquadrille_images.so";
constexpr std::uint64_t kMaxImageFileBytes = std::uint64_t{1} << 30;
// the largest picture with three floats a pixel
constexpr std::uint64_t kMaxDecodedBytes = std::uint64_t{12} * kMaxImagePixels;

struct Module {
  QuadrilleDecode decode = nullptr;
  QuadrilleEncode encode = nullptr;
  QuadrilleFree free = nullptr;
};

/// Beside the program, in the lib folder next to its own (an installed tree), or where it was built.
std::array<std::filesystem::path, 3> module_places() {
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  return {folder / kModuleName, folder.parent_path() / "lib" / kModuleName, QUADRILLE_IMAGES_MODULE};
}

template <class Function>
void find_symbol(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (function == nullptr) throw user_error("{}: lacks {}; it belongs to another build", kModuleName, name);
}

Module open_module() {
  std::string reasons;
  for (const std::filesystem::path& place : module_places()) {
    if (!std::filesystem::exists(place)) continue;
    if (void* library = dlopen(place.c_str(), RTLD_LAZY | RTLD_LOCAL)) {
      Module module;
      find_symbol(library, "quadrille_images_decode", module.decode);
      find_symbol(library, "quadrille_images_encode", module.encode);
      find_symbol(library, "quadrille_images_free", module.free);
      return module;
    }
    reasons += fmt::format(" {}", dlerror());
  }
  throw user_error(
      "{}: not found beside the program, in ../lib or in the build folder; image files cannot be read or "
      "written{}",
      kModuleName, reasons);
}

const Module& module() {
  static const Module instance = open_module();
  return instance;
}

struct Freed {
  void operator()(void* data) const { module().free(data); }
};
using Held = std::unique_ptr<void, Freed>;

QuadrilleImage decode(std::span<const std::byte> bytes, const std::string& name, bool as_float,
                      std::uint64_t most = kMaxImagePixels) {
  const ImageHeader header = check_image_header(bytes, name);
  const char* const format = format_extension(header.format);
  if (std::uint64_t{header.width} * header.height > most)
    throw user_error("{}: {}x{} pixels; legal are {} in all", name, header.width, header.height, most);
  QuadrilleImage result{};
  if (!module().decode(bytes.data(), bytes.size(), format, as_float, kMaxDecodedBytes, &result)) {
    throw user_error("{}: cannot be decoded as {}: {}", name, format, result.error);
  }
  return result;
}

void encode(const std::string& path, const void* pixels, std::uint32_t width, std::uint32_t height,
            std::uint32_t channels, bool as_float) {
  QuadrilleImage result{};
  if (!module().encode(pixels, width, height, channels, as_float, &result))
    throw user_error("{}: cannot be encoded: {}", path, result.error);
  const Held held(result.data);
  traces::write_whole_file(path, {static_cast<const std::byte*>(result.data), result.size});
}

}  // namespace

void open_image_module() { (void)module(); }

Rgba8Image decode_image(std::span<const std::byte> bytes, const std::string& name) {
  const ImageHeader header = check_image_header(bytes, name);
  if (std::optional<Rgba8Image> plain = decode_plain_image(bytes, header)) return std::move(*plain);
  return decode_any_image(bytes, name);
}

Rgba8Image decode_any_image(std::span<const std::byte> bytes, const std::string& name) {
  const QuadrilleImage raw = decode(bytes, name, false);
  const Held held(raw.data);
  const auto* pixels = static_cast<const std::uint8_t*>(raw.data);
  return {raw.width, raw.height, {pixels, pixels + raw.size}};
}

Rgba8Image load_image(const std::string& path) {
  return decode_image(traces::read_whole_file(path, kMaxImageFileBytes), path);
}

FloatImage load_float_image(const std::string& path, std::uint64_t most) {
  const QuadrilleImage raw = decode(traces::read_whole_file(path, kMaxImageFileBytes), path, true, most);
  const Held held(raw.data);
  const auto* samples = static_cast<const float*>(raw.data);
  return {raw.width, raw.height, raw.channels, {samples, samples + raw.size / sizeof(float)}};
}

void save_png_by_module(const std::string& path, const Rgba8Image& image) {
  encode(path, image.pixels.data(), image.width, image.height, 4, false);
}

void save_png(const std::string& path, const Rgba8Image& image) {
  QUADRILLE_CHECK(image.pixels.size() == std::size_t{4} * image.width * image.height, "{}x{} with {} bytes",
                  image.width, image.height, image.pixels.size());
  if (const auto file = image.pixels.empty() ? std::nullopt : encode_plain_png(image))
    traces::write_whole_file(path, *file);
  else save_png_by_module(path, image);
}

void save_exr(const std::string& path, const FloatImage& image) {
  QUADRILLE_CHECK(image.pixels.size() == std::size_t{image.channels} * image.width * image.height,
                  "{}x{}x{} with {} samples", image.width, image.height, image.channels, image.pixels.size());
  encode(path, image.pixels.data(), image.width, image.height, image.channels, true);
}

}  // namespace quadrille::scenes
