/// Decoded blocks of ASTC, in all sizes: against libastcenc, on blocks of chance, on legal ones of each kind,
/// and on those that its encoder makes of pictures; blocks of one colour and illegal ones by hand.
#include <catch2/catch.hpp>

#include <astcenc.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <vector>

#include "models/texture/block/astc_ends.h"
#include "models/texture/block/astc_header.h"
#include "models/texture/block/block_code.h"
#include "tests/models/random_source.h"

namespace quadrille::models {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::size_t kBlockBytes = 16;

std::vector<BlockCode> astc_codes() {
  std::vector<BlockCode> codes;
  for (auto c = static_cast<int>(BlockCode::kAstc4x4Unorm); c <= static_cast<int>(kLastBlockCode); ++c)
    codes.push_back(static_cast<BlockCode>(c));
  return codes;
}

struct FreeContext {
  void operator()(astcenc_context* context) const { astcenc_context_free(context); }
};
using Context = std::unique_ptr<astcenc_context, FreeContext>;

bool is_srgb(BlockCode code) { return block_code_info(code).name.ends_with("SRGB"); }

Context context_of(BlockCode code, float effort, unsigned flags) {
  const BlockCodeInfo& info = block_code_info(code);
  astcenc_config config{};
  astcenc_context* context = nullptr;
  REQUIRE(astcenc_config_init(is_srgb(code) ? ASTCENC_PRF_LDR_SRGB : ASTCENC_PRF_LDR, info.width, info.height,
                              1, effort, flags, &config) == ASTCENC_SUCCESS);
  REQUIRE(astcenc_context_alloc(&config, 1, &context) == ASTCENC_SUCCESS);
  return Context(context);
}

constexpr astcenc_swizzle kSame{ASTCENC_SWZ_R, ASTCENC_SWZ_G, ASTCENC_SWZ_B, ASTCENC_SWZ_A};

/// A row of blocks as libastcenc decodes it: RGBA8, row by row. It has eight bits of sRGB. Linear texels it
/// has as halves, which are the 16 bits between the ends over 65536, rounded towards zero, or 1 for 65535:
/// their high eight bits are still there.
Bytes decoded_by_library(BlockCode code, const Bytes& blocks) {
  const BlockCodeInfo& info = block_code_info(code);
  const auto width = static_cast<unsigned>(info.width * (blocks.size() / kBlockBytes));
  const std::size_t channels = std::size_t{4} * width * info.height;
  Bytes texels(channels);
  std::vector<float> linear(channels);
  void* slice = is_srgb(code) ? static_cast<void*>(texels.data()) : static_cast<void*>(linear.data());
  astcenc_image image{width, info.height, 1, is_srgb(code) ? ASTCENC_TYPE_U8 : ASTCENC_TYPE_F32, &slice};
  const Context context = context_of(code, ASTCENC_PRE_FASTEST, ASTCENC_FLG_DECOMPRESS_ONLY);
  REQUIRE(astcenc_decompress_image(context.get(), reinterpret_cast<const std::uint8_t*>(blocks.data()),
                                   blocks.size(), &image, &kSame, 0) == ASTCENC_SUCCESS);
  if (is_srgb(code)) return texels;
  const std::array<float, 4> error{1, 0, 1, 1};
  for (std::size_t i = 0; i < channels; ++i) {
    const float value = std::isnan(linear[i]) ? error[i % 4] : linear[i];
    texels[i] = static_cast<std::byte>(std::min(255, static_cast<int>(256 * value)));
  }
  return texels;
}

/// How many blocks of a row differ from the library's, in any bit of any texel.
std::size_t different_blocks(BlockCode code, const Bytes& blocks) {
  const BlockCodeInfo& info = block_code_info(code);
  const Bytes theirs = decoded_by_library(code, blocks);
  const std::size_t count = blocks.size() / kBlockBytes, pitch = std::size_t{4} * info.width * count;
  std::size_t different = 0;
  BlockTexels ours;
  for (std::size_t i = 0; i < count; ++i) {
    decode_block(code, std::span(blocks).subspan(i * kBlockBytes, kBlockBytes), ours);
    bool same = true;
    for (std::size_t y = 0; y < info.height; ++y)
      same = same &&
             std::memcmp(ours.bytes.data() + 4 * y * info.width,
                         theirs.data() + y * pitch + 4 * i * info.width, std::size_t{4} * info.width) == 0;
    if (!same) ++different;
  }
  return different;
}

Bytes chance(RandomSource& random, std::size_t count) {
  Bytes blocks(count * kBlockBytes);
  for (std::byte& b : blocks) b = static_cast<std::byte>(random.bits() >> 8 & 0xff);
  return blocks;
}

/// A block whose fields are put bit by bit.
class Block {
 public:
  Block& put(int at, int count, std::uint64_t value) {
    for (int b = 0; b < count; ++b) {
      std::byte& byte = bytes_[static_cast<std::size_t>(at + b) / 8];
      const auto bit = static_cast<std::byte>(1u << (at + b) % 8);
      byte = (value >> b & 1) != 0 ? byte | bit : byte & ~bit;
    }
    return *this;
  }
  [[nodiscard]] const Bytes& bytes() const { return bytes_; }

