#include "models/memory/interleave.h"

namespace quadrille::models {
namespace {

/// One word a bit of a block's number. Found by search: the leading b bits of any b + 1 words in a row are
/// independent (b of 1 to 6), which is what makes powers of two exact; among many such draws this one had the
/// least worst case over strides of 1 to 4096 lines.
constexpr std::array<std::uint32_t, 32> kWords{
    0x1cd3ac70, 0x7ecdcaa1, 0x86499561, 0xd3ee3ff4, 0xaa2b5a87, 0xefb2433d, 0x988915b3, 0x6da63487,
    0xa3859f7e, 0x3d7cd144, 0xe5673c12, 0x7375a20e, 0x273ee7e5, 0xaef95ebb, 0x605f398e, 0x518734a7,
    0xd4f33782, 0x8bf52aeb, 0x2ea6b4d4, 0xcd8d84ea, 0x9ed05d89, 0x59c102d7, 0x6a442c47, 0xef19fe74,
    0xea5695eb, 0xa539ce06, 0x3ce78dda, 0xff202fc7, 0x6e82b25f, 0xd1177e90, 0xe59136de, 0x63bda869,
};

constexpr auto make_scatter() {
  std::array<std::array<std::uint32_t, 256>, 4> table{};
  for (std::size_t byte = 0; byte < 4; ++byte) {
    for (std::size_t value = 0; value < 256; ++value) {
      for (std::size_t bit = 0; bit < 8; ++bit) {
        if ((value >> bit & 1) != 0) table[byte][value] ^= kWords[8 * byte + bit];
      }
    }
  }
  return table;
}

/// How much further a row of tiles begins than the one above: `row` for every row, `group` more after each
/// 2^group_rows, `block` more after each 2^block_rows.
struct RowSteps {
  std::uint8_t row, group, group_rows, block, block_rows;
};

/// By count of partitions, from 1. Found by search over all steps: the one with which any area of 4x4 to
/// 16x16 tiles gives no partition more than the mean, rounded up, and one; and among those the one that is
/// most even along columns and diagonals.
constexpr std::array<RowSteps, 64> kRowSteps{{
    {0, 0, 1, 0, 0},  {0, 1, 1, 0, 0},   {0, 1, 1, 0, 0},    {1, 1, 1, 0, 0},   {2, 1, 2, 0, 0},
    {2, 1, 1, 0, 0},  {3, 0, 1, 0, 0},   {1, 3, 1, 0, 0},    {4, 8, 2, 0, 0},   {4, 7, 2, 0, 0},
    {3, 0, 1, 0, 0},  {6, 3, 1, 7, 2},   {3, 0, 1, 0, 0},    {4, 13, 2, 0, 0},  {4, 1, 3, 0, 0},
    {3, 5, 1, 0, 0},  {3, 0, 1, 0, 0},   {7, 17, 3, 0, 0},   {4, 0, 1, 0, 0},   {8, 19, 2, 0, 0},
    {5, 5, 1, 0, 0},  {8, 1, 1, 0, 0},   {5, 0, 1, 0, 0},    {15, 1, 3, 22, 4}, {7, 24, 2, 0, 0},
    {8, 5, 1, 0, 0},  {10, 26, 3, 0, 0}, {7, 1, 1, 0, 0},    {8, 0, 1, 0, 0},   {18, 1, 1, 29, 3},
    {11, 0, 1, 0, 0}, {8, 1, 1, 0, 0},   {21, 32, 1, 32, 3}, {12, 1, 1, 0, 0},  {10, 1, 2, 0, 0},
    {10, 1, 1, 0, 0}, {8, 0, 1, 0, 0},   {12, 7, 1, 0, 0},   {16, 1, 3, 0, 0},  {12, 39, 2, 0, 0},
    {11, 0, 1, 0, 0}, {16, 1, 3, 0, 0},  {12, 0, 1, 0, 0},   {13, 1, 1, 0, 0},  {16, 1, 3, 0, 0},
    {8, 13, 1, 0, 0}, {10, 0, 1, 0, 0},  {15, 47, 3, 0, 0},  {18, 0, 1, 0, 0},  {13, 3, 2, 0, 0},
    {14, 1, 3, 0, 0}, {8, 17, 1, 0, 0},  {12, 0, 1, 0, 0},   {21, 53, 3, 0, 0}, {10, 54, 2, 0, 0},
    {20, 1, 1, 0, 0}, {16, 56, 4, 0, 0}, {9, 19, 1, 0, 0},   {14, 0, 1, 0, 0},  {14, 1, 2, 0, 0},
    {16, 0, 1, 0, 0}, {10, 3, 1, 0, 0},  {23, 1, 3, 0, 0},   {8, 31, 1, 0, 0},
}};

}  // namespace

const std::array<std::array<std::uint32_t, 256>, 4> kScatter = make_scatter();

PartitionId partition_of(std::uint32_t tile_x, std::uint32_t tile_y, std::uint32_t partitions) {
  QUADRILLE_CHECK(partitions >= 1 && partitions <= kRowSteps.size(), "{} partitions", partitions);
  const RowSteps& steps = kRowSteps[partitions - 1];
  return PartitionId((tile_x + steps.row * tile_y + steps.group * (tile_y >> steps.group_rows) +
                      steps.block * (tile_y >> steps.block_rows)) %
                     partitions);
}

}  // namespace quadrille::models
