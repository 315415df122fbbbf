/// Decoded blocks of BC1 to BC7: against libsquish, closed forms and blocks made by hand. That every mode of
/// BC6H and BC7 is the driver's, tests/lavapipe/block_codes_test.cpp holds.
#include <catch2/catch.hpp>

#include <squish.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "models/texture/block/block_code.h"
#include "tests/models/random_source.h"

namespace quadrille::models {
namespace {

using Bytes = std::vector<std::byte>;

Bytes chance(RandomSource& random, std::size_t bytes) {
  Bytes block(bytes);
  for (std::byte& b : block) b = static_cast<std::byte>(random.bits() & 0xff);
  return block;
}

BlockTexels decoded(BlockCode code, const Bytes& block) {
  BlockTexels texels;
  decode_block(code, block, texels);
  return texels;
}

std::array<squish::u8, 64> squish_decoded(const Bytes& block, int flags) {
  std::array<squish::u8, 64> rgba{};
  squish::Decompress(rgba.data(), block.data(), flags);
  return rgba;
}

void check_against_squish(BlockCode code, int flags) {
  RandomSource random(static_cast<std::uint32_t>(flags));
  for (int i = 0; i < 20000; ++i) {
    const Bytes block = chance(random, block_code_info(code).bytes);
    const BlockTexels ours = decoded(code, block);
    const auto theirs = squish_decoded(block, flags);
    if (std::memcmp(ours.bytes.data(), theirs.data(), theirs.size()) != 0) FAIL("block " << i);
  }
}

int byte_at(const BlockTexels& texels, std::size_t i) { return static_cast<int>(texels.bytes[i]); }

/// A block bit by bit, the first in the least place.
class BlockWriter {
 public:
  BlockWriter& put(std::uint32_t value, int bits) {
    for (int b = 0; b < bits; ++b, ++at_)
      block_[at_ / 8] |= static_cast<std::byte>((value >> b & 1) << at_ % 8);
    return *this;
  }
  [[nodiscard]] const Bytes& block() const { return block_; }

 private:
  Bytes block_ = Bytes(16);
  std::size_t at_ = 0;
};

}  // namespace

TEST_CASE("block_code: BC1, BC2 and BC3 decode to the bytes that libsquish gives") {
  check_against_squish(BlockCode::kBc1Rgba, squish::kDxt1);
  check_against_squish(BlockCode::kBc2, squish::kDxt3);
  check_against_squish(BlockCode::kBc3, squish::kDxt5);
}

TEST_CASE("block_code: BC1 without alpha differs from BC1 with it in the black texels alone") {
  RandomSource random(3);
  std::size_t black = 0;
  for (int i = 0; i < 2000; ++i) {
    const Bytes block = chance(random, 8);
    const BlockTexels with = decoded(BlockCode::kBc1Rgba, block),
                      without = decoded(BlockCode::kBc1Rgb, block);
    for (std::size_t t = 0; t < 16; ++t) {
      CHECK(std::memcmp(&with.bytes[4 * t], &without.bytes[4 * t], 3) == 0);
      CHECK(byte_at(without, 4 * t + 3) == 255);
      if (byte_at(with, 4 * t + 3) != 255) ++black;
    }
  }
  CHECK(black > 1000);
}

TEST_CASE("block_code: BC4 is the alpha of BC3, and BC5 is two of it") {
  RandomSource random(4);
  for (int i = 0; i < 5000; ++i) {
    const Bytes block = chance(random, 16);
    const Bytes first(block.begin(), block.begin() + 8), second(block.begin() + 8, block.end());
    const BlockTexels bc3 = decoded(BlockCode::kBc3, block), bc5 = decoded(BlockCode::kBc5Unorm, block);
    const BlockTexels red = decoded(BlockCode::kBc4Unorm, first),
                      green = decoded(BlockCode::kBc4Unorm, second);
    for (std::size_t t = 0; t < 16; ++t) {
      if (byte_at(red, t) != byte_at(bc3, 4 * t + 3)) FAIL("block " << i << ", texel " << t);
      if (byte_at(bc5, 2 * t) != byte_at(red, t) || byte_at(bc5, 2 * t + 1) != byte_at(green, t))
        FAIL("block " << i << ", texel " << t);
    }
  }
}

TEST_CASE("block_code: signed BC4 is within a step of the line between its ends") {
  RandomSource random(5);
  for (int i = 0; i < 5000; ++i) {
    const Bytes block = chance(random, 8);
    const BlockTexels texels = decoded(BlockCode::kBc4Snorm, block);
    const double a = std::max(-127, int{static_cast<std::int8_t>(block[0])}),
                 b = std::max(-127, int{static_cast<std::int8_t>(block[1])});
    const double steps = a > b ? 7 : 5;
    for (std::size_t t = 0; t < 16; ++t) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, block.data() + 2, 6);
      const auto index = static_cast<int>(bits >> 3 * t & 7);
      const double exact = index == 0                 ? a
                           : index == 1               ? b
                           : steps == 5 && index == 6 ? -127
                           : steps == 5 && index == 7 ? 127
                                                      : a + (b - a) * (index - 1) / steps;
      const double ours = static_cast<std::int8_t>(texels.bytes[t]);
      if (std::abs(ours - exact) >= 1)
        FAIL("block " << i << ", texel " << t << ": " << ours << ", " << exact);
    }
  }
}

