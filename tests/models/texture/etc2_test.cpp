/// Decoded blocks of ETC2 and EAC: against a decoder that reads the bits by their places in the standard's
/// tables, texel by texel and in floating point, in every mode; and the standard's worked examples. That they
/// are another program's too, tests/lavapipe/gles_blocks_test.cpp holds.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "models/texture/block/block_code.h"
#include "tests/models/random_source.h"

namespace quadrille::models {
namespace {

using Bytes = std::vector<std::byte>;

/// The bits of a word of 64 by their numbers in the standard, 63 the first bit of the first byte.
class Word {
 public:
  explicit Word(std::span<const std::byte> bytes) {
    for (std::size_t i = 0; i < 64; ++i)
      bits_[63 - i] = static_cast<char>('0' + (static_cast<int>(bytes[i / 8]) >> (7 - i % 8) & 1));
  }
  /// The number that bits `high` down to `low` are, and then those of further places.
  template <typename... More>
  [[nodiscard]] int number(int high, int low, More... more) const {
    return static_cast<int>(std::stoul(text(high, low, more...), nullptr, 2));
  }
  /// Two's complement.
  [[nodiscard]] int whole(int high, int low) const {
    const int value = number(high, low), size = high - low + 1;
    return text(high, low)[0] == '1' ? value - (1 << size) : value;
  }

