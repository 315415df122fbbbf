/// Colours of ETC2 in its five modes, and channels of EAC. [KDF #ETC2]
#include "models/texture/block/etc2.h"

#include "models/texture/block/block_bits.h"

#include <algorithm>
#include <bit>

namespace quadrille::models {
namespace {

using Color = std::array<int, 3>;
using Texels = std::array<std::uint32_t, kBlockTexels>;  // RGBA8, row by row

/// Eight bytes as a number, the first byte highest.
std::uint64_t big_endian(std::span<const std::byte> block, std::size_t at) {
  return __builtin_bswap64(little_endian(block, at, 8));
}
int field(std::uint64_t word, int low, int count) {
  return static_cast<int>(word >> low & ((std::uint64_t{1} << count) - 1));
}
/// A field of `count` bits whose top bit is its sign.
int signed_field(std::uint64_t word, int low, int count) {
  const int value = field(word, low, count);
  return value >= 1 << (count - 1) ? value - (1 << count) : value;
}

/// To eight bits, the high ones repeated below.
int widened(int value, int bits) { return value << (8 - bits) | value >> (2 * bits - 8); }
Color widened(const Color& color, int bits) {
  return {widened(color[0], bits), widened(color[1], bits), widened(color[2], bits)};
}

std::uint32_t opaque(const Color& color, int more) {
  std::uint32_t texel = 0xff000000u;
  for (std::size_t c = 0; c < 3; ++c)
    texel |= static_cast<std::uint32_t>(std::clamp(color[c] + more, 0, 255)) << 8 * c;
  return texel;
}

/// Two bits a texel, the high ones of all texels in bits 31..16 of the word.
int paint_index(std::uint64_t word, int x, int y) {
  const int at = 4 * x + y;
  return field(word, at + 16, 1) << 1 | field(word, at, 1);
}
constexpr int kTransparentIndex = 2;

/// [KDF #ETC2, intensity modifiers]: of the even and of the odd index; from 2 on they are negative.
constexpr std::array<std::array<int, 2>, 8> kSteps{
    {{2, 8}, {5, 17}, {9, 29}, {13, 42}, {18, 60}, {24, 80}, {33, 106}, {47, 183}}};

/// The two halves of a block, side by side or one above the other, each with a colour of its own.
/// `transparent`: an index is kept for transparent texels, and the small steps are 0.
Texels decode_halves(std::uint64_t word, const std::array<Color, 2>& base, bool transparent) {
  const bool above = field(word, 32, 1) != 0;
  const std::array<int, 2> table{field(word, 37, 3), field(word, 34, 3)};
  Texels texels{};
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      const std::size_t half = (above ? y : x) >= 2 ? 1 : 0;
      const int index = paint_index(word, x, y);
      if (transparent && index == kTransparentIndex) continue;
      const bool large = (index & 1) != 0;
      const int step =
          !large && transparent ? 0 : kSteps[static_cast<std::size_t>(table[half])][large ? 1 : 0];
      texels[static_cast<std::size_t>(4 * y + x)] = opaque(base[half], index >= 2 ? -step : step);
    }
  }
  return texels;
}

Texels decode_individual(std::uint64_t word) {
  const Color first{field(word, 60, 4), field(word, 52, 4), field(word, 44, 4)},
      second{field(word, 56, 4), field(word, 48, 4), field(word, 40, 4)};
  return decode_halves(word, {widened(first, 4), widened(second, 4)}, false);
}

/// The colours of which each texel has one.
using Paints = std::array<std::uint32_t, 4>;
Texels decode_paints(std::uint64_t word, const Paints& paints, bool transparent) {
  Texels texels{};
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      const int index = paint_index(word, x, y);
      if (transparent && index == kTransparentIndex) continue;
      texels[static_cast<std::size_t>(4 * y + x)] = paints[static_cast<std::size_t>(index)];
    }
  }
  return texels;
}