 private:
  Bytes bytes_ = Bytes(kBlockBytes);
};

/// One colour, of 16 bits a channel, that holds in all of the texture.
Block one_color(const std::array<std::uint64_t, 4>& channels) {
  Block block;
  block.put(0, 9, 0x1fc).put(10, 2, 3).put(12, 52, ~std::uint64_t{0});
  for (int c = 0; c < 4; ++c) block.put(64 + 16 * c, 16, channels[static_cast<std::size_t>(c)]);
  return block;
}

/// The texels of a block, if all are the same.
std::array<int, 4> only_texel(BlockCode code, const Bytes& block) {
  BlockTexels texels;
  decode_block(code, block, texels);
  for (std::size_t i = 1; i < block_code_info(code).texels(); ++i)
    REQUIRE(std::memcmp(texels.bytes.data() + 4 * i, texels.bytes.data(), 4) == 0);
  std::array<int, 4> texel{};
  for (std::size_t c = 0; c < 4; ++c) texel[c] = static_cast<int>(texels.bytes[c]);
  return texel;
}

/// A picture with an edge, slopes and noise in each channel.
Bytes picture(RandomSource& random, std::uint32_t width, std::uint32_t height) {
  Bytes rgba;
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const bool above = 3 * x + 50 < 5 * y;
      for (const std::uint32_t value : {above ? 200 : 255 * x / width, above ? 40 : 255 * y / height,
                                        128 + (x * y) % 64, x % 23 < 7 ? 90u : 255u})
        rgba.push_back(static_cast<std::byte>((value + (y > height / 2 ? random.bits() % 24 : 0)) & 0xff));
    }
  }
  return rgba;
}

}  // namespace

TEST_CASE("astc: blocks of chance decode to the bits that libastcenc gives, illegal ones among them",
          "[slow]") {
  RandomSource random(1);
  for (const BlockCode code : astc_codes()) {
    INFO(block_code_info(code).name);
    CHECK(different_blocks(code, chance(random, 8000)) == 0);
  }
}

TEST_CASE("astc: legal blocks of every number of partitions, planes and end mode decode as by libastcenc",
          "[slow]") {
  RandomSource random(2);
  for (const BlockCode code : astc_codes()) {
    const BlockCodeInfo& info = block_code_info(code);
    INFO(info.name);
    Bytes legal;
    std::map<std::pair<int, bool>, int> kinds;
    std::array<int, 16> modes{};
    while (legal.size() < 3000 * kBlockBytes) {
      Bytes block = chance(random, 1);
      if (legal.size() / kBlockBytes % 2 == 0) block[1] &= std::byte{0xe7};  // one partition
      const std::optional<AstcHeader> header = astc_header(AstcBits(block), info.width, info.height);
      if (!header) continue;
      ++kinds[{header->partitions, header->two_planes}];
      for (std::size_t p = 0; p < static_cast<std::size_t>(header->partitions); ++p)
        ++modes[static_cast<std::size_t>(header->end_mode[p])];
      legal.insert(legal.end(), block.begin(), block.end());
    }
    CHECK(kinds.size() == 7);  // not four partitions in two planes
    for (const int count : modes) CHECK(count > 5);
    CHECK(different_blocks(code, legal) == 0);
  }
}

