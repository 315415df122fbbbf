#include "models/memory/device_memory.h"

#include "models/base/error.h"

#include <algorithm>
#include <bit>
#include <new>

namespace quadrille::models {
namespace {

/// `count` zeroed bytes. `calloc` takes large blocks from the host as they are, where a vector would write
/// its zeros.
template <class T>
T* zeroed(std::uint64_t count) {
  static_assert(sizeof(T) == 1);
  void* const block = std::calloc(std::max<std::uint64_t>(1, count), 1);
  if (block == nullptr) throw std::bad_alloc();
  return static_cast<T*>(block);
}

}  // namespace

void DeviceMemory::reserve(std::uint64_t bytes) {
  const std::uint64_t wanted = std::min(bytes, limit_) / kLineBytes * kLineBytes;
  if (wanted > capacity_) grow(wanted);
}

void DeviceMemory::grow(std::uint64_t capacity) {
  Block<std::byte> bytes(zeroed<std::byte>(capacity));
  Block<Owner> owner(zeroed<Owner>(capacity / kLineBytes));
  if (size_ > 0) {
    std::memcpy(bytes.get(), bytes_.get(), size_);
    std::memcpy(owner.get(), owner_.get(), lines());
  }
  bytes_ = std::move(bytes);
  owner_ = std::move(owner);
  capacity_ = capacity;
}

std::uint64_t DeviceMemory::allocate(std::uint64_t bytes, std::uint64_t alignment) {
  QUADRILLE_CHECK(std::has_single_bit(alignment), "alignment {} is not a power of two", alignment);
  const std::uint64_t step = alignment < kLineBytes ? kLineBytes : alignment;
  const std::uint64_t address = (size_ + step - 1) & ~(step - 1);
  if (address > limit_ || bytes > limit_ - address) {
    throw user_error(
        "device memory: {} bytes are asked for at {} but the device has {}; use a smaller scene or target, "
        "or give the machine more memory",
        bytes, address, limit_);
  }
  const std::uint64_t end = (address + bytes + kLineBytes - 1) & ~std::uint64_t{kLineBytes - 1};
  if (end > capacity_) grow(std::max(end, 2 * capacity_));
  size_ = end;
  return address;
}

std::span<std::byte> DeviceMemory::write(std::uint64_t address, std::uint64_t bytes) {
  QUADRILLE_CHECK(address <= size_ && bytes <= size_ - address,
                  "write of {} bytes at {:#x}, memory ends at {:#x}", bytes, address, size_);
  return {bytes_.get() + address, bytes};
}

std::span<const std::byte> DeviceMemory::read(std::uint64_t address, std::uint64_t bytes) const {
  QUADRILLE_CHECK(address <= size_ && bytes <= size_ - address,
                  "read of {} bytes at {:#x}, memory ends at {:#x}", bytes, address, size_);
  return {bytes_.get() + address, bytes};
}

void DeviceMemory::mark_dirty(std::uint64_t line, Owner owner) {
  QUADRILLE_CHECK(line < lines() && owner != kClean, "line {} of {}, owner {}", line, lines(), owner);
  Owner& current = owner_[line];
  QUADRILLE_CHECK(current == kClean || current == owner,
                  "line {} is dirty in cache {} and written in cache {}", line, current, owner);
  if (current == kClean) ++dirty_lines_;
  current = owner;
}

void DeviceMemory::mark_clean(std::uint64_t line) {
  QUADRILLE_CHECK(line < lines(), "line {} of {}", line, lines());
  if (owner_[line] != kClean) --dirty_lines_;
  owner_[line] = kClean;
}

DeviceMemory::Owner DeviceMemory::dirty_owner(std::uint64_t line) const {
  QUADRILLE_CHECK(line < lines(), "line {} of {}", line, lines());
  return owner_[line];
}

void DeviceMemory::check_readable(std::uint64_t address, std::uint64_t bytes, Owner reader) const {
  if (bytes == 0) return;
  for (std::uint64_t line = address / kLineBytes; line <= (address + bytes - 1) / kLineBytes; ++line) {
    const Owner owner = dirty_owner(line);
    QUADRILLE_CHECK(owner == kClean || owner == reader,
                    "line {} is read by {} while cache {} holds it dirty: a flush is missing", line, reader,
                    owner);
  }
}

}  // namespace quadrille::models