TEST_CASE("block_code: a block of BC7 in mode 6 is a line of 16 colours between its two ends") {
  BlockWriter writer;
  writer.put(1u << 6, 7);
  const std::array<std::array<std::uint32_t, 2>, 4> ends{{{0, 127}, {127, 0}, {64, 64}, {10, 100}}};
  for (const auto& channel : ends) writer.put(channel[0], 7).put(channel[1], 7);
  writer.put(1, 1).put(0, 1);
  for (std::uint32_t t = 0; t < 16; ++t) writer.put(t == 0 ? 0 : t, t == 0 ? 3 : 4);
  const BlockTexels texels = decoded(BlockCode::kBc7, writer.block());
  constexpr std::array<int, 16> kWeights{0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64};
  for (std::size_t t = 0; t < 16; ++t) {
    const int w = kWeights[t];
    for (std::size_t c = 0; c < 4; ++c) {
      const int a = static_cast<int>(ends[c][0]) * 2 + 1, b = static_cast<int>(ends[c][1]) * 2;
      CHECK(byte_at(texels, 4 * t + c) == (a * (64 - w) + b * w + 32) / 64);
    }
  }
}

TEST_CASE("block_code: blocks of BC7 and BC6H in no mode are black, of BC6H opaque") {
  RandomSource random(6);
  Bytes block = chance(random, 16);
  block[0] = std::byte{0};
  const BlockTexels bc7 = decoded(BlockCode::kBc7, block);
  for (std::size_t i = 0; i < 64; ++i) CHECK(byte_at(bc7, i) == 0);
  for (const unsigned number : {19u, 23u, 27u, 31u}) {
    block[0] = static_cast<std::byte>(0xe0 | number);
    const BlockTexels bc6h = decoded(BlockCode::kBc6hUfloat, block);
    for (std::size_t t = 0; t < 16; ++t) {
      std::array<std::uint16_t, 4> halves{};
      std::memcpy(halves.data(), &bc6h.bytes[8 * t], sizeof halves);
      CHECK(halves == std::array<std::uint16_t, 4>{0, 0, 0, 0x3c00});
    }
  }
}

TEST_CASE("block_code: unsigned BC6H reaches the largest half and holds no negative one") {
  BlockWriter writer;
  writer.put(3, 5);
  for (int end = 0; end < 2; ++end)
    for (int channel = 0; channel < 3; ++channel) writer.put(end == 0 ? 0 : 1023, 10);
  for (std::uint32_t t = 0; t < 16; ++t) writer.put(t == 0 ? 0 : 15, t == 0 ? 3 : 4);
  const BlockTexels texels = decoded(BlockCode::kBc6hUfloat, writer.block());
  std::uint16_t first = 1, last = 0;
  std::memcpy(&first, &texels.bytes[0], 2);
  std::memcpy(&last, &texels.bytes[8], 2);
  CHECK(first == 0);
  CHECK(last == 0x7bff);
}

}  // namespace quadrille::models