 private:
  template <typename... More>
  [[nodiscard]] std::string text(int high, int low, More... more) const {
    std::string digits;
    for (int i = high; i >= low; --i) digits += bits_[static_cast<std::size_t>(i)];
    if constexpr (sizeof...(more) > 0) digits += text(more...);
    return digits;
  }
  std::array<char, 64> bits_{};
};

enum class Mode : std::uint8_t { kIndividual, kDifferential, kT, kH, kPlanar };

Mode mode_of(const Word& w, bool one_bit) {
  if (!one_bit && w.number(33, 33) == 0) return Mode::kIndividual;
  const auto beyond = [](int sum) { return sum < 0 || sum > 31; };
  if (beyond(w.number(63, 59) + w.whole(58, 56))) return Mode::kT;
  if (beyond(w.number(55, 51) + w.whole(50, 48))) return Mode::kH;
  return beyond(w.number(47, 43) + w.whole(42, 40)) ? Mode::kPlanar : Mode::kDifferential;
}

using Rgba = std::array<int, 4>;

int limited(double value, double least = 0, double most = 255) {
  return static_cast<int>(std::floor(std::min(std::max(value, least), most) + 0.5));
}
/// A number of 4 to 7 bits, of 8: as near as its own scale allows.
int from_bits(int value, int bits) {
  std::string digits;
  for (int i = 0; i < 8; ++i) digits += (value >> (bits - 1 - i % bits) & 1) != 0 ? '1' : '0';
  return static_cast<int>(std::stoul(digits, nullptr, 2));
}
Rgba grown(const Rgba& color, double by) {
  return {limited(color[0] + by), limited(color[1] + by), limited(color[2] + by), 255};
}
Rgba color_of(int r, int g, int b, int bits) {
  return {from_bits(r, bits), from_bits(g, bits), from_bits(b, bits), 255};
}

/// Texel (x, y) as letters of the standard name it: a..d are the first column.
int index_of(const Word& w, int x, int y) {
  const int letter = 4 * x + y;
  return w.number(16 + letter, 16 + letter, letter, letter);
}

Rgba texel_of_halves(const Word& w, int x, int y, bool individual, bool transparent) {
  const bool second = w.number(32, 32) == 1 ? y > 1 : x > 1;
  Rgba base{};
  for (int c = 0; c < 3; ++c) {
    const int top = 63 - 8 * c;
    const int moved = second ? w.whole(top - 5, top - 7) : 0;
    base[static_cast<std::size_t>(c)] =
        individual ? from_bits(second ? w.number(top - 4, top - 7) : w.number(top, top - 3), 4)
                   : from_bits(w.number(top, top - 4) + moved, 5);
  }
  // The standard's table of steps and of pixel indices: most negative to most positive.
  constexpr double kTable[8][4] = {{-8, -2, 2, 8},       {-17, -5, 5, 17},    {-29, -9, 9, 29},
                                   {-42, -13, 13, 42},   {-60, -18, 18, 60},  {-80, -24, 24, 80},
                                   {-106, -33, 33, 106}, {-183, -47, 47, 183}};
  constexpr int kOrder[4] = {2, 3, 1, 0};
  const int index = index_of(w, x, y);
  const auto& steps = kTable[second ? w.number(36, 34) : w.number(39, 37)];
  if (!transparent) return grown(base, steps[kOrder[index]]);
  if (index == 2) return {0, 0, 0, 0};
  return grown(base, index == 0 ? 0 : steps[kOrder[index]]);
}

constexpr double kDistance[8] = {3, 6, 11, 16, 23, 32, 41, 64};

Rgba texel_of_paints(const Word& w, int x, int y, bool t, bool transparent) {
  const int index = index_of(w, x, y);
  if (transparent && index == 2) return {0, 0, 0, 0};
  if (t) {
    const Rgba first = color_of(w.number(60, 59, 57, 56), w.number(55, 52), w.number(51, 48), 4),
               second = color_of(w.number(47, 44), w.number(43, 40), w.number(39, 36), 4);
    const double d = kDistance[w.number(35, 34, 32, 32)];
    if (index == 0) return first;
    return grown(second, index == 1 ? d : index == 2 ? 0 : -d);
  }
  const Rgba first = color_of(w.number(62, 59), w.number(58, 56, 52, 52), w.number(51, 51, 49, 47), 4),
             second = color_of(w.number(46, 43), w.number(42, 39), w.number(38, 35), 4);
  const auto value = [](const Rgba& c) { return (c[0] * 256 + c[1]) * 256 + c[2]; };
  const double d = kDistance[2 * w.number(34, 34, 32, 32) + (value(first) >= value(second) ? 1 : 0)];
  return grown(index < 2 ? first : second, index % 2 == 0 ? d : -d);
}

Rgba texel_of_plane(const Word& w, int x, int y) {
  const std::array<int, 3> o{from_bits(w.number(62, 57), 6), from_bits(w.number(56, 56, 54, 49), 7),
                             from_bits(w.number(48, 48, 44, 43, 41, 39), 6)},
      h{from_bits(w.number(38, 34, 32, 32), 6), from_bits(w.number(31, 25), 7),
        from_bits(w.number(24, 19), 6)},
      v{from_bits(w.number(18, 13), 6), from_bits(w.number(12, 6), 7), from_bits(w.number(5, 0), 6)};
  Rgba color{0, 0, 0, 255};
  for (std::size_t c = 0; c < 3; ++c)
    color[c] = limited(x * (h[c] - o[c]) / 4.0 + y * (v[c] - o[c]) / 4.0 + o[c]);
  return color;
}

Rgba color_texel(const Word& w, int x, int y, bool one_bit) {
  const bool transparent = one_bit && w.number(33, 33) == 0;
  switch (mode_of(w, one_bit)) {
    case Mode::kIndividual: return texel_of_halves(w, x, y, true, false);
    case Mode::kDifferential: return texel_of_halves(w, x, y, false, transparent);
    case Mode::kT: return texel_of_paints(w, x, y, true, transparent);
    case Mode::kH: return texel_of_paints(w, x, y, false, transparent);
    case Mode::kPlanar: return texel_of_plane(w, x, y);
  }
  return {};
}

/// Modifiers of alpha as the standard lists them.
constexpr double kModifiers[16][8] = {
    {-3, -6, -9, -15, 2, 5, 8, 14}, {-3, -7, -10, -13, 2, 6, 9, 12}, {-2, -5, -8, -13, 1, 4, 7, 12},
    {-2, -4, -6, -13, 1, 3, 5, 12}, {-3, -6, -8, -12, 2, 5, 7, 11},  {-3, -7, -9, -11, 2, 6, 8, 10},
    {-4, -7, -8, -11, 3, 6, 7, 10}, {-3, -5, -8, -11, 2, 4, 7, 10},  {-2, -6, -8, -10, 1, 5, 7, 9},
    {-2, -5, -8, -10, 1, 4, 7, 9},  {-2, -4, -8, -10, 1, 3, 7, 9},   {-2, -5, -7, -10, 1, 4, 6, 9},
    {-3, -4, -7, -10, 2, 3, 6, 9},  {-1, -2, -3, -10, 0, 1, 2, 9},   {-4, -6, -8, -9, 3, 5, 7, 8},
    {-3, -5, -7, -9, 2, 4, 6, 8}};
double modifier_of(const Word& w, int x, int y) {
  const int first = 47 - 3 * (4 * x + y);
  return kModifiers[w.number(51, 48)][w.number(first, first - 2)];
}

/// A channel of EAC, 0..1 or -1..1, in the standard's fractions of 255.875 and 127.875.
double channel(const Word& w, int x, int y, bool is_signed) {
  const double multiplier = w.number(55, 52) == 0 ? 1.0 / 8 : w.number(55, 52);
  const double base = is_signed ? std::max(-127, w.whole(63, 56)) : w.number(63, 56) + 0.5;
  const double scale = is_signed ? 127.875 : 255.875;
  return std::clamp((base + modifier_of(w, x, y) * multiplier) / scale, is_signed ? -1.0 : 0.0, 1.0);
}

Bytes chance(RandomSource& random, std::size_t bytes) {
  Bytes block(bytes);
  for (std::byte& b : block) b = static_cast<std::byte>(random.bits() >> 8 & 0xff);
  return block;
}
BlockTexels decoded(BlockCode code, const Bytes& block) {
  BlockTexels texels;
  decode_block(code, block, texels);
  return texels;
}
Bytes bytes_of(std::uint64_t word) {
  Bytes bytes;
  for (int shift = 56; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::byte>(word >> shift & 0xff));
  return bytes;
}
int word_at(const BlockTexels& texels, std::size_t i, bool is_signed) {
  std::uint16_t value = 0;
  std::memcpy(&value, texels.bytes.data() + 2 * i, sizeof value);
  return is_signed ? static_cast<std::int16_t>(value) : value;
}

void check_colors(BlockCode code, bool one_bit, std::size_t modes) {
  RandomSource random(static_cast<std::uint32_t>(code));
  const std::size_t color_at = block_code_info(code).bytes - std::size_t{8};
  std::map<Mode, int> seen;
  for (int i = 0; i < 8000; ++i) {
    const Bytes block = chance(random, block_code_info(code).bytes);
    const Word color{std::span<const std::byte>(block).subspan(color_at)}, alpha{block};
    ++seen[mode_of(color, one_bit)];
    const BlockTexels ours = decoded(code, block);
    for (int t = 0; t < 16; ++t) {
      Rgba due = color_texel(color, t % 4, t / 4, one_bit);
      if (color_at != 0)
        due[3] = limited(alpha.number(63, 56) + modifier_of(alpha, t % 4, t / 4) * alpha.number(55, 52));
      for (std::size_t c = 0; c < 4; ++c)
        if (static_cast<int>(ours.bytes[4 * static_cast<std::size_t>(t) + c]) != due[c])
          FAIL("block " << i << ", mode " << static_cast<int>(mode_of(color, one_bit)) << ", texel " << t);
    }
  }
  CHECK(seen.size() == modes);
  for (const auto& [mode, count] : seen) CHECK(count > 100);
}

}  // namespace

TEST_CASE("etc2: blocks of every mode decode as the standard's tables have it, with and without alpha") {
  check_colors(BlockCode::kEtc2Rgb8, false, 5);
  check_colors(BlockCode::kEtc2Rgb8A1, true, 4);
  check_colors(BlockCode::kEtc2Rgba8, false, 5);
}

TEST_CASE("etc2: channels of EAC are the standard's fractions to the step of 16 bits") {
  for (const BlockCode code : {BlockCode::kEacR11Unorm, BlockCode::kEacR11Snorm, BlockCode::kEacR11G11Unorm,
                               BlockCode::kEacR11G11Snorm}) {
    const bool is_signed = code == BlockCode::kEacR11Snorm || code == BlockCode::kEacR11G11Snorm;
    const std::size_t channels = block_code_info(code).bytes / 8;
    RandomSource random(static_cast<std::uint32_t>(code));
    for (int i = 0; i < 8000; ++i) {
      Bytes block = chance(random, block_code_info(code).bytes);
      if (i % 8 == 0) block[1] &= std::byte{15};  // a multiplier of 0
      if (i % 8 == 1) block[0] = std::byte{128};
      const BlockTexels ours = decoded(code, block);
      for (std::size_t t = 0; t < 16; ++t) {
        for (std::size_t c = 0; c < channels; ++c) {
          const Word w{std::span<const std::byte>(block).subspan(8 * c)};
          const double exact = channel(w, static_cast<int>(t % 4), static_cast<int>(t / 4), is_signed);
          // The 11 bits are exact; repeating them below is right to less than a step of them.
          const double steps = is_signed ? 1023 : 2047, eleven = std::round(exact * steps);
          CHECK(std::abs(exact * steps - eleven) < 1e-9);
          const int value = word_at(ours, channels * t + c, is_signed);
          const auto wide = static_cast<int>(std::abs(eleven)), below = is_signed ? 5 : 6;
          const int due = (wide << 5 | wide >> below) * (eleven < 0 ? -1 : 1);
          if (value != due) FAIL("block " << i << ", texel " << t << ": " << value << ", " << due);
        }
      }
    }
  }
}

TEST_CASE("etc2: the standard's worked examples") {
  // Alpha: base 103, table 13, multiplier 2, index 3 in each texel: 103 - 10 x 2.
  const std::uint64_t threes = 0xdb6db6db6db6 / 2;
  const std::uint64_t alpha = std::uint64_t{103} << 56 | std::uint64_t{2} << 52 | std::uint64_t{13} << 48;
  Bytes block = bytes_of(alpha | threes);
  const Bytes color = bytes_of(0);
  block.insert(block.end(), color.begin(), color.end());
  CHECK(static_cast<int>(decoded(BlockCode::kEtc2Rgba8, block).bytes[3]) == 83);
  // Signed: base 60, table 13, index 3: 320 with a multiplier of 2, and 470 with one of 0, of 1023.
  const std::uint64_t base = std::uint64_t{60} << 56 | std::uint64_t{13} << 48 | threes;
  const auto first = [](std::uint64_t word) {
    return word_at(decoded(BlockCode::kEacR11Snorm, bytes_of(word)), 0, true);
  };
  CHECK(first(base | std::uint64_t{2} << 52) == (320 << 5 | 320 >> 5));
  CHECK(first(base) == 15054);
}

TEST_CASE("etc2: every pattern of bits of one word decodes, and a transparent texel is black") {
  RandomSource random(9);
  std::size_t transparent = 0;
  for (int i = 0; i < 4000; ++i) {
    const BlockTexels texels = decoded(BlockCode::kEtc2Rgb8A1, chance(random, 8));
    for (std::size_t t = 0; t < 16; ++t) {
      const int alpha = static_cast<int>(texels.bytes[4 * t + 3]);
      CHECK((alpha == 0 || alpha == 255));
      if (alpha != 0) continue;
      ++transparent;
      for (std::size_t c = 0; c < 3; ++c) CHECK(static_cast<int>(texels.bytes[4 * t + c]) == 0);
    }
  }
  CHECK(transparent > 1000);
}

}  // namespace quadrille::models
