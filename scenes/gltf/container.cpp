#include "scenes/gltf/container.h"

#include <cstdint>
#include <cstring>
#include <filesystem>

#include "models/base/error.h"

namespace quadrille::scenes {
namespace {

// "glTF", "JSON", "BIN", little-endian
constexpr std::uint32_t kMagic = 0x46546c67, kJson = 0x4e4f534a, kBin = 0x004e4942;
constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

std::uint32_t word(std::span<const std::byte> bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

GltfContainer split_binary(const std::string& path, std::span<const std::byte> bytes) {
  if (bytes.size() < kHeaderBytes + kChunkHeaderBytes)
    throw user_error("{}: a binary glTF file of {} bytes is truncated", path, bytes.size());
  if (word(bytes, 4) != 2)
    throw user_error("{}: version {} of the binary container; 2 is read", path, word(bytes, 4));
  const std::size_t length = word(bytes, 8);
  if (length > bytes.size())
    throw user_error("{}: its header says {} bytes, the file has {}", path, length, bytes.size());
  GltfContainer result;
  int chunk = 0;
  for (std::size_t at = kHeaderBytes; at + kChunkHeaderBytes <= length; ++chunk) {
    const std::size_t size = word(bytes, at);
    const std::uint32_t type = word(bytes, at + 4);
    at += kChunkHeaderBytes;
    if (size > length - at)
      throw user_error("{}: chunk {} of {} bytes reaches beyond the end", path, chunk, size);
    if ((chunk == 0) != (type == kJson))
      throw user_error("{}: the first chunk, and only it, holds JSON; chunk {} breaks that", path, chunk);
    if (type == kBin && chunk != 1)
      throw user_error("{}: chunk {} is BIN, which has its place right after the JSON", path, chunk);
    const std::span<const std::byte> data = bytes.subspan(at, size);
    if (type == kJson) result.json = {reinterpret_cast<const char*>(data.data()), data.size()};
    if (type == kBin) result.binary = data;
    at += size;
  }
  if (chunk == 0) throw user_error("{}: a binary glTF file without a chunk", path);
  return result;
}

bool is_named_binary(const std::string& path) { return std::filesystem::path(path).extension() == ".glb"; }

[[noreturn]] void refuse_as_binary(const std::string& path) {
  throw user_error("{}: not a binary glTF file (by its first bytes)", path);
}

}  // namespace

void look_at_gltf(const std::string& path, std::span<const std::byte> beginning) {
  if (beginning.size() >= 4 && word(beginning, 0) == kMagic) return;
  if (is_named_binary(path)) refuse_as_binary(path);
  constexpr std::string_view kBlanks = " \t\r\n",
                             // of any JSON; the last begins a byte order mark
      kStarts = "{[\"-0123456789tfn\xef";
  const std::string_view text(reinterpret_cast<const char*>(beginning.data()), beginning.size());
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first != std::string_view::npos && kStarts.find(text[first]) == std::string_view::npos)
    throw user_error("{}: its JSON cannot be parsed at byte {}: not JSON in UTF-8", path, first + 1);
}

GltfContainer split_gltf(const std::string& path, std::span<const std::byte> bytes) {
  if (bytes.size() >= 4 && word(bytes, 0) == kMagic) return split_binary(path, bytes);
  if (is_named_binary(path)) refuse_as_binary(path);
  return {{reinterpret_cast<const char*>(bytes.data()), bytes.size()}, {}};
}

}  // namespace quadrille::scenes
