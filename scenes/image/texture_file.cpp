#include "scenes/image/texture_file.h"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "models/base/error.h"
#include "scenes/image/image_io.h"

namespace quadrille::scenes {
namespace {

constexpr std::array<std::uint8_t, 12> kKtx2{0xab, 'K',  'T',  'X',  ' ',  '2',
                                             '0',  0xbb, '\r', '\n', 0x1a, '\n'};

/// Little-endian fields of a file; what lies beyond its end is an error.
class Fields {
 public:
  Fields(std::span<const std::byte> bytes, const std::string& name) : bytes_(bytes), name_(name) {}
  [[noreturn]] void fail(const std::string& reason) const { throw user_error("{}: {}", name_, reason); }
  [[nodiscard]] std::uint64_t at(std::size_t offset, std::size_t count) const {
    if (offset > bytes_.size() || count > bytes_.size() - offset) fail("is truncated");
    std::uint64_t value = 0;
    std::memcpy(&value, bytes_.data() + offset, count);
    return value;
  }
  [[nodiscard]] std::uint32_t word(std::size_t offset) const {
    return static_cast<std::uint32_t>(at(offset, 4));
  }
  [[nodiscard]] std::span<const std::byte> part(std::uint64_t offset, std::uint64_t count,
                                                std::uint32_t level) const {
    if (offset > bytes_.size() || count > bytes_.size() - offset)
      fail(fmt::format("level {} lies beyond the end of the file", level));
    return bytes_.subspan(offset, count);
  }

