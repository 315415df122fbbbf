#include "models/texture/block/astc_header.h"

#include <algorithm>

namespace quadrille::models {
namespace {

/// The eleven bits of the block mode. False: reserved. [KDF #astc-2d-block-mode-layout]
bool read_mode(int mode, AstcHeader& header) {
  const auto bits = [mode](int at, int count) { return mode >> at & ((1 << count) - 1); };
  const int a = bits(5, 2), b = bits(7, 2);
  int precision = bits(9, 1), high_range = bits(0, 2);
  header.two_planes = bits(10, 1) != 0;
  const auto grid = [&header](int columns, int rows) {
    header.columns = columns;
    header.rows = rows;
  };
  if (high_range != 0) {
    switch (bits(2, 2)) {
      case 0: grid(b + 4, a + 2); break;
      case 1: grid(b + 8, a + 2); break;
      case 2: grid(a + 2, b + 8); break;
      default:
        if (b < 2) grid(a + 2, b + 6);
        else grid(b, a + 2);
    }
  } else {
    high_range = bits(2, 2);
    if (high_range == 0) return false;
    switch (b) {
      case 0: grid(12, a + 2); break;
      case 1: grid(a + 2, 12); break;
      case 2:
        grid(a + 6, bits(9, 2) + 6);
        precision = 0;
        header.two_planes = false;
        break;
      default:
        if (a > 1) return false;
        if (a == 0) grid(6, 10);
        else grid(10, 6);
    }
  }
  header.weights =
      kAstcWeightRanges[static_cast<std::size_t>(6 * precision + 2 * high_range + bits(4, 1) - 2)];
  return true;
}

/// End modes of several partitions. `more`: the bits below the weights that belong to them.
void read_end_modes(const AstcBits& block, int more_at, int more, AstcHeader& header) {
  const auto count = static_cast<std::size_t>(header.partitions);
  const int base_class = static_cast<int>(block.field(23, 2)) - 1;
  const std::uint32_t bits = block.field(25, 4) | block.field(more_at, more) << 4;
  for (std::size_t i = 0; i < count; ++i) {
    const auto upper = static_cast<int>(bits >> i & 1), low = static_cast<int>(bits >> (count + 2 * i) & 3);
    header.end_mode[i] = base_class < 0 ? static_cast<int>(bits & 15) : (base_class + upper) << 2 | low;
  }
}

/// The largest range whose integers fit. False: none does, or there are too many.
bool choose_end_range(int bits, AstcHeader& header) {
  int count = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(header.partitions); ++i)
    count += end_integers(header.end_mode[i]);
  if (count > kMaxAstcEndIntegers) return false;
  const auto* const range = std::ranges::find_if(
      kAstcEndRanges, [&](AstcRange candidate) { return sequence_bits(candidate, count) <= bits; });
  if (range == kAstcEndRanges.end()) return false;
  header.ends = *range;
  header.end_bits = sequence_bits(*range, count);
  return true;
}

}  // namespace

std::optional<AstcHeader> astc_header(const AstcBits& block, int width, int height) {
  AstcHeader header;
  if (!read_mode(static_cast<int>(block.field(0, 11)), header)) return std::nullopt;
  if (header.columns > width || header.rows > height || header.weight_count() > kMaxAstcWeights)
    return std::nullopt;
  header.weight_bits = sequence_bits(header.weights, header.weight_count());
  if (header.weight_bits < 24 || header.weight_bits > 96) return std::nullopt;
  header.partitions = static_cast<int>(block.field(11, 2)) + 1;
  if (header.partitions == 4 && header.two_planes) return std::nullopt;

  int below_weights = 128 - header.weight_bits;
  if (header.partitions == 1) {
    header.end_mode[0] = static_cast<int>(block.field(13, 4));
    header.ends_at = 17;
  } else {
    header.pattern = static_cast<int>(block.field(13, 10));
    header.ends_at = 29;
    const int more = block.field(23, 2) == 0 ? 0 : 3 * header.partitions - 4;
    below_weights -= more;
    read_end_modes(block, below_weights, more, header);
  }
  if (header.two_planes) {
    below_weights -= 2;
    header.second_component = static_cast<int>(block.field(below_weights, 2));
  }
  if (!choose_end_range(below_weights - header.ends_at, header)) return std::nullopt;
  return header;
}

}  // namespace quadrille::models
