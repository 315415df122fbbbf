#include "traces/whole_file.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "models/base/error.h"

namespace quadrille::traces {

std::vector<std::byte> read_whole_file(const std::string& path, std::uint64_t limit) {
  std::error_code failure;
  if (!std::filesystem::exists(path, failure)) throw user_error("{}: no such file", path);
  if (!std::filesystem::is_regular_file(path, failure)) throw user_error("{}: not a regular file", path);
  const std::uintmax_t size = std::filesystem::file_size(path, failure);
  if (failure) throw user_error("{}: {}", path, failure.message());
  if (size > limit) throw user_error("{}: {} bytes; at most {} are read", path, size, limit);
  std::vector<std::byte> bytes(size);
  std::ifstream file(path, std::ios::binary);
  if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size))) throw user_error("{}: cannot be read", path);
  return bytes;
}

void write_whole_file(const std::string& path, std::span<const std::byte> bytes) {
  const std::string part = fmt::format("{}.{}.part", path, getpid());
  std::ofstream file(part, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  std::error_code failure;
  if (file) std::filesystem::rename(part, path, failure);
  if (!file || failure) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw user_error("{}: cannot be written: {}", path,
                     failure ? failure.message() : std::string("no such folder, no permission or no space"));
  }
}

}  // namespace quadrille::traces
