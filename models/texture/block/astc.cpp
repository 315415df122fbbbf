#include "models/texture/block/astc.h"

#include "models/texture/block/astc_ends.h"
#include "models/texture/block/astc_header.h"
#include "models/texture/block/astc_sequence.h"

#include <algorithm>

namespace quadrille::models {
namespace {

struct Size {
  int width, height;
};

/// An end of eight bits as 16.
int widened(int end, bool srgb) { return end << 8 | (srgb ? 0x80 : end); }

void store(BlockTexels& texels, std::size_t texel, std::size_t channel, int value) {
  texels.bytes[4 * texel + channel] = static_cast<std::byte>(value);
}
void fill(const Size& size, const AstcColor& color, BlockTexels& texels) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(size.width * size.height); ++i)
    for (std::size_t c = 0; c < 4; ++c) store(texels, i, c, color[c]);
}

/// A block of one colour, which may name the part of the texture that has it. [KDF #astc-void-extent-blocks]
bool is_one_color(const AstcBits& block) { return block.field(0, 9) == 0x1fc; }
AstcColor one_color(const AstcBits& block) {
  constexpr std::uint32_t kNoExtent = 0x1fff;
  const bool high_range = block.field(9, 1) != 0, reserved = block.field(10, 2) != 3;
  const std::array<std::uint32_t, 4> side{block.field(12, 13), block.field(25, 13), block.field(38, 13),
                                          block.field(51, 13)};
  const bool none = std::ranges::all_of(side, [](std::uint32_t s) { return s == kNoExtent; });
  if (high_range || reserved || (!none && (side[0] >= side[1] || side[2] >= side[3]))) return kAstcErrorColor;
  AstcColor color;
  for (std::size_t c = 0; c < 4; ++c)
    color[c] = static_cast<int>(block.field(64 + 16 * static_cast<int>(c) + 8, 8));
  return color;
}

/// The weights of the grid, those of two planes side by side. What lies beyond the last row is read with a
/// factor of 0.
using Grid = std::array<int, 2 * kMaxAstcWeights>;
Grid read_weights(const AstcBits& block, const AstcHeader& header) {
  std::array<std::uint8_t, kMaxAstcWeights> integers{};
  const auto count = static_cast<std::size_t>(header.weight_count());
  read_sequence(block.reversed().part(0, header.weight_bits), header.weights,
                std::span(integers).first(count));
  Grid grid{};
  for (std::size_t i = 0; i < count; ++i) grid[i] = weight_value(header.weights, integers[i]);
  return grid;
}

/// Place of a row or column of texels in the grid, in 16ths. [KDF #ASTC, weight infill]
int place_in_grid(int texel, int texels, int weights) {
  const int scale = (1024 + texels / 2) / (texels - 1);
  return (scale * texel * (weights - 1) + 32) >> 6;
}

/// The four weights around a texel and their factors, in 16ths.
struct Around {
  std::array<std::size_t, 4> index;
  std::array<int, 4> factor;
};
Around around(const AstcHeader& header, const Size& size, int x, int y) {
  const int s = place_in_grid(x, size.width, header.columns), t = place_in_grid(y, size.height, header.rows);
  const int fs = s & 15, ft = t & 15, both = (fs * ft + 8) >> 4;
  const auto first = static_cast<std::size_t>((s >> 4) + (t >> 4) * header.columns);
  const auto below = first + static_cast<std::size_t>(header.columns);
  return {{first, first + 1, below, below + 1}, {16 - fs - ft + both, fs - both, ft - both, both}};
}
int weight_at(const Grid& grid, const Around& place, std::size_t planes, std::size_t plane) {
  int sum = 8;
  for (std::size_t i = 0; i < 4; ++i)
    if (place.factor[i] != 0) sum += grid[place.index[i] * planes + plane] * place.factor[i];
  return sum >> 4;
}

/// [KDF #ASTC, partition pattern generation]
std::uint32_t hashed(std::uint32_t p) {
  p ^= p >> 15;
  p -= p << 17;
  p += p << 7;
  p += p << 4;
  p ^= p >> 5;
  p += p << 16;
  p ^= p >> 7;
  p ^= p >> 3;
  p ^= p << 6;
  p ^= p >> 17;
  return p;
}

