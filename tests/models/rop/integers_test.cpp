/// Formats of integers: what a pixel keeps of what a program wrote, and what comes back of it.
#include "models/rop/blend.h"
#include "models/rop/quad_codec.h"
#include "tests/models/random_source.h"

#include <catch2/catch.hpp>

#include <array>
#include <bit>
#include <cstring>
#include <vector>

using namespace quadrille::models;

namespace {

std::vector<Format> integer_colors() {
  std::vector<Format> formats;
  for (int f = 0; f <= static_cast<int>(kLastFormat); ++f) {
    const auto format = static_cast<Format>(f);
    if (format_info(format).may(kColorUse) && is_integer_format(format)) formats.push_back(format);
  }
  return formats;
}

/// The low bits of a word, extended again.
std::uint32_t kept(const ComponentBits& component, std::uint32_t word) {
  if (component.bits == 32) return word;
  const std::uint32_t low = word & ((1u << component.bits) - 1);
  const bool negative = component.numeric == Numeric::kSint && (low >> (component.bits - 1) & 1u) != 0;
  return negative ? low | ~0u << component.bits : low;
}

using Words = std::array<std::array<std::uint32_t, 4>, 4>;  ///< by component and pixel

Words random_words(RandomSource& random) {
  Words words{};
  for (auto& component : words)
    for (std::uint32_t& word : component) word = random.bits();
  return words;
}

void write(Format format, const BlendState& state, const BlendShared& shared, const Words& words,
           std::byte* pixels, std::uint32_t mask) {
  float rgba[4][4];
  std::memcpy(rgba, words.data(), sizeof rgba);
  blend_quad(state, shared, format, rgba, nullptr, pixels, mask);
}

/// Of a stored quad, by component and pixel; components that the format lacks are (0, 0, 0, 1).
Words read(Format format, const std::byte* pixels) {
  const QuadColor color = decode_quad(format_info(format), load_quad(pixels, format_info(format).bytes));
  Words words{};
  for (std::size_t c = 0; c < 4; ++c) std::memcpy(words[c].data(), &color[c], sizeof words[c]);
  return words;
}

}  // namespace

TEST_CASE("integers: there are eighteen formats, of 8, 16 and 32 bits and one, two and four components") {
  CHECK(integer_colors().size() == 18);
  for (const Format format : integer_colors()) {
    const FormatInfo& info = format_info(format);
    INFO(info.name);
    CHECK(info.bytes * 8 == info.channels * info.component[0].bits);
    CHECK_FALSE(info.may(kBlendUse));
    CHECK(info.may(kSampleUse));
  }
}

TEST_CASE("integers: a pixel keeps the low bits of each component, and gives them back by its sign") {
  RandomSource random(1);
  for (const Format format : integer_colors()) {
    const FormatInfo& info = format_info(format);
    INFO(info.name);
    for (int round = 0; round < 200; ++round) {
      alignas(16) std::array<std::byte, 64> pixels{};
      const Words words = random_words(random);
      write(format, {}, {}, words, pixels.data(), 0xf);
      const Words back = read(format, pixels.data());
      for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t i = 0; i < 4; ++i)
          REQUIRE(back[c][i] ==
                  (c < info.channels ? kept(info.component[c], words[c][i]) : (c == 3 ? 1u : 0u)));
    }
  }
}

TEST_CASE("integers: masks keep components and pixels, and a program's NaN is but bits") {
  RandomSource random(2);
  for (const Format format : integer_colors()) {
    const FormatInfo& info = format_info(format);
    INFO(info.name);
    alignas(16) std::array<std::byte, 64> pixels{};
    Words before = random_words(random), after = random_words(random);
    before[0] = {0x7f800001u, 0xffc00000u, 0x7fffffffu, 0x80000000u};
    write(format, {}, {}, before, pixels.data(), 0xf);
    BlendState state;
    state.write_mask = 0x5;
    write(format, state, {}, after, pixels.data(), 0x6);
    const Words now = read(format, pixels.data());
    for (std::size_t c = 0; c < info.channels; ++c)
      for (std::size_t i = 0; i < 4; ++i) {
        const bool written = c % 2 == 0 && (i == 1 || i == 2);
        CHECK(now[c][i] == kept(info.component[c], (written ? after : before)[c][i]));
      }
  }
}

TEST_CASE("integers: logic operations work on their bits") {
  RandomSource random(3);
  for (const Format format : integer_colors()) {
    const FormatInfo& info = format_info(format);
    INFO(info.name);
    const Words s = random_words(random), d = random_words(random);
    const auto result = [&](LogicOp op) {
      alignas(16) std::array<std::byte, 64> pixels{};
      write(format, {}, {}, d, pixels.data(), 0xf);
      write(format, {}, {{}, true, op}, s, pixels.data(), 0xf);
      return read(format, pixels.data());
    };
    const Words both = result(LogicOp::kAnd), either = result(LogicOp::kXor),
                flipped = result(LogicOp::kInvert);
    for (std::size_t c = 0; c < info.channels; ++c)
      for (std::size_t i = 0; i < 4; ++i) {
        CHECK(both[c][i] == kept(info.component[c], s[c][i] & d[c][i]));
        CHECK(either[c][i] == kept(info.component[c], s[c][i] ^ d[c][i]));
        CHECK(flipped[c][i] == kept(info.component[c], ~d[c][i]));
      }
  }
}

TEST_CASE("integers: clear values are those that the format holds, and a picture shows their low 8 bits") {
  using Four = std::array<std::uint32_t, 4>;
  CHECK(holds_integers(Format::kR8G8B8A8Uint, Four{255, 0, 1, 2}));
  CHECK_FALSE(holds_integers(Format::kR8G8B8A8Uint, Four{255, 0, 1, 256}));
  CHECK(holds_integers(Format::kR8Uint, Four{255, 256, 256, 256}));  // of what it has
  CHECK(holds_integers(Format::kR8Sint, Four{static_cast<std::uint32_t>(-128), 0, 0, 0}));
  CHECK_FALSE(holds_integers(Format::kR8Sint, Four{static_cast<std::uint32_t>(-129), 0, 0, 0}));
  CHECK_FALSE(holds_integers(Format::kR8Sint, Four{128, 0, 0, 0}));
  CHECK(holds_integers(Format::kR32Uint, Four{~0u, 0, 0, 0}));
  CHECK(holds_integers(Format::kR32Sint, Four{0x80000000u, 0, 0, 0}));
  const PixelCode code = encode_integers(Format::kR16G16B16A16Sint, {0x1234, ~0u, 0x80, 0x7fff});
  CHECK(code.word == std::array<std::uint32_t, 4>{0xffff1234u, 0x7fff0080u, 0, 0});
  CHECK(to_rgba8(Format::kR16G16B16A16Sint, code) == 0xff80ff34u);
  CHECK(to_rgba8(Format::kR32Uint, {{0x12345678u}}) == 0xff000078u);
  CHECK(decode_color(Format::kR16Sint, {{0xfffe}}) == std::array<float, 4>{-2, 0, 0, 1});
}
