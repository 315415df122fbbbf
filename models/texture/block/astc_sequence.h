/// Integers of a block of ASTC: a range is a power of two, or three or five times one, and the digits to base
/// three or five of several integers share a few bits. [KDF #astc-integer-sequence-encoding]
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace quadrille::models {

/// The 128 bits of a block.
class AstcBits {
 public:
  AstcBits() = default;
  explicit AstcBits(std::span<const std::byte> block);
  /// `count` (0..32) bits from bit `at` on; what lies beyond the last bit is 0.
  [[nodiscard]] std::uint32_t field(int at, int count) const;
  /// Bits at..at + count - 1 (count 0..128), moved to the low end; all others are 0.
  [[nodiscard]] AstcBits part(int at, int count) const;
  /// The last bit first.
  [[nodiscard]] AstcBits reversed() const;

 private:
  AstcBits(std::uint64_t low, std::uint64_t high) : low_(low), high_(high) {}
  std::uint64_t low_ = 0, high_ = 0;
};

/// A range 0 .. base * 2^bits - 1, where the base is 1, 3 or 5.
struct AstcRange {
  std::uint8_t base = 1, bits = 0;
};

/// Bits that `count` integers of a range take.
[[nodiscard]] int sequence_bits(AstcRange range, int count);
/// Reads integers from bit 0 on; bits after those of the sequence have to be 0.
void read_sequence(const AstcBits& bits, AstcRange range, std::span<std::uint8_t> integers);

/// An integer of one of the ranges that ends have, as 0..255. [KDF #astc-endpoint-unquantization]
[[nodiscard]] int end_value(AstcRange range, std::uint8_t integer);
/// An integer of one of the ranges that weights have, as 0..64. [KDF #astc-weight-unquantization]
[[nodiscard]] int weight_value(AstcRange range, std::uint8_t integer);

}  // namespace quadrille::models