 private:
  std::span<const std::byte> bytes_;
  const std::string& name_;
};

using models::BlockCode;

struct Named {
  std::uint32_t number;
  BlockCode code;
};
/// VkFormat; UNORM and sRGB are alike here, since glTF says by a texture's role which it is. (Blocks of ASTC
/// round as their own format says.) [VK1.3
/// #formats-definition]
constexpr std::uint32_t kRgba8Unorm = 37, kRgba8Srgb = 43;
constexpr std::array<Named, 54> kVulkan{{{131, BlockCode::kBc1Rgb},
                                         {132, BlockCode::kBc1Rgb},
                                         {133, BlockCode::kBc1Rgba},
                                         {134, BlockCode::kBc1Rgba},
                                         {135, BlockCode::kBc2},
                                         {136, BlockCode::kBc2},
                                         {137, BlockCode::kBc3},
                                         {138, BlockCode::kBc3},
                                         {139, BlockCode::kBc4Unorm},
                                         {140, BlockCode::kBc4Snorm},
                                         {141, BlockCode::kBc5Unorm},
                                         {142, BlockCode::kBc5Snorm},
                                         {143, BlockCode::kBc6hUfloat},
                                         {144, BlockCode::kBc6hSfloat},
                                         {145, BlockCode::kBc7},
                                         {146, BlockCode::kBc7},
                                         {147, BlockCode::kEtc2Rgb8},
                                         {148, BlockCode::kEtc2Rgb8},
                                         {149, BlockCode::kEtc2Rgb8A1},
                                         {150, BlockCode::kEtc2Rgb8A1},
                                         {151, BlockCode::kEtc2Rgba8},
                                         {152, BlockCode::kEtc2Rgba8},
                                         {153, BlockCode::kEacR11Unorm},
                                         {154, BlockCode::kEacR11Snorm},
                                         {155, BlockCode::kEacR11G11Unorm},
                                         {156, BlockCode::kEacR11G11Snorm},
                                         {157, BlockCode::kAstc4x4Unorm},
                                         {158, BlockCode::kAstc4x4Srgb},
                                         {159, BlockCode::kAstc5x4Unorm},
                                         {160, BlockCode::kAstc5x4Srgb},
                                         {161, BlockCode::kAstc5x5Unorm},
                                         {162, BlockCode::kAstc5x5Srgb},
                                         {163, BlockCode::kAstc6x5Unorm},
                                         {164, BlockCode::kAstc6x5Srgb},
                                         {165, BlockCode::kAstc6x6Unorm},
                                         {166, BlockCode::kAstc6x6Srgb},
                                         {167, BlockCode::kAstc8x5Unorm},
                                         {168, BlockCode::kAstc8x5Srgb},
                                         {169, BlockCode::kAstc8x6Unorm},
                                         {170, BlockCode::kAstc8x6Srgb},
                                         {171, BlockCode::kAstc8x8Unorm},
                                         {172, BlockCode::kAstc8x8Srgb},
                                         {173, BlockCode::kAstc10x5Unorm},
                                         {174, BlockCode::kAstc10x5Srgb},
                                         {175, BlockCode::kAstc10x6Unorm},
                                         {176, BlockCode::kAstc10x6Srgb},
                                         {177, BlockCode::kAstc10x8Unorm},
                                         {178, BlockCode::kAstc10x8Srgb},
                                         {179, BlockCode::kAstc10x10Unorm},
                                         {180, BlockCode::kAstc10x10Srgb},
                                         {181, BlockCode::kAstc12x10Unorm},
                                         {182, BlockCode::kAstc12x10Srgb},
                                         {183, BlockCode::kAstc12x12Unorm},
                                         {184, BlockCode::kAstc12x12Srgb}}};
/// DXGI_FORMAT of blocks. [DDS]
constexpr std::array<Named, 14> kDxgi{{{71, BlockCode::kBc1Rgba},
                                       {72, BlockCode::kBc1Rgba},
                                       {74, BlockCode::kBc2},
                                       {75, BlockCode::kBc2},
                                       {77, BlockCode::kBc3},
                                       {78, BlockCode::kBc3},
                                       {80, BlockCode::kBc4Unorm},
                                       {81, BlockCode::kBc4Snorm},
                                       {83, BlockCode::kBc5Unorm},
                                       {84, BlockCode::kBc5Snorm},
                                       {95, BlockCode::kBc6hUfloat},
                                       {96, BlockCode::kBc6hSfloat},
                                       {98, BlockCode::kBc7},
                                       {99, BlockCode::kBc7}}};

constexpr std::uint32_t four_cc(const char (&text)[5]) {
  std::uint32_t code = 0;
  for (int i = 3; i >= 0; --i) code = code << 8 | static_cast<std::uint8_t>(text[i]);
  return code;
}
/// Codes of DDS files from before DXGI. DXT2 and DXT4 say that colours are multiplied by alpha, which is for
/// the shader to know. [DDS]
constexpr std::array<Named, 11> kFourCc{{{four_cc("DXT1"), BlockCode::kBc1Rgba},
                                         {four_cc("DXT2"), BlockCode::kBc2},
                                         {four_cc("DXT3"), BlockCode::kBc2},
                                         {four_cc("DXT4"), BlockCode::kBc3},
                                         {four_cc("DXT5"), BlockCode::kBc3},
                                         {four_cc("ATI1"), BlockCode::kBc4Unorm},
                                         {four_cc("BC4U"), BlockCode::kBc4Unorm},
                                         {four_cc("BC4S"), BlockCode::kBc4Snorm},
                                         {four_cc("ATI2"), BlockCode::kBc5Unorm},
                                         {four_cc("BC5U"), BlockCode::kBc5Unorm},
                                         {four_cc("BC5S"), BlockCode::kBc5Snorm}}};

std::optional<BlockCode> named(std::span<const Named> names, std::uint32_t number) {
  for (const Named& name : names)
    if (name.number == number) return name.code;
  return std::nullopt;
}

void check_size(const Fields& file, const TextureFile& texture) {
  const std::uint32_t w = texture.width, h = texture.height;
  if (w == 0 || h == 0 || w > kMaxImageSide || h > kMaxImageSide || std::uint64_t{w} * h > kMaxImagePixels)
    file.fail(fmt::format("is {}x{}; legal are 1x1 to {}x{}, and {} pixels in all", w, h, kMaxImageSide,
                          kMaxImageSide, kMaxImagePixels));
  const auto most = static_cast<std::uint32_t>(std::bit_width(std::max(w, h)));
  if (texture.levels < 1 || texture.levels > most)
    file.fail(fmt::format("has {} levels; {}x{} allows 1 to {}", texture.levels, w, h, most));
}

struct Extent {
  std::uint32_t width, height;
};
Extent level_extent(const TextureFile& texture, std::uint32_t level) {
  return {std::max(1u, texture.width >> level), std::max(1u, texture.height >> level)};
}

std::uint64_t level_bytes(const TextureFile& texture, std::uint32_t level) {
  const auto [width, height] = level_extent(texture, level);
  if (!texture.code) return std::uint64_t{4} * width * height;
  const models::BlockCodeInfo& info = models::block_code_info(*texture.code);
  return std::uint64_t{info.bytes} * ((width + info.width - 1) / info.width) *
         ((height + info.height - 1) / info.height);
}

// DDS.
constexpr std::size_t kDdsHeader = 128, kDx10Header = 20;
constexpr std::uint32_t kCubeOrVolume = 0x200200;  ///< of the second word of caps

/// None: no blocks. `header` is where the levels begin.
std::optional<BlockCode> dds_code(const Fields& file, std::size_t& header) {
  constexpr std::uint32_t kHasFourCc = 4;
  header = kDdsHeader;
  if ((file.word(80) & kHasFourCc) == 0) return std::nullopt;
  if (file.word(84) != four_cc("DX10")) return named(kFourCc, file.word(84));
  header += kDx10Header;
  constexpr std::uint32_t kTwoDimensions = 3, kCube = 4;
  const bool one_picture =
      file.word(132) == kTwoDimensions && (file.word(136) & kCube) == 0 && file.word(140) <= 1;
  return one_picture ? named(kDxgi, file.word(128)) : std::nullopt;
}

TextureFile read_dds(std::span<const std::byte> bytes, const Fields& file) {
  TextureFile texture;
  std::size_t header = 0;
  texture.code = dds_code(file, header);
  texture.height = file.word(12);
  texture.width = file.word(16);
  texture.levels = file.word(28);
  check_size(file, texture);
  std::uint64_t needed = 0;
  for (std::uint32_t level = 0; level < texture.levels; ++level) needed += level_bytes(texture, level);
  if (bytes.size() - header < needed)
    file.fail(fmt::format("has {} bytes of levels where {} are due", bytes.size() - header, needed));
  const auto levels = bytes.subspan(header, needed);
  texture.bytes.assign(levels.begin(), levels.end());
  return texture;
}

// KTX2.
enum Supercompression : std::uint32_t { kPlain, kBasisLz, kZstandard, kZlib };
constexpr std::size_t kKtxHeader = 80, kLevelEntry = 24;

/// The colour model of the data format descriptor, which tells Basis Universal apart.
void refuse_basis(const Fields& file, std::uint32_t scheme) {
  constexpr std::uint32_t kEtc1s = 163, kUastc = 166;
  const std::uint32_t descriptor = file.word(48);
  const std::uint32_t model =
      descriptor == 0 ? 0 : static_cast<std::uint32_t>(file.at(std::size_t{descriptor} + 12, 1));
  if (scheme == kBasisLz || model == kEtc1s)
    file.fail("holds BasisLZ, which is not supported: Basis Universal has to be transcoded");
  if (model == kUastc) file.fail("holds UASTC, which is not supported: Basis Universal has to be transcoded");
}

TextureFile ktx_header(const Fields& file) {
  const std::uint32_t scheme = file.word(44);
  refuse_basis(file, scheme);
  if (scheme != kPlain && scheme != kZstandard)
    file.fail(scheme == kZlib
                  ? std::string("is compressed by ZLIB; nothing and Zstandard are supported")
                  : fmt::format("has supercompression scheme {}; 0 and 2 (Zstandard) are supported", scheme));
  TextureFile texture;
  const std::uint32_t format = file.word(12);
  texture.code = named(kVulkan, format);
  if (!texture.code && format != kRgba8Unorm && format != kRgba8Srgb)
    file.fail(
        fmt::format("has VkFormat {}; R8G8B8A8 ({} and {}) and BC1 to BC7, ETC2, EAC and ASTC of 8 bits "
                    "({} to {}) are supported",
                    format, kRgba8Unorm, kRgba8Srgb, kVulkan.front().number, kVulkan.back().number));
  texture.width = file.word(20);
  texture.height = file.word(24);
  texture.levels = std::max(1u, file.word(40));
  if (file.word(28) != 0 || file.word(32) != 0 || file.word(36) != 1)
    file.fail(fmt::format("has depth {}, {} layers and {} faces; one picture of two dimensions is supported",
                          file.word(28), file.word(32), file.word(36)));
  check_size(file, texture);
  return texture;
}

TextureFile read_ktx2(const Fields& file) {
  TextureFile texture = ktx_header(file);
  const bool packed = file.word(44) == kZstandard;
  for (std::uint32_t level = 0; level < texture.levels; ++level) {
    const std::size_t entry = kKtxHeader + kLevelEntry * level;
    const std::uint64_t due = level_bytes(texture, level), unpacked = file.at(entry + 16, 8);
    const auto stored = file.part(file.at(entry, 8), file.at(entry + 8, 8), level);
    if (unpacked != due || (!packed && stored.size() != due))
      file.fail(fmt::format("level {} has {} bytes where {} are due", level,
                            packed ? unpacked : std::uint64_t{stored.size()}, due));
    const std::size_t at = texture.bytes.size();
    if (!packed) {
      texture.bytes.insert(texture.bytes.end(), stored.begin(), stored.end());
      continue;
    }
    texture.bytes.resize(at + due);
    const std::size_t made = ZSTD_decompress(texture.bytes.data() + at, due, stored.data(), stored.size());
    if (ZSTD_isError(made) != 0 || made != due)
      file.fail(fmt::format("level {} cannot be unpacked by Zstandard", level));
  }
  return texture;
}

bool is_ktx2(std::span<const std::byte> bytes) {
  return bytes.size() >= kKtx2.size() && std::memcmp(bytes.data(), kKtx2.data(), kKtx2.size()) == 0;
}

/// A half of 0..1, and what lies beyond, in 255ths, rounded to nearest.
std::uint8_t eight_bits_of_half(const std::byte* at) {
  std::uint16_t half = 0;
  std::memcpy(&half, at, sizeof half);
  constexpr std::uint16_t kOne = 0x3c00, kSign = 0x8000;
  if ((half & kSign) != 0) return 0;
  if (half >= kOne) return 255;
  const int exponent = half >> 10, fraction = half & 1023;
  const double value = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  return static_cast<std::uint8_t>(std::lround(255 * value));
}

/// A channel of EAC in 255ths, rounded to nearest; one below 0 is 0.
std::uint8_t eight_bits_of_sixteen(BlockCode code, const std::byte* at) {
  std::uint16_t bits = 0;
  std::memcpy(&bits, at, sizeof bits);
  if (code == BlockCode::kEacR11Unorm || code == BlockCode::kEacR11G11Unorm)
    return static_cast<std::uint8_t>((bits * 255u + 32767) / 65535);
  return static_cast<std::uint8_t>((std::max(0, int{static_cast<std::int16_t>(bits)}) * 255 + 16383) / 32767);
}

/// A texel of a decoded block.
std::array<std::uint8_t, 4> eight_bits(BlockCode code, const models::BlockTexels& block, std::size_t texel) {
  const models::BlockCodeInfo& info = models::block_code_info(code);
  const std::byte* const at = block.bytes.data() + texel * info.decoded_bytes;
  const bool is_signed = code == BlockCode::kBc4Snorm || code == BlockCode::kBc5Snorm;
  const bool halves = info.decoded == models::DecodedTexels::kRgba16f,
             wide =
                 info.decoded == models::DecodedTexels::kR16 || info.decoded == models::DecodedTexels::kRg16;
  std::array<std::uint8_t, 4> rgba{0, 0, 0, 255};
  const std::size_t channels = halves || wide ? info.decoded_bytes / 2 : info.decoded_bytes;
  for (std::size_t c = 0; c < channels; ++c) {
    const auto value = static_cast<std::uint8_t>(at[c]);
    if (halves) rgba[c] = eight_bits_of_half(at + 2 * c);
    else if (wide) rgba[c] = eight_bits_of_sixteen(code, at + 2 * c);
    else if (is_signed)
      rgba[c] =
          static_cast<std::uint8_t>((std::max(0, int{static_cast<std::int8_t>(value)}) * 255 + 63) / 127);
    else rgba[c] = value;
  }
  return rgba;
}

}  // namespace

bool is_texture_file(std::span<const std::byte> bytes) {
  if (is_ktx2(bytes)) return true;
  if (bytes.size() < kDdsHeader + kDx10Header || std::memcmp(bytes.data(), "DDS ", 4) != 0) return false;
  const std::string nameless;
  const Fields file(bytes, nameless);
  std::size_t header = 0;
  return dds_code(file, header) && file.word(28) > 1 && (file.word(112) & kCubeOrVolume) == 0;
}

TextureFile read_texture_file(std::span<const std::byte> bytes, const std::string& name) {
  QUADRILLE_CHECK(is_texture_file(bytes), "{} is no texture file", name);
  const Fields file(bytes, name);
  return is_ktx2(bytes) ? read_ktx2(file) : read_dds(bytes, file);
}

std::span<const std::byte> stored_level(const TextureFile& file, std::uint32_t level) {
  std::uint64_t at = 0;
  for (std::uint32_t l = 0; l < level; ++l) at += level_bytes(file, l);
  return std::span(file.bytes).subspan(at, level_bytes(file, level));
}

Rgba8Image decoded_level(const TextureFile& file, std::uint32_t level) {
  const auto [width, height] = level_extent(file, level);
  std::span<const std::byte> rest = stored_level(file, level);
  Rgba8Image picture{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height)};
  if (!file.code) {
    std::memcpy(picture.pixels.data(), rest.data(), rest.size());
    return picture;
  }
  const models::BlockCodeInfo& info = models::block_code_info(*file.code);
  models::BlockTexels block;
  for (std::uint32_t y = 0; y < height; y += info.height) {
    for (std::uint32_t x = 0; x < width; x += info.width) {
      models::decode_block(*file.code, rest.first(info.bytes), block);
      rest = rest.subspan(info.bytes);
      for (std::uint32_t i = 0; i < info.texels(); ++i) {
        const std::uint32_t column = x + i % info.width, row = y + i / info.width;
        if (column >= width || row >= height) continue;
        const std::array<std::uint8_t, 4> rgba = eight_bits(*file.code, block, i);
        std::memcpy(&picture.pixels[4 * (std::size_t{row} * width + column)], rgba.data(), rgba.size());
      }
    }
  }
  return picture;
}

}  // namespace quadrille::scenes
