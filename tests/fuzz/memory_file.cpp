#include "tests/fuzz/memory_file.h"

#include <sys/mman.h>
#include <unistd.h>

#include "models/base/error.h"

namespace quadrille::fuzz {

MemoryFile::MemoryFile()
    : descriptor_(memfd_create("fuzz", MFD_CLOEXEC)), path_(fmt::format("/proc/self/fd/{}", descriptor_)) {
  QUADRILLE_CHECK(descriptor_ >= 0, "no file in memory");
}

MemoryFile::~MemoryFile() { close(descriptor_); }

void MemoryFile::put(std::span<const std::byte> bytes) const {
  const auto size = static_cast<off_t>(bytes.size());
  QUADRILLE_CHECK(
      ftruncate(descriptor_, size) == 0 && pwrite(descriptor_, bytes.data(), bytes.size(), 0) == size,
      "{} bytes", size);
}

}  // namespace quadrille::fuzz
