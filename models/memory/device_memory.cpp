#include "models/memory/device_memory.h"

#include "models/base/error.h"

#include <bit>

namespace quadrille::models {

std::uint64_t DeviceMemory::allocate(std::uint64_t bytes, std::uint64_t alignment) {
  QUADRILLE_CHECK(std::has_single_bit(alignment), "alignment {} is not a power of two", alignment);
  const std::uint64_t step = alignment < kLineBytes ? kLineBytes : alignment;
  const std::uint64_t address = (bytes_.size() + step - 1) & ~(step - 1);
  if (address > limit_ || bytes > limit_ - address) {
    throw user_error(
        "device memory: {} bytes are asked for at {} but the device has {}; use a smaller scene or target, or give the machine more memory",
        bytes, address, limit_);
  }
  const std::uint64_t end = (address + bytes + kLineBytes - 1) & ~std::uint64_t{kLineBytes - 1};
  bytes_.resize(end);
  owner_.resize(end / kLineBytes, kClean);
  return address;
}

std::span<std::byte> DeviceMemory::write(std::uint64_t address, std::uint64_t bytes) {
  QUADRILLE_CHECK(address <= bytes_.size() && bytes <= bytes_.size() - address, "write of {} bytes at {:#x}, memory ends at {:#x}", bytes,
                  address, bytes_.size());
  return {bytes_.data() + address, bytes};
}

std::span<const std::byte> DeviceMemory::read(std::uint64_t address, std::uint64_t bytes) const {
  QUADRILLE_CHECK(address <= bytes_.size() && bytes <= bytes_.size() - address, "read of {} bytes at {:#x}, memory ends at {:#x}", bytes,
                  address, bytes_.size());
  return {bytes_.data() + address, bytes};
}

void DeviceMemory::mark_dirty(std::uint64_t line, Owner owner) {
  QUADRILLE_CHECK(line < owner_.size() && owner != kClean, "line {} of {}, owner {}", line, owner_.size(), owner);
  Owner& current = owner_[line];
  QUADRILLE_CHECK(current == kClean || current == owner, "line {} is dirty in cache {} and written in cache {}", line, current, owner);
  if (current == kClean) ++dirty_lines_;
  current = owner;
}

void DeviceMemory::mark_clean(std::uint64_t line) {
  QUADRILLE_CHECK(line < owner_.size(), "line {} of {}", line, owner_.size());
  if (owner_[line] != kClean) --dirty_lines_;
  owner_[line] = kClean;
}

DeviceMemory::Owner DeviceMemory::dirty_owner(std::uint64_t line) const {
  QUADRILLE_CHECK(line < owner_.size(), "line {} of {}", line, owner_.size());
  return owner_[line];
}

void DeviceMemory::check_readable(std::uint64_t address, std::uint64_t bytes, Owner reader) const {
  if (bytes == 0) return;
  for (std::uint64_t line = address / kLineBytes; line <= (address + bytes - 1) / kLineBytes; ++line) {
    const Owner owner = dirty_owner(line);
    QUADRILLE_CHECK(owner == kClean || owner == reader, "line {} is read by {} while cache {} holds it dirty: a flush is missing", line,
                    reader, owner);
  }
}

}  // namespace quadrille::models
