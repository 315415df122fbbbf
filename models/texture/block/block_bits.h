/// Reading a block of 16 bytes bit by bit, the least bit of the first byte first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace quadrille::models {

/// A little-endian integer of `bytes` (at most 8) bytes.
[[nodiscard]] inline std::uint64_t little_endian(std::span<const std::byte> block, std::size_t at,
                                                 std::size_t bytes) {
  std::uint64_t value = 0;
  std::memcpy(&value, block.data() + at, bytes);
  return value;
}

class BlockBits {
 public:
  explicit BlockBits(std::span<const std::byte> block)
      : low_(little_endian(block, 0, 8)), high_(little_endian(block, 8, 8)) {}
  /// The next `count` bits (0..16), the first in the least place.
  std::uint32_t take(int count) {
    const std::uint64_t taken = low_ & ((std::uint64_t{1} << count) - 1);
    if (count > 0) {
      low_ = low_ >> count | high_ << (64 - count);
      high_ >>= count;
    }
    return static_cast<std::uint32_t>(taken);
  }

 private:
  std::uint64_t low_, high_;
};

}  // namespace quadrille::models
