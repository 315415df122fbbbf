#include "tests/scenes/gltf_text.h"

#include <fmt/format.h>
#include <unistd.h>

#include <fstream>

#include "models/base/error.h"

namespace quadrille::scenes {

std::string data_uri(std::span<const std::byte> bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text = "data:application/octet-stream;base64,";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? std::to_integer<unsigned>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : kDigits[word >> (18 - 6 * k) & 63];
  }
  return text;
}

TempGltf::TempGltf(const std::string& text, const std::string& name) : name_(name) {
  static int serial = 0;
  folder_ =
      std::filesystem::temp_directory_path() / fmt::format("quadrille_scenes_{}_{}", getpid(), serial++);
  std::filesystem::create_directories(folder_);
  std::ofstream(folder_ / name_, std::ios::binary) << text;
}

TempGltf::~TempGltf() { std::filesystem::remove_all(folder_); }

std::string triangle_gltf(const std::string& primitive, const std::string& extra, const std::string& node) {
  const std::string uri = data_uri_of(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" + node +
         R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0})" + primitive + R"(}]}],)" +
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],)" +
         R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":")" + uri +
         "\"}]" + extra + "}";
}

std::string load_result(const std::string& text, const GltfChoice& choice) {
  const TempGltf file(text);
  try {
    (void)GltfScene(file.path(), choice);
  } catch (const UserError& error) { return error.what(); }
  return "loaded";
}

std::string animated_result(const std::string& text) { return load_result(text, {"", true, ""}); }

}  // namespace quadrille::scenes
