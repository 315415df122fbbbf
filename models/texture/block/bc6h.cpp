/// BC6H. [KDF #bptc_bc6h]
#include "models/texture/block/block_bits.h"
#include "models/texture/block/bptc.h"
#include "models/texture/block/bptc_tables.h"

namespace quadrille::models {
namespace {

struct Mode {
  int number;
  bool deltas;  ///< all ends but the first are differences from it
  int subsets, end_bits;
  std::array<int, 3> delta_bits;
  /// Where the bits behind the mode's number go, first to last: a channel and an end, and its bits in the
  /// order in which they come. p is the partition.
  std::string_view fields;
};
/// [KDF #table-bptcblockmodes, #table-bptcblockformat]
constexpr std::array<Mode, 14> kModes{{
    {0,
     true,
     2,
     10,
     {5, 5, 5},
     "g2.4 b2.4 b3.4 r0.0-9 g0.0-9 b0.0-9 r1.0-4 g3.4 g2.0-3 g1.0-4 b3.0 g3.0-3 b1.0-4 b3.1 b2.0-3 r2.0-4 "
     "b3.2 r3.0-4 b3.3 p0.0-4"},
    {1,
     true,
     2,
     7,
     {6, 6, 6},
     "g2.5 g3.4-5 r0.0-6 b3.0-1 b2.4 g0.0-6 b2.5 b3.2 g2.4 b0.0-6 b3.3 b3.5-4 r1.0-5 g2.0-3 g1.0-5 g3.0-3 "
     "b1.0-5 b2.0-3 r2.0-5 r3.0-5 p0.0-4"},
    {2,
     true,
     2,
     11,
     {5, 4, 4},
     "r0.0-9 g0.0-9 b0.0-9 r1.0-4 r0.10 g2.0-3 g1.0-3 g0.10 b3.0 g3.0-3 b1.0-3 b0.10 b3.1 b2.0-3 r2.0-4 "
     "b3.2 r3.0-4 b3.3 p0.0-4"},
    {6,
     true,
     2,
     11,
     {4, 5, 4},
     "r0.0-9 g0.0-9 b0.0-9 r1.0-3 r0.10 g3.4 g2.0-3 g1.0-4 g0.10 g3.0-3 b1.0-3 b0.10 b3.1 b2.0-3 r2.0-3 "
     "b3.0 b3.2 r3.0-3 g2.4 b3.3 p0.0-4"},
    {10,
     true,
     2,
     11,
     {4, 4, 5},
     "r0.0-9 g0.0-9 b0.0-9 r1.0-3 r0.10 b2.4 g2.0-3 g1.0-3 g0.10 b3.0 g3.0-3 b1.0-4 b0.10 b2.0-3 r2.0-3 "
     "b3.1-2 r3.0-3 b3.4-3 p0.0-4"},
    {14,
     true,
     2,
     9,
     {5, 5, 5},
     "r0.0-8 b2.4 g0.0-8 g2.4 b0.0-8 b3.4 r1.0-4 g3.4 g2.0-3 g1.0-4 b3.0 g3.0-3 b1.0-4 b3.1 b2.0-3 r2.0-4 "
     "b3.2 r3.0-4 b3.3 p0.0-4"},
    {18,
     true,
     2,
     8,
     {6, 5, 5},
     "r0.0-7 g3.4 b2.4 g0.0-7 b3.2 g2.4 b0.0-7 b3.3-4 r1.0-5 g2.0-3 g1.0-4 b3.0 g3.0-3 b1.0-4 b3.1 b2.0-3 "
     "r2.0-5 r3.0-5 p0.0-4"},
    {22,
     true,
     2,
     8,
     {5, 6, 5},
     "r0.0-7 b3.0 b2.4 g0.0-7 g2.5-4 b0.0-7 g3.5 b3.4 r1.0-4 g3.4 g2.0-3 g1.0-5 g3.0-3 b1.0-4 b3.1 b2.0-3 "
     "r2.0-4 b3.2 r3.0-4 b3.3 p0.0-4"},
    {26,
     true,
     2,
     8,
     {5, 5, 6},
     "r0.0-7 b3.1 b2.4 g0.0-7 b2.5 g2.4 b0.0-7 b3.5-4 r1.0-4 g3.4 g2.0-3 g1.0-4 b3.0 g3.0-3 b1.0-5 b2.0-3 "
     "r2.0-4 b3.2 r3.0-4 b3.3 p0.0-4"},
    {30,
     false,
     2,
     6,
     {6, 6, 6},
     "r0.0-5 g3.4 b3.0-1 b2.4 g0.0-5 g2.5 b2.5 b3.2 g2.4 b0.0-5 g3.5 b3.3 b3.5-4 r1.0-5 g2.0-3 g1.0-5 "
     "g3.0-3 b1.0-5 b2.0-3 r2.0-5 r3.0-5 p0.0-4"},
    {3, false, 1, 10, {10, 10, 10}, "r0.0-9 g0.0-9 b0.0-9 r1.0-9 g1.0-9 b1.0-9"},
    {7, true, 1, 11, {9, 9, 9}, "r0.0-9 g0.0-9 b0.0-9 r1.0-8 r0.10 g1.0-8 g0.10 b1.0-8 b0.10"},
    {11, true, 1, 12, {8, 8, 8}, "r0.0-9 g0.0-9 b0.0-9 r1.0-7 r0.11-10 g1.0-7 g0.11-10 b1.0-7 b0.11-10"},
    {15, true, 1, 16, {4, 4, 4}, "r0.0-9 g0.0-9 b0.0-9 r1.0-3 r0.15-10 g1.0-3 g0.15-10 b1.0-3 b0.15-10"},
}};

constexpr std::size_t kPartition = 12;
/// Goal of each bit behind the mode's number: 16 times the value (channel times 4, and end; or the
/// partition), and the bit of it.
struct Goals {
  std::array<std::uint8_t, 80> goal{};
  std::size_t count = 0;
};

constexpr Goals goals_of(std::string_view fields) {
  Goals goals;
  std::size_t at = 0;
  const auto number = [&fields, &at] {
    std::size_t value = 0;
    for (; at < fields.size() && fields[at] >= '0' && fields[at] <= '9'; ++at)
      value = 10 * value + static_cast<std::size_t>(fields[at] - '0');
    return value;
  };
  while (at < fields.size()) {
    const char name = fields[at++];
    const std::size_t end = number();
    ++at;
    const std::size_t channel = name == 'r' ? 0 : name == 'g' ? 1 : name == 'b' ? 2 : 3;
    const std::size_t first = number();
    std::size_t last = first;
    if (at < fields.size() && fields[at] == '-') {
      ++at;
      last = number();
    }
    ++at;
    for (std::size_t bit = first;; bit = first < last ? bit + 1 : bit - 1) {
      goals.goal[goals.count++] = static_cast<std::uint8_t>(16 * (4 * channel + end) + bit);
      if (bit == last) break;
    }
  }
  return goals;
}

constexpr std::array<Goals, kModes.size()> kGoals = [] {
  std::array<Goals, kModes.size()> all;
  for (std::size_t i = 0; i < kModes.size(); ++i) all[i] = goals_of(kModes[i].fields);
  return all;
}();
static_assert([] {
  for (std::size_t i = 0; i < kModes.size(); ++i) {
    const std::size_t number = kModes[i].number < 2 ? 2 : 5;
    if (kGoals[i].count + number != (kModes[i].subsets == 2 ? 82u : 65u)) return false;
  }
  return true;
}());

/// Place of a mode's row, or of none.
std::size_t mode_index(std::uint32_t first_byte) {
  const std::uint32_t number = (first_byte & 3) < 2 ? first_byte & 3 : first_byte & 31;
  std::size_t i = 0;
  while (i < kModes.size() && static_cast<std::uint32_t>(kModes[i].number) != number) ++i;
  return i;
}

int sign_extended(std::uint32_t value, int bits) {
  const std::uint32_t sign = 1u << (bits - 1);
  return static_cast<int>(value ^ sign) - static_cast<int>(sign);
}

/// An end from its few bits to 16 (a sign and 15), so that the largest code stands for the largest number.
int unquantized(int value, int bits, bool is_signed) {
  if (!is_signed) {
    if (bits >= 15 || value == 0) return value;
    return value == (1 << bits) - 1 ? 0xffff : ((value << 15) + 0x4000) >> (bits - 1);
  }
  if (bits >= 16) return value;
  const int size = value < 0 ? -value : value;
  const int wide = size == 0                       ? 0
                   : size >= (1 << (bits - 1)) - 1 ? 0x7fff
                                                   : ((size << 15) + 0x4000) >> (bits - 1);
  return value < 0 ? -wide : wide;
}

/// The bits of the half float that an interpolated value stands for.
std::uint32_t half_of(int value, bool is_signed) {
  if (!is_signed) return static_cast<std::uint32_t>(value * 31) >> 6;
  const auto size = static_cast<std::uint32_t>((value < 0 ? -value : value) * 31) >> 5;
  return value < 0 ? size | 0x8000u : size;
}

/// [channel times 4, and end]
std::array<int, 12> ends_of(const Mode& mode, const std::array<std::uint32_t, 16>& read, bool is_signed) {
  std::array<int, 12> ends{};
  const std::uint32_t mask = (1u << mode.end_bits) - 1;
  for (std::size_t v = 0; v < ends.size(); ++v) {
    std::uint32_t value = read[v];
    if (mode.deltas && v % 4 != 0) {
      const int delta = sign_extended(value, mode.delta_bits[v / 4]);
      value = (read[v / 4 * 4] + static_cast<std::uint32_t>(delta)) & mask;
    }
    const int whole = is_signed ? sign_extended(value, mode.end_bits) : static_cast<int>(value);
    ends[v] = unquantized(whole, mode.end_bits, is_signed);
  }
  return ends;
}

void store_half(BlockTexels& texels, std::size_t texel, std::size_t channel, std::uint32_t half) {
  const auto bits = static_cast<std::uint16_t>(half);
  std::memcpy(texels.bytes.data() + 8 * texel + 2 * channel, &bits, sizeof bits);
}

}  // namespace

void decode_bc6h(bool is_signed, std::span<const std::byte> block, BlockTexels& texels) {
  constexpr std::uint32_t kOne = 0x3c00;
  texels = {};
  for (std::size_t i = 0; i < kBlockTexels; ++i) store_half(texels, i, 3, kOne);
  const std::size_t index = mode_index(static_cast<std::uint32_t>(block[0]));
  if (index == kModes.size()) return;
  const Mode& mode = kModes[index];
  BlockBits bits(block);
  static_cast<void>(bits.take(mode.number < 2 ? 2 : 5));
  std::array<std::uint32_t, 16> read{};
  for (std::size_t b = 0; b < kGoals[index].count; ++b) {
    const std::size_t goal = kGoals[index].goal[b];
    read[goal / 16] |= bits.take(1) << goal % 16;
  }
  const std::array<int, 12> ends = ends_of(mode, read, is_signed);
  const std::uint32_t partition = read[kPartition];
  const int index_bits = mode.subsets == 2 ? 3 : 4;
  for (std::uint32_t i = 0; i < kBlockTexels; ++i) {
    const int weight =
        index_weight(index_bits, bits.take(index_bits - (is_anchor(mode.subsets, partition, i) ? 1 : 0)));
    const std::size_t first = std::size_t{2} * subset_of(mode.subsets, partition, i);
    for (std::size_t c = 0; c < 3; ++c) {
      const int value = (ends[4 * c + first] * (64 - weight) + ends[4 * c + first + 1] * weight + 32) >> 6;
      store_half(texels, i, c, half_of(value, is_signed));
    }
  }
}

}  // namespace quadrille::models
