/// What the first bits of a block of ASTC say: the grid of weights, the partitions, how colours are coded,
/// and where the integers of both lie. [KDF #ASTC]
#pragma once

#include "models/texture/block/astc_sequence.h"

#include <array>
#include <cstdint>
#include <optional>

namespace quadrille::models {

inline constexpr int kMaxAstcWeights = 64;      ///< of both planes
inline constexpr int kMaxAstcEndIntegers = 18;  ///< of all partitions
inline constexpr std::size_t kMaxAstcPartitions = 4;

/// Of weights, by R, from 2 on; low precision, then high. [KDF #astc-weight-range-encodings]
inline constexpr std::array<AstcRange, 12> kAstcWeightRanges{
    {{1, 1}, {3, 0}, {1, 2}, {5, 0}, {3, 1}, {1, 3}, {5, 1}, {3, 2}, {1, 4}, {5, 2}, {3, 3}, {1, 5}}};
/// Of ends, the largest first.
inline constexpr std::array<AstcRange, 17> kAstcEndRanges{{{1, 8},
                                                           {3, 6},
                                                           {5, 5},
                                                           {1, 7},
                                                           {3, 5},
                                                           {5, 4},
                                                           {1, 6},
                                                           {3, 4},
                                                           {5, 3},
                                                           {1, 5},
                                                           {3, 3},
                                                           {5, 2},
                                                           {1, 4},
                                                           {3, 2},
                                                           {5, 1},
                                                           {1, 3},
                                                           {3, 1}}};

struct AstcHeader {
  int columns = 0, rows = 0;  ///< of the grid of weights
  bool two_planes = false;
  int second_component = 0;  ///< that the second plane weighs
  AstcRange weights;
  int partitions = 1, pattern = 0;
  std::array<int, kMaxAstcPartitions> end_mode{};  ///< 0..15, by partition
  AstcRange ends;
  int ends_at = 0;      ///< first bit of the integers of the ends
  int end_bits = 0;     ///< that they take
  int weight_bits = 0;  ///< that the weights take, from the last bit of the block down
  [[nodiscard]] int weight_count() const { return columns * rows * (two_planes ? 2 : 1); }
};

/// Integers that an end mode takes: 2, 4, 6 or 8.
[[nodiscard]] constexpr int end_integers(int end_mode) { return 2 * (end_mode >> 2) + 2; }

/// Of a block of `width` x `height` texels that is not of one colour. None: it is none of the legal ones.
/// [KDF #ASTC, illegal encodings]
[[nodiscard]] std::optional<AstcHeader> astc_header(const AstcBits& block, int width, int height);

}  // namespace quadrille::models