/// [KDF #ETC2, distance table]
constexpr std::array<int, 8> kDistances{3, 6, 11, 16, 23, 32, 41, 64};

Texels decode_t(std::uint64_t word, bool transparent) {
  const Color first =
      widened(Color{field(word, 59, 2) << 2 | field(word, 56, 2), field(word, 52, 4), field(word, 48, 4)}, 4);
  const Color second = widened(Color{field(word, 44, 4), field(word, 40, 4), field(word, 36, 4)}, 4);
  const int d = kDistances[static_cast<std::size_t>(field(word, 34, 2) << 1 | field(word, 32, 1))];
  return decode_paints(word, {opaque(first, 0), opaque(second, d), opaque(second, 0), opaque(second, -d)},
                       transparent);
}

Texels decode_h(std::uint64_t word, bool transparent) {
  const Color first = widened(Color{field(word, 59, 4), field(word, 56, 3) << 1 | field(word, 52, 1),
                                    field(word, 51, 1) << 3 | field(word, 47, 3)},
                              4);
  const Color second = widened(Color{field(word, 43, 4), field(word, 39, 4), field(word, 35, 4)}, 4);
  const int low = first >= second ? 1 : 0;  // red first
  const int d = kDistances[static_cast<std::size_t>(field(word, 34, 1) << 2 | field(word, 32, 1) << 1 | low)];
  return decode_paints(word, {opaque(first, d), opaque(first, -d), opaque(second, d), opaque(second, -d)},
                       transparent);
}

/// Three colours: at the first texel, and what would be the fifth of the first row and of the first column.
Texels decode_planar(std::uint64_t word) {
  const Color origin{widened(field(word, 57, 6), 6), widened(field(word, 56, 1) << 6 | field(word, 49, 6), 7),
                     widened(field(word, 48, 1) << 5 | field(word, 43, 2) << 3 | field(word, 39, 3), 6)};
  const Color across{widened(field(word, 34, 5) << 1 | field(word, 32, 1), 6), widened(field(word, 25, 7), 7),
                     widened(field(word, 19, 6), 6)};
  const Color down{widened(field(word, 13, 6), 6), widened(field(word, 6, 7), 7),
                   widened(field(word, 0, 6), 6)};
  Texels texels;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      Color color;
      for (std::size_t c = 0; c < 3; ++c)
        color[c] = (x * (across[c] - origin[c]) + y * (down[c] - origin[c]) + 4 * origin[c] + 2) >> 2;
      texels[static_cast<std::size_t>(4 * y + x)] = opaque(color, 0);
    }
  }
  return texels;
}

/// Bit 33 chooses the individual mode or, in blocks with one bit of alpha, says that there is none
/// transparent. Which of the other modes it is say sums that leave 0..31.
Texels decode_colors(std::uint64_t word, bool one_bit_alpha) {
  const bool flag = field(word, 33, 1) != 0;
  if (!flag && !one_bit_alpha) return decode_individual(word);
  const bool transparent = !flag;
  const Color first{field(word, 59, 5), field(word, 51, 5), field(word, 43, 5)};
  const Color second{first[0] + signed_field(word, 56, 3), first[1] + signed_field(word, 48, 3),
                     first[2] + signed_field(word, 40, 3)};
  const auto leaves = [&second](std::size_t c) { return second[c] < 0 || second[c] > 31; };
  if (leaves(0)) return decode_t(word, transparent);
  if (leaves(1)) return decode_h(word, transparent);
  if (leaves(2)) return decode_planar(word);
  return decode_halves(word, {widened(first, 5), widened(second, 5)}, transparent);
}

