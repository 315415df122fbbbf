/// Simulated device memory: one flat array of bytes at real addresses, and who holds which line dirty.
///
/// Caches keep tags and state, never data. So that a missed flush is seen all the same, a cache that holds a
/// line dirty is noted here as its owner, and whoever reads that line from below it breaks an invariant.
///
/// What nobody writes costs the host nothing: large blocks come from the host zeroed, page by page, at the
/// first touch.
#pragma once

#include "models/memory/stored_lines.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <span>

namespace quadrille::models {

inline constexpr std::uint32_t kLineBytes = 128;   ///< cache line
inline constexpr std::uint32_t kSectorBytes = 32;  ///< smallest transfer; four a line
inline constexpr std::uint32_t kLineSectors = 4;
/// Of a set of sectors, a bit each.
[[nodiscard]] constexpr std::uint64_t sector_bytes(std::uint8_t sectors) {
  return std::uint64_t{kSectorBytes} * static_cast<unsigned>(std::popcount(sectors));
}

class DeviceMemory {
 public:
  using Owner = std::uint8_t;
  static constexpr Owner kClean = 0;

  /// `limit` in bytes: allocating beyond it is a user's error.
  explicit DeviceMemory(std::uint64_t limit = std::uint64_t{4} << 30) : limit_(limit) {}

  /// Address of `bytes` new zeroed bytes, aligned to `alignment` (a power of two; at least a line, so that no
  /// two objects share one). Throws `UserError` when the device's memory does not hold them. Spans and
  /// pointers taken earlier become invalid.
  std::uint64_t allocate(std::uint64_t bytes, std::uint64_t alignment = kLineBytes);
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Makes room on the host for `bytes` in all, so that later allocations move nothing. Optional.
  void reserve(std::uint64_t bytes);

  /// Views of [address, address + bytes); outside of what was allocated is an internal error.
  [[nodiscard]] std::span<std::byte> write(std::uint64_t address, std::uint64_t bytes);
  [[nodiscard]] std::span<const std::byte> read(std::uint64_t address, std::uint64_t bytes) const;
  /// One value at an address that needs no alignment.
  template <class T>
  [[nodiscard]] T load(std::uint64_t address) const {
    T value;
    std::memcpy(&value, read(address, sizeof(T)).data(), sizeof(T));
    return value;
  }
  template <class T>
  void store(std::uint64_t address, const T& value) {
    std::memcpy(write(address, sizeof(T)).data(), &value, sizeof(T));
  }
  /// First byte; for inner loops that checked their range.
  [[nodiscard]] const std::byte* data() const { return bytes_.get(); }
  [[nodiscard]] std::byte* data() { return bytes_.get(); }

  /// `line` = address / kLineBytes. A line has at most one owner: a second one is an internal error.
  void mark_dirty(std::uint64_t line, Owner owner);
  void mark_clean(std::uint64_t line);
  [[nodiscard]] Owner dirty_owner(std::uint64_t line) const;
  /// Aborts when a line of the range is dirty in a cache other than the reader's own.
  void check_readable(std::uint64_t address, std::uint64_t bytes, Owner reader) const;
  /// How lines of surfaces are stored.
  [[nodiscard]] StoredLines& stored_lines() { return stored_lines_; }
  [[nodiscard]] const StoredLines& stored_lines() const { return stored_lines_; }
  /// Lines held dirty somewhere; 0 after all caches were flushed.
  [[nodiscard]] std::uint64_t dirty_lines() const { return dirty_lines_; }

 private:
  struct Freed {
    void operator()(void* block) const { std::free(block); }
  };
  template <class T>
  using Block = std::unique_ptr<T[], Freed>;

  [[nodiscard]] std::uint64_t lines() const { return size_ / kLineBytes; }
  void grow(std::uint64_t capacity);

  std::uint64_t limit_;
  std::uint64_t size_ = 0, capacity_ = 0;  ///< bytes, in whole lines
  Block<std::byte> bytes_;
  Block<Owner> owner_;  ///< by line
  std::uint64_t dirty_lines_ = 0;
  StoredLines stored_lines_;
};

}  // namespace quadrille::models
