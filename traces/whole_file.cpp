#include "traces/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "models/base/error.h"
#include "traces/unfinished.h"

namespace quadrille::traces {
namespace {

constexpr std::uintmax_t kBeginning = 64;

}  // namespace

std::vector<std::byte> read_whole_file(const std::string& path, std::uint64_t limit,
                                       const LookAtBeginning& look) {
  std::error_code failure;
  if (!std::filesystem::exists(path, failure)) throw user_error("{}: no such file", path);
  if (!std::filesystem::is_regular_file(path, failure)) throw user_error("{}: not a regular file", path);
  const std::uintmax_t size = std::filesystem::file_size(path, failure);
  if (failure) throw user_error("{}: {}", path, failure.message());
  if (size > limit) throw user_error("{}: {} bytes; at most {} are read", path, size, limit);
  std::ifstream file(path, std::ios::binary);
  if (look) {
    std::vector<std::byte> beginning(std::min<std::uintmax_t>(size, kBeginning));
    if (!file.read(reinterpret_cast<char*>(beginning.data()), static_cast<std::streamsize>(beginning.size())))
      throw user_error("{}: cannot be read", path);
    look(beginning);
    file.seekg(0);
  }
  std::vector<std::byte> bytes(size);
  if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size)))
    throw user_error("{}: cannot be read", path);
  return bytes;
}

namespace {

/// Writes all, or says why not: a value of errno.
int write_all(int file, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written < 0 ? errno : ENOSPC;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return 0;
}

/// The same for a new file.
int write_new(const std::string& path, std::span<const std::byte> bytes) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) return errno;
  const int failure = write_all(file, bytes);
  return close(file) != 0 && failure == 0 ? errno : failure;
}

}  // namespace

void write_whole_file(const std::string& path, std::span<const std::byte> bytes) {
  const std::string part = fmt::format("{}.{}.part", path, getpid());
  const Unfinished listed(part);
  int failure = write_new(part, bytes);
  if (failure == 0 && rename(part.c_str(), path.c_str()) != 0) failure = errno;
  if (failure == 0) return;
  unlink(part.c_str());
  throw user_error("{}: cannot be written: {}", path, std::generic_category().message(failure));
}

}  // namespace quadrille::traces
