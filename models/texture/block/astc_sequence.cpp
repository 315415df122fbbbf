#include "models/texture/block/astc_sequence.h"

#include "models/texture/block/block_bits.h"

namespace quadrille::models {
namespace {

std::uint64_t low_mask(int count) {
  return count >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
}

std::uint64_t reversed_word(std::uint64_t word) {
  word = (word >> 1 & 0x5555555555555555u) | (word & 0x5555555555555555u) << 1;
  word = (word >> 2 & 0x3333333333333333u) | (word & 0x3333333333333333u) << 2;
  word = (word >> 4 & 0x0f0f0f0f0f0f0f0fu) | (word & 0x0f0f0f0f0f0f0f0fu) << 4;
  return __builtin_bswap64(word);
}

int bit(int value, int at) { return value >> at & 1; }

/// Five digits to base three of eight bits. [KDF #astc-trit-based-packing]
std::array<int, 5> trits_of(int t) {
  std::array<int, 5> digit{};
  int rest = t & 31;
  if ((t >> 2 & 7) == 7) {
    rest = (t >> 5) << 2 | (t & 3);
    digit[4] = digit[3] = 2;
  } else if ((t >> 5 & 3) == 3) {
    digit[4] = 2;
    digit[3] = t >> 7;
  } else {
    digit[4] = t >> 7;
    digit[3] = t >> 5 & 3;
  }
  if ((rest & 3) == 3) {
    digit[2] = 2;
    digit[1] = rest >> 4;
    digit[0] = bit(rest, 3) << 1 | (bit(rest, 2) & ~bit(rest, 3));
  } else if ((rest >> 2 & 3) == 3) {
    digit[2] = digit[1] = 2;
    digit[0] = rest & 3;
  } else {
    digit[2] = rest >> 4;
    digit[1] = rest >> 2 & 3;
    digit[0] = bit(rest, 1) << 1 | (bit(rest, 0) & ~bit(rest, 1));
  }
  return digit;
}

/// Three digits to base five of seven bits. [KDF #astc-quint-based-packing]
std::array<int, 3> quints_of(int q) {
  std::array<int, 3> digit{};
  if ((q >> 1 & 3) == 3 && (q >> 5 & 3) == 0) {
    const int keep = bit(q, 0) ^ 1;
    return {4, 4, bit(q, 0) << 2 | (bit(q, 4) & keep) << 1 | (bit(q, 3) & keep)};
  }
  int rest = q & 31;
  if ((q >> 1 & 3) == 3) {
    digit[2] = 4;
    rest = (q >> 3 & 3) << 3 | (~(q >> 5) & 3) << 1 | bit(q, 0);
  } else {
    digit[2] = q >> 5 & 3;
  }
  if ((rest & 7) == 5) {
    digit[1] = 4;
    digit[0] = rest >> 3;
  } else {
    digit[1] = rest >> 3;
    digit[0] = rest & 7;
  }
  return digit;
}

/// Where the bits of the shared digits lie: so many after the low bits of each integer.
constexpr std::array<int, 5> kTritBits{2, 2, 1, 2, 1};
constexpr std::array<int, 3> kQuintBits{3, 2, 2};

/// Reads the integers of one group of shared digits; those beyond the end of `integers` are dropped.
template <std::size_t count>
void read_group(const AstcBits& bits, int& at, int low_bits, const std::array<int, count>& shared,
                std::array<int, count> (*digits_of)(int), std::span<std::uint8_t> integers) {
  std::array<int, count> low{};
  int packed = 0, packed_bits = 0;
  for (std::size_t i = 0; i < count; ++i) {
    low[i] = static_cast<int>(bits.field(at, low_bits));
    packed |= static_cast<int>(bits.field(at + low_bits, shared[i])) << packed_bits;
    at += low_bits + shared[i];
    packed_bits += shared[i];
  }
  const std::array<int, count> digits = digits_of(packed);
  for (std::size_t i = 0; i < count && i < integers.size(); ++i)
    integers[i] = static_cast<std::uint8_t>(digits[i] << low_bits | low[i]);
}

/// The bits of an integer repeated below it until they fill `width`.
int repeated(int value, int bits, int width) {
  int wide = 0;
  for (int left = width - bits; left > -bits; left -= bits)
    wide |= left >= 0 ? value << left : value >> -left;
  return wide;
}

/// What the digit is multiplied by, and what the low bits but the last are spread to.
struct Spread {
  int factor, bits;
};
/// `x`: the low bits without the last one. [KDF #astc-color-unquantization-parameters]
Spread end_spread(AstcRange range, int x) {
  if (range.base == 3) {
    switch (range.bits) {
      case 1: return {204, 0};
      case 2: return {93, x << 8 | x << 4 | x << 2 | x << 1};
      case 3: return {44, x << 7 | x << 2 | x};
      case 4: return {22, x << 6 | x};
      case 5: return {11, x << 5 | x >> 2};
      default: return {5, x << 4 | x >> 4};
    }
  }
  switch (range.bits) {
    case 1: return {113, 0};
    case 2: return {54, x << 8 | x << 3 | x << 2};
    case 3: return {26, x << 7 | x << 1 | x >> 1};
    case 4: return {13, x << 6 | x >> 1};
    default: return {6, x << 5 | x >> 3};
  }
}
/// [KDF #astc-weight-unquantization-parameters]
Spread weight_spread(AstcRange range, int x) {
  if (range.base == 3) {
    switch (range.bits) {
      case 1: return {50, 0};
      case 2: return {23, x << 6 | x << 2 | x};
      default: return {11, x << 5 | x};
    }
  }
  return range.bits == 1 ? Spread{28, 0} : Spread{13, x << 6 | x << 1};
}

/// `width`: of the result; two more bits are computed and then dropped.
int spread_value(AstcRange range, int integer, int width, Spread (*spread_of)(AstcRange, int)) {
  const int low = integer & ((1 << range.bits) - 1), digit = integer >> range.bits;
  const Spread spread = spread_of(range, low >> 1);
  const int flip = (low & 1) != 0 ? (1 << (width + 1)) - 1 : 0;
  const int value = (digit * spread.factor + spread.bits) ^ flip;
  return (flip & 1 << (width - 1)) | value >> 2;
}

}  // namespace

AstcBits::AstcBits(std::span<const std::byte> block)
    : low_(little_endian(block, 0, 8)), high_(little_endian(block, 8, 8)) {}

AstcBits AstcBits::part(int at, int count) const {
  std::uint64_t low = low_, high = high_;
  if (at >= 128) return {0, 0};
  if (at >= 64) {
    low = high >> (at - 64);
    high = 0;
  } else if (at > 0) {
    low = low >> at | high << (64 - at);
    high >>= at;
  }
  return {low & low_mask(count), count > 64 ? high & low_mask(count - 64) : 0};
}

std::uint32_t AstcBits::field(int at, int count) const {
  return static_cast<std::uint32_t>(part(at, count).low_);
}

AstcBits AstcBits::reversed() const { return {reversed_word(high_), reversed_word(low_)}; }

int sequence_bits(AstcRange range, int count) {
  const int low = count * range.bits;
  if (range.base == 3) return low + (8 * count + 4) / 5;
  return range.base == 5 ? low + (7 * count + 2) / 3 : low;
}

void read_sequence(const AstcBits& bits, AstcRange range, std::span<std::uint8_t> integers) {
  int at = 0;
  while (!integers.empty()) {
    std::size_t read = 1;
    if (range.base == 3) {
      read_group(bits, at, range.bits, kTritBits, trits_of, integers);
      read = kTritBits.size();
    } else if (range.base == 5) {
      read_group(bits, at, range.bits, kQuintBits, quints_of, integers);
      read = kQuintBits.size();
    } else {
      integers[0] = static_cast<std::uint8_t>(bits.field(at, range.bits));
      at += range.bits;
    }
    integers = integers.subspan(read < integers.size() ? read : integers.size());
  }
}

int end_value(AstcRange range, std::uint8_t integer) {
  if (range.base == 1) return repeated(integer, range.bits, 8);
  return spread_value(range, integer, 8, end_spread);
}

int weight_value(AstcRange range, std::uint8_t integer) {
  constexpr std::array<int, 3> kThree{0, 32, 63};
  constexpr std::array<int, 5> kFive{0, 16, 32, 47, 63};
  const int value = range.base == 1   ? repeated(integer, range.bits, 6)
                    : range.bits != 0 ? spread_value(range, integer, 6, weight_spread)
                    : range.base == 3 ? kThree[integer]
                                      : kFive[integer];
  return value > 32 ? value + 1 : value;
}

}  // namespace quadrille::models
