#include "models/texture/block/s3tc.h"

#include "models/texture/block/block_bits.h"

#include <algorithm>

namespace quadrille::models {
namespace {

struct Rgb {
  std::array<std::uint32_t, 3> channel;
};

/// Five, six and five bits, blue in the low ones; the high bits are repeated below.
Rgb expand_565(std::uint32_t code) {
  const std::uint32_t r = code >> 11, g = code >> 5 & 63, b = code & 31;
  return {{r << 3 | r >> 2, g << 2 | g >> 4, b << 3 | b >> 2}};
}

std::uint32_t pack(const Rgb& c, std::uint32_t alpha) {
  return c.channel[0] | c.channel[1] << 8 | c.channel[2] << 16 | alpha << 24;
}

/// (a * wa + b * wb) / (wa + wb), rounded down.
Rgb mix(const Rgb& a, std::uint32_t wa, const Rgb& b, std::uint32_t wb) {
  Rgb mixed{};
  for (std::size_t c = 0; c < 3; ++c) mixed.channel[c] = (a.channel[c] * wa + b.channel[c] * wb) / (wa + wb);
  return mixed;
}

enum class Black : std::uint8_t { kNever, kOpaque, kTransparent };

/// Eight bytes of colours to RGBA8 of alpha 255. Where the first end is not the larger, a code that knows
/// black has only one colour between the ends.
std::array<std::uint32_t, kBlockTexels> colors(std::span<const std::byte> block, Black black) {
  const auto first = static_cast<std::uint32_t>(little_endian(block, 0, 2)),
             second = static_cast<std::uint32_t>(little_endian(block, 2, 2));
  const Rgb a = expand_565(first), b = expand_565(second);
  std::array<std::uint32_t, 4> palette{pack(a, 255), pack(b, 255)};
  if (first > second || black == Black::kNever) {
    palette[2] = pack(mix(a, 2, b, 1), 255);
    palette[3] = pack(mix(a, 1, b, 2), 255);
  } else {
    palette[2] = pack(mix(a, 1, b, 1), 255);
    palette[3] = black == Black::kOpaque ? 0xff000000u : 0;
  }
  const auto indices = static_cast<std::uint32_t>(little_endian(block, 4, 4));
  std::array<std::uint32_t, kBlockTexels> texels;
  for (std::uint32_t i = 0; i < kBlockTexels; ++i) texels[i] = palette[indices >> 2 * i & 3];
  return texels;
}

/// The values of a channel's eight bytes: two ends, and an index of three bits a texel. Where the first end
/// is the larger, six values lie between them, else four, and the least and the largest number that there
/// are. Quotients are rounded towards zero.
std::array<int, kBlockTexels> channel_values(std::span<const std::byte> block, std::size_t at, int least,
                                             int largest) {
  const auto end = [&](std::size_t i) {
    const auto code = static_cast<std::uint8_t>(block[at + i]);
    return least < 0 ? std::max<int>(static_cast<std::int8_t>(code), least) : int{code};
  };
  const int a = end(0), b = end(1);
  std::array<int, 8> palette{a, b, 0, 0, 0, 0, least, largest};
  const int steps = a > b ? 7 : 5;
  for (int i = 1; i < steps; ++i)
    palette[static_cast<std::size_t>(i + 1)] = (a * (steps - i) + b * i) / steps;
  const std::uint64_t indices = little_endian(block, at + 2, 6);
  std::array<int, kBlockTexels> values;
  for (std::uint32_t i = 0; i < kBlockTexels; ++i) values[i] = palette[indices >> 3 * i & 7];
  return values;
}

void store(const std::array<std::uint32_t, kBlockTexels>& rgba, BlockTexels& texels) {
  std::memcpy(texels.bytes.data(), rgba.data(), sizeof rgba);
}

}  // namespace

void decode_s3tc(BlockCode code, std::span<const std::byte> block, BlockTexels& texels) {
  if (code == BlockCode::kBc1Rgb || code == BlockCode::kBc1Rgba) {
    store(colors(block, code == BlockCode::kBc1Rgb ? Black::kOpaque : Black::kTransparent), texels);
    return;
  }
  auto rgba = colors(block.subspan(8), Black::kNever);
  if (code == BlockCode::kBc2) {
    const std::uint64_t alpha = little_endian(block, 0, 8);
    for (std::uint32_t i = 0; i < kBlockTexels; ++i)
      rgba[i] = (rgba[i] & 0x00ffffffu) | static_cast<std::uint32_t>(alpha >> 4 * i & 15) * 17 << 24;
  } else {
    const auto alpha = channel_values(block, 0, 0, 255);
    for (std::uint32_t i = 0; i < kBlockTexels; ++i)
      rgba[i] = (rgba[i] & 0x00ffffffu) | static_cast<std::uint32_t>(alpha[i]) << 24;
  }
  store(rgba, texels);
}

void decode_rgtc(BlockCode code, std::span<const std::byte> block, BlockTexels& texels) {
  const bool is_signed = code == BlockCode::kBc4Snorm || code == BlockCode::kBc5Snorm;
  const std::size_t channels = code == BlockCode::kBc5Unorm || code == BlockCode::kBc5Snorm ? 2 : 1;
  for (std::size_t c = 0; c < channels; ++c) {
    const auto values = channel_values(block, 8 * c, is_signed ? -127 : 0, is_signed ? 127 : 255);
    for (std::size_t i = 0; i < kBlockTexels; ++i)
      texels.bytes[channels * i + c] = static_cast<std::byte>(values[i]);
  }
}

}  // namespace quadrille::models