TEST_CASE("astc: blocks of one colour with extents of chance decode as by libastcenc") {
  RandomSource random(3);
  for (const BlockCode code : {BlockCode::kAstc4x4Srgb, BlockCode::kAstc6x5Srgb, BlockCode::kAstc12x12Srgb}) {
    Bytes blocks;
    for (int i = 0; i < 4000; ++i) {
      Block block;
      for (int at = 0; at < 128; at += 16) block.put(at, 16, random.bits());
      block.put(0, 9, 0x1fc);
      if (i % 4 != 0) block.put(9, 3, 6);
      if (i % 4 == 2) block.put(12, 52, ~std::uint64_t{0});
      blocks.insert(blocks.end(), block.bytes().begin(), block.bytes().end());
    }
    CHECK(different_blocks(code, blocks) == 0);
  }
}

TEST_CASE("astc: pictures that the encoder compressed decode as by libastcenc", "[slow]") {
  RandomSource random(4);
  for (const BlockCode code : astc_codes()) {
    const BlockCodeInfo& info = block_code_info(code);
    INFO(info.name);
    Bytes texels = picture(random, 96, info.height);
    void* slice = texels.data();
    astcenc_image image{96, info.height, 1, ASTCENC_TYPE_U8, &slice};
    Bytes blocks(kBlockBytes * ((96 + info.width - 1) / info.width));
    const Context context = context_of(code, ASTCENC_PRE_MEDIUM, 0);
    REQUIRE(astcenc_compress_image(context.get(), &image, &kSame,
                                   reinterpret_cast<std::uint8_t*>(blocks.data()), blocks.size(),
                                   0) == ASTCENC_SUCCESS);
    CHECK(different_blocks(code, blocks) == 0);
  }
}

TEST_CASE("astc: a block of one colour has the high eight bits of its channels") {
  const Bytes block = one_color({0x12ff, 0xab00, 0x00ff, 0xffff}).bytes();
  for (const BlockCode code : astc_codes()) CHECK(only_texel(code, block) == std::array{0x12, 0xab, 0, 0xff});
}

TEST_CASE("astc: what is illegal or of high range is magenta") {
  const std::array magenta{255, 0, 255, 255};
  const Block legal = one_color({1, 2, 3, 4});
  const auto with = [&legal](int at, int count, std::uint64_t value) {
    Block block = legal;
    return block.put(at, count, value).bytes();
  };
  CHECK(only_texel(BlockCode::kAstc4x4Srgb, with(9, 1, 1)) == magenta);       // high range
  CHECK(only_texel(BlockCode::kAstc4x4Srgb, with(10, 2, 1)) == magenta);      // reserved
  CHECK(only_texel(BlockCode::kAstc4x4Srgb, with(25, 13, 100)) == magenta);   // ends before it begins
  CHECK(only_texel(BlockCode::kAstc4x4Srgb, Bytes(kBlockBytes)) == magenta);  // a reserved mode
  // 4x4 weights of two bits, one partition, ends of mode 2: luminance of high range.
  CHECK(only_texel(BlockCode::kAstc4x4Srgb, Block().put(0, 11, 0x42).put(13, 4, 2).bytes()) == magenta);
  CHECK(only_texel(BlockCode::kAstc4x4Srgb, Block().put(0, 11, 0x42).put(13, 4, 0).bytes()) != magenta);
  // A grid of 6x10 weights in blocks of 8x5.
  CHECK(only_texel(BlockCode::kAstc8x5Srgb, Block().put(0, 11, 0x184 | 0x10).bytes()) == magenta);
}

TEST_CASE("astc: ends of every range reach 0 and 255 and are all different, and weights 0 and 64") {
  const auto values_of = [](AstcRange range, int (*value)(AstcRange, std::uint8_t)) {
    std::vector<int> values;
    values.reserve(static_cast<std::size_t>(range.base) << range.bits);
    for (int i = 0; i < range.base << range.bits; ++i)
      values.push_back(value(range, static_cast<std::uint8_t>(i)));
    std::ranges::sort(values);
    return values;
  };
  for (const AstcRange range : kAstcEndRanges) {
    const std::vector<int> values = values_of(range, end_value);
    CHECK(values.front() == 0);
    CHECK(values.back() == 255);
    CHECK(std::ranges::adjacent_find(values) == values.end());
  }
  for (const AstcRange range : kAstcWeightRanges) {
    const std::vector<int> values = values_of(range, weight_value);
    CHECK(values.front() == 0);
    CHECK(values.back() == 64);
    CHECK(std::ranges::adjacent_find(values) == values.end());
  }
}

}  // namespace quadrille::models
