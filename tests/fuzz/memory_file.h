/// A file that lives in memory and has a path, for code under test that opens files by name.
#pragma once

#include <span>
#include <string>

namespace quadrille::fuzz {

class MemoryFile {
 public:
  MemoryFile();
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  /// Replaces what the file holds.
  void put(std::span<const std::byte> bytes) const;
  /// Without an extension; valid in this process.
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  int descriptor_ = -1;
  std::string path_;
};

}  // namespace quadrille::fuzz