/// Which of several partitions each texel of a block belongs to: the one whose plane, of slopes that the
/// pattern's number yields, is highest there.
class Pattern {
 public:
  Pattern(int number, int partitions, const Size& size)
      : partitions_(static_cast<std::size_t>(partitions)), scale_(size.width * size.height < 31 ? 2 : 1) {
    const std::uint32_t seed = static_cast<std::uint32_t>(number + 1024 * (partitions - 1));
    const std::uint32_t random = hashed(seed);
    const int by_three = partitions == 3 ? 6 : 5, by_bit = (seed & 2) != 0 ? 4 : 5;
    const int x_shift = (seed & 1) != 0 ? by_bit : by_three, y_shift = (seed & 1) != 0 ? by_three : by_bit;
    constexpr std::array<int, 4> kStarts{14, 10, 6, 2};
    for (std::size_t p = 0; p < partitions_; ++p) {
      const auto at = static_cast<int>(8 * p);
      const auto square = [random](int low) {
        const auto part = static_cast<int>(random >> low & 15);
        return part * part;
      };
      planes_[p] = {square(at) >> x_shift, square(at + 4) >> y_shift, static_cast<int>(random >> kStarts[p])};
    }
  }
  [[nodiscard]] std::size_t partition(int x, int y) const {
    std::size_t best = 0;
    int highest = -1;
    for (std::size_t p = 0; p < partitions_; ++p) {
      const Plane& plane = planes_[p];
      const int height = (plane.x * x * scale_ + plane.y * y * scale_ + plane.start) & 63;
      if (height > highest) {
        highest = height;
        best = p;
      }
    }
    return best;
  }

 private:
  struct Plane {
    int x, y, start;
  };
  std::array<Plane, kMaxAstcPartitions> planes_{};
  std::size_t partitions_;
  int scale_;
};

using Ends = std::array<AstcEnds, kMaxAstcPartitions>;
Ends read_ends(const AstcBits& block, const AstcHeader& header) {
  std::array<std::uint8_t, kMaxAstcEndIntegers> integers{};
  const auto partitions = static_cast<std::size_t>(header.partitions);
  std::size_t count = 0;
  for (std::size_t p = 0; p < partitions; ++p)
    count += static_cast<std::size_t>(end_integers(header.end_mode[p]));
  read_sequence(block.part(header.ends_at, header.end_bits), header.ends, std::span(integers).first(count));
  std::array<int, kMaxAstcEndIntegers> values{};
  for (std::size_t i = 0; i < count; ++i) values[i] = end_value(header.ends, integers[i]);
  Ends ends;
  std::span<const int> rest(values);
  for (std::size_t p = 0; p < partitions; ++p) {
    const auto taken = static_cast<std::size_t>(end_integers(header.end_mode[p]));
    ends[p] = astc_ends(header.end_mode[p], rest.first(taken));
    rest = rest.subspan(taken);
  }
  return ends;
}

/// The high eight of 16 bits between two ends.
int interpolate(int first, int second, int weight, bool srgb) {
  return (widened(first, srgb) * (64 - weight) + widened(second, srgb) * weight + 32) >> 14;
}

void decode_texels(const AstcBits& block, const AstcHeader& header, const Size& size, bool srgb,
                   BlockTexels& texels) {
  const Grid grid = read_weights(block, header);
  const Ends ends = read_ends(block, header);
  const Pattern pattern(header.pattern, header.partitions, size);
  const std::size_t planes = header.two_planes ? 2 : 1;
  const auto second = static_cast<std::size_t>(header.second_component);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const Around place = around(header, size, x, y);
      std::array<int, 4> weight;
      weight.fill(weight_at(grid, place, planes, 0));
      if (header.two_planes) weight[second] = weight_at(grid, place, planes, 1);
      const AstcEnds& between = ends[header.partitions == 1 ? 0 : pattern.partition(x, y)];
      for (std::size_t c = 0; c < 4; ++c)
        store(texels, static_cast<std::size_t>(y * size.width + x), c,
              interpolate(between.first[c], between.second[c], weight[c], srgb));
    }
  }
}

}  // namespace

void decode_astc(BlockCode code, std::span<const std::byte> block, BlockTexels& texels) {
  const AstcBits bits(block);
  const BlockCodeInfo& info = block_code_info(code);
  const Size size{info.width, info.height};
  // UNORM and sRGB take turns.
  const bool srgb = (static_cast<int>(code) - static_cast<int>(BlockCode::kAstc4x4Unorm)) % 2 == 1;
  if (is_one_color(bits)) return fill(size, one_color(bits), texels);
  const std::optional<AstcHeader> header = astc_header(bits, size.width, size.height);
  if (!header) return fill(size, kAstcErrorColor, texels);
  decode_texels(bits, *header, size, srgb, texels);
}

}  // namespace quadrille::models