/// [KDF #ETC2, modifiers of alpha]: the four below 0, then the four above.
constexpr std::array<std::array<std::int8_t, 8>, 16> kModifiers{{{-3, -6, -9, -15, 2, 5, 8, 14},
                                                                 {-3, -7, -10, -13, 2, 6, 9, 12},
                                                                 {-2, -5, -8, -13, 1, 4, 7, 12},
                                                                 {-2, -4, -6, -13, 1, 3, 5, 12},
                                                                 {-3, -6, -8, -12, 2, 5, 7, 11},
                                                                 {-3, -7, -9, -11, 2, 6, 8, 10},
                                                                 {-4, -7, -8, -11, 3, 6, 7, 10},
                                                                 {-3, -5, -8, -11, 2, 4, 7, 10},
                                                                 {-2, -6, -8, -10, 1, 5, 7, 9},
                                                                 {-2, -5, -8, -10, 1, 4, 7, 9},
                                                                 {-2, -4, -8, -10, 1, 3, 7, 9},
                                                                 {-2, -5, -7, -10, 1, 4, 6, 9},
                                                                 {-3, -4, -7, -10, 2, 3, 6, 9},
                                                                 {-1, -2, -3, -10, 0, 1, 2, 9},
                                                                 {-4, -6, -8, -9, 3, 5, 7, 8},
                                                                 {-3, -5, -7, -9, 2, 4, 6, 8}}};

/// The modifier of texel (x, y) in a word of EAC.
int modifier(std::uint64_t word, std::size_t texel) {
  const int x = static_cast<int>(texel % 4), y = static_cast<int>(texel / 4);
  const int index = field(word, 45 - 3 * (4 * x + y), 3);
  return kModifiers[static_cast<std::size_t>(field(word, 48, 4))][static_cast<std::size_t>(index)];
}

std::uint32_t alpha(std::uint64_t word, std::size_t texel) {
  const int value = field(word, 56, 8) + modifier(word, texel) * field(word, 52, 4);
  return static_cast<std::uint32_t>(std::clamp(value, 0, 255));
}

/// Steps of eight, or of one where the multiplier is 0.
int eac_step(std::uint64_t word, std::size_t texel) {
  const int multiplier = field(word, 52, 4);
  return modifier(word, texel) * (multiplier == 0 ? 1 : 8 * multiplier);
}
std::uint16_t unsigned_channel(std::uint64_t word, std::size_t texel) {
  const int value = std::clamp(8 * field(word, 56, 8) + 4 + eac_step(word, texel), 0, 2047);
  return static_cast<std::uint16_t>(value << 5 | value >> 6);
}
std::uint16_t signed_channel(std::uint64_t word, std::size_t texel) {
  const int base = std::max(signed_field(word, 56, 8), -127);
  const int value = std::clamp(8 * base + eac_step(word, texel), -1023, 1023);
  const int size = std::abs(value), wide = size << 5 | size >> 5;
  return static_cast<std::uint16_t>(value < 0 ? -wide : wide);
}

}  // namespace

void decode_etc2(BlockCode code, std::span<const std::byte> block, BlockTexels& texels) {
  const bool eight_bits = code == BlockCode::kEtc2Rgba8;
  Texels colors = decode_colors(big_endian(block, eight_bits ? 8 : 0), code == BlockCode::kEtc2Rgb8A1);
  if (eight_bits) {
    const std::uint64_t word = big_endian(block, 0);
    for (std::size_t i = 0; i < kBlockTexels; ++i)
      colors[i] = (colors[i] & 0x00ffffffu) | alpha(word, i) << 24;
  }
  std::memcpy(texels.bytes.data(), colors.data(), sizeof colors);
}

void decode_eac(BlockCode code, std::span<const std::byte> block, BlockTexels& texels) {
  const bool is_signed = code == BlockCode::kEacR11Snorm || code == BlockCode::kEacR11G11Snorm;
  const std::size_t channels = block.size() / 8;
  for (std::size_t c = 0; c < channels; ++c) {
    const std::uint64_t word = big_endian(block, 8 * c);
    for (std::size_t i = 0; i < kBlockTexels; ++i) {
      const std::uint16_t value = is_signed ? signed_channel(word, i) : unsigned_channel(word, i);
      std::memcpy(&texels.bytes[2 * (channels * i + c)], &value, sizeof value);
    }
  }
}

}  // namespace quadrille::models
