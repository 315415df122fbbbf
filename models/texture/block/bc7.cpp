/// BC7. [KDF #bptc_bc7]
#include "models/texture/block/block_bits.h"
#include "models/texture/block/bptc.h"
#include "models/texture/block/bptc_tables.h"

#include <bit>
#include <utility>

namespace quadrille::models {
namespace {

struct Mode {
  int subsets, partition_bits, rotation_bits, selection_bits, color_bits, alpha_bits;
  bool low_bit_by_end, low_bit_by_subset;  ///< a least bit that all channels of an end share
  int index_bits, second_index_bits;
};
/// [KDF #table-bptcmodes]
constexpr std::array<Mode, 8> kModes{{{3, 4, 0, 0, 4, 0, true, false, 3, 0},
                                      {2, 6, 0, 0, 6, 0, false, true, 3, 0},
                                      {3, 6, 0, 0, 5, 0, false, false, 2, 0},
                                      {2, 6, 0, 0, 7, 0, true, false, 2, 0},
                                      {1, 0, 2, 1, 5, 6, false, false, 2, 3},
                                      {1, 0, 2, 0, 7, 8, false, false, 2, 2},
                                      {1, 0, 0, 0, 7, 7, true, false, 4, 0},
                                      {2, 6, 0, 0, 5, 5, true, false, 2, 0}}};

/// [two times subset + end][channel]
using Ends = std::array<std::array<std::uint32_t, 4>, 6>;

/// To eight bits, the high ones repeated below.
std::uint32_t expand(std::uint32_t value, int bits) {
  const std::uint32_t high = value << (8 - bits);
  return high | high >> bits;
}

Ends read_ends(const Mode& mode, BlockBits& bits) {
  Ends ends{};
  const auto count = static_cast<std::size_t>(2 * mode.subsets);
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t e = 0; e < count; ++e) ends[e][c] = bits.take(c < 3 ? mode.color_bits : mode.alpha_bits);
  const bool low_bits = mode.low_bit_by_end || mode.low_bit_by_subset;
  std::array<std::uint32_t, 6> low{};
  for (std::size_t e = 0; e < count && low_bits; ++e)
    low[e] = mode.low_bit_by_subset && e % 2 == 1 ? low[e - 1] : bits.take(1);
  for (std::size_t e = 0; e < count; ++e) {
    for (std::size_t c = 0; c < 4; ++c) {
      const int read = c < 3 ? mode.color_bits : mode.alpha_bits;
      std::uint32_t& value = ends[e][c];
      if (read == 0) value = 255;
      else value = low_bits ? expand(value << 1 | low[e], read + 1) : expand(value, read);
    }
  }
  return ends;
}

using Indices = std::array<std::uint32_t, kBlockTexels>;
Indices read_indices(const Mode& mode, std::uint32_t partition, int index_bits, BlockBits& bits) {
  Indices indices{};
  for (std::uint32_t i = 0; i < kBlockTexels && index_bits > 0; ++i)
    indices[i] = bits.take(index_bits - (is_anchor(mode.subsets, partition, i) ? 1 : 0));
  return indices;
}

std::uint32_t interpolate(std::uint32_t a, std::uint32_t b, int weight) {
  const auto w = static_cast<std::uint32_t>(weight);
  return ((64 - w) * a + w * b + 32) >> 6;
}

/// Where colour and alpha of a texel take their indices from.
struct IndexUse {
  const Indices& color;
  const Indices& alpha;
  int color_bits, alpha_bits;
};

void store_texels(const Mode& mode, std::uint32_t partition, std::uint32_t rotation, const Ends& ends,
                  const IndexUse& use, BlockTexels& texels) {
  for (std::uint32_t i = 0; i < kBlockTexels; ++i) {
    const std::size_t first = std::size_t{2} * subset_of(mode.subsets, partition, i);
    const int color = index_weight(use.color_bits, use.color[i]),
              alpha = index_weight(use.alpha_bits, use.alpha[i]);
    std::array<std::uint32_t, 4> value{};
    for (std::size_t c = 0; c < 4; ++c)
      value[c] = interpolate(ends[first][c], ends[first + 1][c], c < 3 ? color : alpha);
    if (rotation != 0) std::swap(value[3], value[rotation - 1]);
    for (std::size_t c = 0; c < 4; ++c)
      texels.bytes[4 * std::size_t{i} + c] = static_cast<std::byte>(value[c]);
  }
}

}  // namespace

void decode_bc7(std::span<const std::byte> block, BlockTexels& texels) {
  const auto first = static_cast<std::uint32_t>(block[0]);
  if (first == 0) {
    texels = {};
    return;
  }
  const int number = std::countr_zero(first);
  const Mode& mode = kModes[static_cast<std::size_t>(number)];
  BlockBits bits(block);
  static_cast<void>(bits.take(number + 1));
  const std::uint32_t partition = bits.take(mode.partition_bits), rotation = bits.take(mode.rotation_bits),
                      selection = bits.take(mode.selection_bits);
  const Ends ends = read_ends(mode, bits);
  const Indices primary = read_indices(mode, partition, mode.index_bits, bits);
  const Indices secondary = read_indices(mode, partition, mode.second_index_bits, bits);
  const bool two = mode.second_index_bits > 0, swapped = selection == 1;
  const bool alpha_second = two && !swapped;
  const IndexUse use{swapped ? secondary : primary, alpha_second ? secondary : primary,
                     swapped ? mode.second_index_bits : mode.index_bits,
                     alpha_second ? mode.second_index_bits : mode.index_bits};
  store_texels(mode, partition, rotation, ends, use, texels);
}

}  // namespace quadrille::models
