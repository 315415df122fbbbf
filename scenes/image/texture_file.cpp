#include "scenes/image/texture_file.h"

#include <zstd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "models/base/error.h"
#include "models/rop/blend.h"
#include "scenes/image/image_io.h"

namespace quadrille::scenes {
namespace {

using traces::Format;

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

struct Named {
  std::uint32_t number;
  Format format;
};
/// VkFormat. [VK1.3 #formats-definition]
constexpr std::array<Named, 21> kVulkan{
    {{9, Format::kR8Unorm},       {16, Format::kR8G8Unorm},         {37, Format::kR8G8B8A8Unorm},
     {43, Format::kR8G8B8A8Srgb}, {97, Format::kR16G16B16A16Float}, {131, Format::kBc1RgbUnorm},
     {132, Format::kBc1RgbSrgb},  {133, Format::kBc1RgbaUnorm},     {134, Format::kBc1RgbaSrgb},
     {135, Format::kBc2Unorm},    {136, Format::kBc2Srgb},          {137, Format::kBc3Unorm},
     {138, Format::kBc3Srgb},     {139, Format::kBc4Unorm},         {140, Format::kBc4Snorm},
     {141, Format::kBc5Unorm},    {142, Format::kBc5Snorm},         {143, Format::kBc6hUfloat},
     {144, Format::kBc6hSfloat},  {145, Format::kBc7Unorm},         {146, Format::kBc7Srgb}}};
/// DXGI_FORMAT of blocks. [DDS]
constexpr std::array<Named, 14> kDxgi{{{71, Format::kBc1RgbaUnorm},
                                       {72, Format::kBc1RgbaSrgb},
                                       {74, Format::kBc2Unorm},
                                       {75, Format::kBc2Srgb},
                                       {77, Format::kBc3Unorm},
                                       {78, Format::kBc3Srgb},
                                       {80, Format::kBc4Unorm},
                                       {81, Format::kBc4Snorm},
                                       {83, Format::kBc5Unorm},
                                       {84, Format::kBc5Snorm},
                                       {95, Format::kBc6hUfloat},
                                       {96, Format::kBc6hSfloat},
                                       {98, Format::kBc7Unorm},
                                       {99, Format::kBc7Srgb}}};

constexpr std::uint32_t four_cc(const char (&text)[5]) {
  std::uint32_t code = 0;
  for (int i = 3; i >= 0; --i) code = code << 8 | static_cast<std::uint8_t>(text[i]);
  return code;
}
/// Codes of DDS files from before DXGI. DXT2 and DXT4 say that colours are multiplied by alpha, which is for
/// the shader to know.
constexpr std::array<Named, 11> kFourCc{{{four_cc("DXT1"), Format::kBc1RgbaUnorm},
                                         {four_cc("DXT2"), Format::kBc2Unorm},
                                         {four_cc("DXT3"), Format::kBc2Unorm},
                                         {four_cc("DXT4"), Format::kBc3Unorm},
                                         {four_cc("DXT5"), Format::kBc3Unorm},
                                         {four_cc("ATI1"), Format::kBc4Unorm},
                                         {four_cc("BC4U"), Format::kBc4Unorm},
                                         {four_cc("BC4S"), Format::kBc4Snorm},
                                         {four_cc("ATI2"), Format::kBc5Unorm},
                                         {four_cc("BC5U"), Format::kBc5Unorm},
                                         {four_cc("BC5S"), Format::kBc5Snorm}}};

Format named(std::span<const Named> names, std::uint32_t number) {
  for (const Named& name : names)
    if (name.number == number) return name.format;
  return Format::kUndefined;
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

std::uint64_t level_bytes(const TextureFile& texture, std::uint32_t level) {
  return models::format_area_bytes(texture.format, std::max(1u, texture.width >> level),
                                   std::max(1u, texture.height >> level));
}

// DDS.
constexpr std::size_t kDdsHeader = 128, kDx10Header = 20;
constexpr std::uint32_t kCubeOrVolume = 0x200200;  ///< of the second word of caps

/// kUndefined: no blocks. `header` is where the levels begin.
Format dds_format(const Fields& file, std::size_t& header) {
  constexpr std::uint32_t kHasFourCc = 4;
  header = kDdsHeader;
  if ((file.word(80) & kHasFourCc) == 0) return Format::kUndefined;
  if (file.word(84) != four_cc("DX10")) return named(kFourCc, file.word(84));
  header += kDx10Header;
  constexpr std::uint32_t kTwoDimensions = 3, kCube = 4;
  const bool one_picture =
      file.word(132) == kTwoDimensions && (file.word(136) & kCube) == 0 && file.word(140) <= 1;
  return one_picture ? named(kDxgi, file.word(128)) : Format::kUndefined;
}

TextureFile read_dds(std::span<const std::byte> bytes, const Fields& file) {
  TextureFile texture;
  std::size_t header = 0;
  texture.format = dds_format(file, header);
  texture.height = file.word(12);
  texture.width = file.word(16);
  texture.levels = file.word(28);
  check_size(file, texture);
  std::uint64_t needed = 0;
  for (std::uint32_t level = 0; level < texture.levels; ++level) needed += level_bytes(texture, level);
  if (bytes.size() - header < needed)
    file.fail(fmt::format("has {} bytes of levels where {} are due", bytes.size() - header, needed));
  const auto levels = bytes.subspan(header, needed);
  texture.texels.assign(levels.begin(), levels.end());
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
  texture.format = named(kVulkan, file.word(12));
  if (texture.format == Format::kUndefined)
    file.fail(
        fmt::format("has VkFormat {}; supported are R8, R8G8, R8G8B8A8, R16G16B16A16_SFLOAT and BC1 to "
                    "BC7",
                    file.word(12)));
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
    const std::size_t at = texture.texels.size();
    if (!packed) {
      texture.texels.insert(texture.texels.end(), stored.begin(), stored.end());
      continue;
    }
    texture.texels.resize(at + due);
    const std::size_t made = ZSTD_decompress(texture.texels.data() + at, due, stored.data(), stored.size());
    if (ZSTD_isError(made) != 0 || made != due)
      file.fail(fmt::format("level {} cannot be unpacked by Zstandard", level));
  }
  return texture;
}

bool is_ktx2(std::span<const std::byte> bytes) {
  return bytes.size() >= kKtx2.size() && std::memcmp(bytes.data(), kKtx2.data(), kKtx2.size()) == 0;
}

}  // namespace

bool is_texture_file(std::span<const std::byte> bytes) {
  if (is_ktx2(bytes)) return true;
  if (bytes.size() < kDdsHeader + kDx10Header || std::memcmp(bytes.data(), "DDS ", 4) != 0) return false;
  const std::string nameless;
  const Fields file(bytes, nameless);
  std::size_t header = 0;
  return dds_format(file, header) != Format::kUndefined && file.word(28) > 1 &&
         (file.word(112) & kCubeOrVolume) == 0;
}

TextureFile read_texture_file(std::span<const std::byte> bytes, const std::string& name) {
  QUADRILLE_CHECK(is_texture_file(bytes), "{} is no texture file", name);
  const Fields file(bytes, name);
  return is_ktx2(bytes) ? read_ktx2(file) : read_dds(bytes, file);
}

Rgba8Image finest_level(const TextureFile& file) {
  traces::Image image;
  image.format = file.format;
  image.width = file.width;
  image.height = file.height;
  image.texels.assign(file.texels.begin(),
                      file.texels.begin() + static_cast<std::ptrdiff_t>(level_bytes(file, 0)));
  image = traces::decompressed(image);
  Rgba8Image picture{file.width, file.height, {}};
  const std::size_t bytes = models::format_bytes(image.format);
  const Format shown = models::is_srgb_format(image.format) ? Format::kR8G8B8A8Unorm : image.format;
  for (std::size_t at = 0; at < image.texels.size(); at += bytes) {
    models::PixelCode code;
    std::memcpy(code.word.data(), image.texels.data() + at, bytes);
    for (const float value : models::decode_color(shown, code))
      picture.pixels.push_back(
          static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0f, 1.0f) * 255.0f)));
  }
  return picture;
}

traces::Format with_encoding(Format format, bool srgb) {
  constexpr std::array<std::array<Format, 2>, 7> kTwins{{{Format::kR8Unorm, Format::kR8Srgb},
                                                         {Format::kR8G8B8A8Unorm, Format::kR8G8B8A8Srgb},
                                                         {Format::kBc1RgbUnorm, Format::kBc1RgbSrgb},
                                                         {Format::kBc1RgbaUnorm, Format::kBc1RgbaSrgb},
                                                         {Format::kBc2Unorm, Format::kBc2Srgb},
                                                         {Format::kBc3Unorm, Format::kBc3Srgb},
                                                         {Format::kBc7Unorm, Format::kBc7Srgb}}};
  for (const auto& twins : kTwins)
    if (twins[0] == format || twins[1] == format) return twins[srgb ? 1 : 0];
  return format;
}

}  // namespace quadrille::scenes
