#include "scenes/image/image_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

#include "models/base/error.h"
#include "scenes/image/image_io.h"

namespace quadrille::scenes {
namespace {

// of a progressive JPEG: each scan may visit every coefficient
constexpr std::uint64_t kMaxPixelPasses = std::uint64_t{1} << 30;
constexpr std::size_t kMaxExrAttributes = 1000;

/// A file read from front to back; every step is checked against its end.
class Reader {
 public:
  Reader(std::span<const std::byte> bytes, const std::string& name, const char* kind)
      : bytes_(bytes), name_(name), kind_(kind) {}

  [[noreturn]] void fail(const std::string& reason) const {
    throw user_error("{}: the {} image {}", name_, kind_, reason);
  }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }
  void skip(std::size_t count) {
    if (count > bytes_.size()) fail("is truncated");
    bytes_ = bytes_.subspan(count);
  }
  [[nodiscard]] unsigned byte(std::size_t at) const {
    return at < bytes_.size() ? std::to_integer<unsigned>(bytes_[at]) : 0;
  }
  [[nodiscard]] std::uint32_t big(std::size_t at, std::size_t size) const {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8 | byte(at + i);
    return value;
  }
  [[nodiscard]] std::uint32_t little(std::size_t at) const {
    return byte(at) | byte(at + 1) << 8 | byte(at + 2) << 16 | byte(at + 3) << 24;
  }
  /// A text that ends in a zero byte, and steps behind it.
  std::string_view text() {
    const std::string_view rest(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
    const std::size_t end = rest.find('\0');
    if (end > 255) fail("is truncated, or has a name of more than 255 bytes");
    skip(end + 1);
    return rest.substr(0, end);
  }
  /// A line of text without its end, and steps behind it.
  std::string line(std::size_t longest) {
    std::string text;
    for (; left() > 0 && byte(0) != '\n'; skip(1)) {
      text += static_cast<char>(byte(0));
      if (text.size() > longest) fail(fmt::format("has a line of more than {} bytes", longest));
    }
    if (left() == 0) fail("is truncated");
    skip(1);
    return text;
  }
  /// A header of these sides, once they are legal.
  [[nodiscard]] ImageHeader sized(ImageFormat format, std::uint64_t width, std::uint64_t height) const {
    if (width == 0 || height == 0 || width > kMaxImageSide || height > kMaxImageSide ||
        width * height > kMaxImagePixels)
      fail(fmt::format("has {}x{} pixels; legal are 1..{} a side and {} in all", width, height, kMaxImageSide,
                       kMaxImagePixels));
    return {format, static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
  }

 private:
  std::span<const std::byte> bytes_;
  const std::string& name_;
  const char* kind_;
};

bool starts_with(std::span<const std::byte> bytes, std::string_view magic) {
  return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

/// Signature, then IHDR, then chunks of a length, a type, data and a checksum, the last one IEND. [PNG
/// #5-chunk-layout]
ImageHeader check_png(Reader file) {
  constexpr std::size_t kSignature = 8, kAround = 12;
  constexpr std::uint32_t kHeader = 0x49484452, kEnd = 0x49454e44;
  file.skip(kSignature);
  if (file.big(4, 4) != kHeader) file.fail("does not begin with its header");
  const ImageHeader header = file.sized(ImageFormat::kPng, file.big(8, 4), file.big(12, 4));
  while (true) {
    if (file.left() < kAround) file.fail("is truncated");
    const std::uint32_t length = file.big(0, 4), type = file.big(4, 4);
    file.skip(kAround);
    file.skip(length);
    if (type == kEnd) return header;
  }
}

/// Markers with lengths; after a scan's header, entropy-coded data up to the next marker. The frame header
/// gives the size. [ITU-T T.81 B.1, B.2]
ImageHeader check_jpeg(Reader file) {
  ImageHeader header;
  std::uint64_t pixels = 0, scans = 0;
  for (file.skip(2); file.left() > 0;) {
    const unsigned marker = file.byte(1);
    // data, fill or a restart
    if (file.byte(0) != 0xff || marker == 0xff || marker < 0xc0 || (marker >= 0xd0 && marker <= 0xd7)) {
      file.skip(1);
      continue;
    }
    if (marker == 0xd9) {
      if (pixels == 0 || scans == 0) file.fail("has no picture");
      return header;
    }
    const bool is_frame =
        marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (is_frame) {
      header = file.sized(ImageFormat::kJpeg, file.big(7, 2), file.big(5, 2));
      pixels = std::uint64_t{header.width} * header.height;
    }
    if (marker == 0xda && ++scans * pixels > kMaxPixelPasses)
      file.fail(fmt::format("has too many scans for {} pixels", pixels));
    file.skip(2);
    file.skip(std::max(2U, file.big(0, 2)));
  }
  file.fail("is truncated");
}

/// Types of EXR attributes whose values have one size; a decoder reads that many bytes, whatever the
/// attribute says. [OpenEXR file layout, #predefined-types]
struct FixedType {
  std::string_view name;
  std::uint32_t bytes;
};
constexpr std::array kFixedTypes{
    FixedType{"box2i", 16},      FixedType{"box2f", 16},   FixedType{"chromaticities", 32},
    FixedType{"compression", 1}, FixedType{"double", 8},   FixedType{"envmap", 1},
    FixedType{"float", 4},       FixedType{"int", 4},      FixedType{"keycode", 28},
    FixedType{"lineOrder", 1},   FixedType{"m33f", 36},    FixedType{"m44f", 64},
    FixedType{"m33d", 72},       FixedType{"m44d", 128},   FixedType{"rational", 8},
    FixedType{"tiledesc", 9},    FixedType{"timecode", 8}, FixedType{"v2i", 8},
    FixedType{"v2f", 8},         FixedType{"v2d", 16},     FixedType{"v3i", 12},
    FixedType{"v3f", 12},        FixedType{"v3d", 24},     FixedType{"deepImageState", 1}};

/// Does the value of `length` bytes that the file is at hold what its type says? Types that nobody knows are
/// read as bytes.
bool holds_its_type(Reader value, std::string_view type, std::uint32_t length) {
  for (const FixedType& fixed : kFixedTypes) {
    if (fixed.name == type) return fixed.bytes == length;
  }
  if (type == "preview")
    return length >= 8 && 8 + std::uint64_t{4} * value.little(0) * value.little(4) == length;
  if (type == "chlist") {  // names with 16 bytes each, and a zero byte
    const std::size_t end = value.left() - length;
    while (value.left() > end && value.byte(0) != 0) {
      (void)value.text();
      if (value.left() < end + 17) return false;
      value.skip(16);
    }
    return value.left() == end + 1;
  }
  if (type != "stringvector") return true;
  for (std::uint64_t at = 0; at < length; at += 4) {
    if (at + 4 > length) return false;
    at += value.little(static_cast<std::size_t>(at));
    if (at + 4 > length) return false;
  }
  return true;
}

struct Box {
  std::array<std::int64_t, 4> v{};
};

/// Magic, version, then attributes: name, type, length, value. Both windows are boxes of corners, ends
/// included. [OpenEXR file layout, #header]
ImageHeader check_exr(Reader file) {
  file.skip(8);
  std::optional<Box> data, display;
  for (std::size_t i = 0; file.byte(0) != 0; ++i) {
    if (i == kMaxExrAttributes) file.fail(fmt::format("has more than {} attributes", kMaxExrAttributes));
    const std::string_view name = file.text();
    const std::string_view type = file.text();
    const std::uint32_t length = file.little(0);
    file.skip(4);
    if (length > file.left()) file.fail("is truncated");
    if (!holds_its_type(file, type, length))
      file.fail(
          fmt::format("has an attribute '{}' that does not hold a {} in its {} bytes", name, type, length));
    if (name == "dataWindow" || name == "displayWindow") {
      Box box;
      for (std::size_t k = 0; k < 4; ++k) box.v[k] = static_cast<std::int32_t>(file.little(4 * k));
      (name == "dataWindow" ? data : display) = box;
    }
    file.skip(length);
  }
  ImageHeader header;
  for (const std::optional<Box>& box : {data, display}) {
    if (!box) file.fail("does not say its size");
    if (box->v[2] < box->v[0] || box->v[3] < box->v[1]) file.fail("has an empty window");
    header = file.sized(ImageFormat::kExr, static_cast<std::uint64_t>(box->v[2] - box->v[0] + 1),
                        static_cast<std::uint64_t>(box->v[3] - box->v[1] + 1));
  }
  return header;
}

/// Lines of text up to an empty one, then the size as in "-Y 512 +X 1024": rows from the top, from the left.
/// Other orders of rows are legal and next to unknown. Rows are of four bytes a pixel, or packed: four bytes,
/// and runs for each of four components. [Radiance]
ImageHeader check_hdr(Reader file) {
  constexpr std::size_t kMaxLines = 100, kMaxLine = 200;
  std::string line = "first";
  for (std::size_t count = 0; !line.empty(); ++count) {
    if (count == kMaxLines) file.fail(fmt::format("has more than {} lines before its size", kMaxLines));
    line = file.line(kMaxLine);
  }
  const std::string size = file.line(kMaxLine);
  std::uint64_t width = 0, height = 0;
  const std::size_t x = size.find(" +X ");
  const auto number = [&](std::size_t begin, std::size_t end, std::uint64_t& value) {
    const auto [at, error] = std::from_chars(size.data() + begin, size.data() + end, value);
    return error == std::errc{} && at == size.data() + end;
  };
  if (!size.starts_with("-Y ") || x == std::string::npos || !number(3, x, height) ||
      !number(x + 4, size.size(), width))
    file.fail("does not say its size as in '-Y 512 +X 1024'");
  const ImageHeader header = file.sized(ImageFormat::kHdr, width, height);
  // A run has up to 127 of a row's values in two bytes.
  if (file.left() < height * std::min(4 * width, 4 + 4 * ((width + 126) / 127) * 2))
    file.fail("is truncated");
  return header;
}

/// RIFF, length, WEBP, then a first chunk: lossy, lossless or extended, each with the size in a place of its
/// own. [RFC 9649]
ImageHeader check_webp(Reader file) {
  constexpr std::uint32_t kLossy = 0x56503820, kLossless = 0x5650384c, kExtended = 0x56503858;
  if (file.left() < 30 || file.little(4) > file.left() - 8) file.fail("is truncated");
  switch (file.big(12, 4)) {
    case kLossy: return file.sized(ImageFormat::kWebp, file.little(26) & 0x3fff, file.little(28) & 0x3fff);
    case kLossless:
      return file.sized(ImageFormat::kWebp, (file.little(21) & 0x3fff) + 1,
                        (file.little(21) >> 14 & 0x3fff) + 1);
    case kExtended:
      return file.sized(ImageFormat::kWebp, (file.little(24) & 0xffffff) + 1,
                        (file.little(27) & 0xffffff) + 1);
    default: file.fail("begins with a chunk that is none of its picture");
  }
}

/// 128 bytes of header; the first level follows, as blocks of 4x4 or as pixels. OpenImageIO fills a truncated
/// one with what it has. [DDS]
ImageHeader check_dds(Reader file) {
  constexpr std::size_t kHeaderBytes = 128;
  if (file.left() < kHeaderBytes) file.fail("is truncated");
  const ImageHeader header = file.sized(ImageFormat::kDds, file.little(16), file.little(12));
  const std::uint32_t code = file.big(84, 4), bits = file.little(88), family = code >> 8;
  // DXT., ATI., BC..
  const bool blocks = family == 0x445854 || family == 0x415449 || code >> 16 == 0x4243;
  // DXT1, ATI1, BC4.
  const std::uint64_t block_bytes = code == 0x44585431 || code == 0x41544931 || family == 0x424334 ? 8 : 16;
  if (!blocks && bits > 128) file.fail(fmt::format("has {} bits a pixel; legal are up to 128", bits));
  const std::uint64_t width = header.width, height = header.height;
  const std::uint64_t data =
      blocks ? (width + 3) / 4 * ((height + 3) / 4) * block_bytes : width * height * bits / 8;
  if (file.left() - kHeaderBytes < data) file.fail("is truncated");
  return header;
}

}  // namespace

ImageHeader check_image_header(std::span<const std::byte> bytes, const std::string& name) {
  if (starts_with(bytes, "\x89PNG")) return check_png({bytes, name, "PNG"});
  if (starts_with(bytes, "\xff\xd8\xff")) return check_jpeg({bytes, name, "JPEG"});
  if (starts_with(bytes, "\x76\x2f\x31\x01")) return check_exr({bytes, name, "EXR"});
  if (starts_with(bytes, "RIFF") &&
      starts_with(bytes.subspan(std::min<std::size_t>(8, bytes.size())), "WEBP"))
    return check_webp({bytes, name, "WebP"});
  if (starts_with(bytes, "DDS ")) return check_dds({bytes, name, "DDS"});
  if (starts_with(bytes, "#?RADIANCE") || starts_with(bytes, "#?RGBE"))
    return check_hdr({bytes, name, "HDR"});
  if (starts_with(bytes, "\xabKTX "))
    throw user_error("{}: a KTX image; PNG, JPEG, WebP, DDS, EXR and HDR are read", name);
  throw user_error("{}: not a PNG, JPEG, WebP, DDS, EXR or HDR image (by its first bytes)", name);
}

const char* format_extension(ImageFormat format) {
  switch (format) {
    case ImageFormat::kPng: return "png";
    case ImageFormat::kJpeg: return "jpg";
    case ImageFormat::kWebp: return "webp";
    case ImageFormat::kDds: return "dds";
    case ImageFormat::kExr: return "exr";
    case ImageFormat::kHdr: return "hdr";
  }
  return "";
}

}  // namespace quadrille::scenes
