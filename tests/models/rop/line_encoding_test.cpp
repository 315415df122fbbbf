/// Encodings of lines: what goes in comes out, whatever it is, and each way is chosen where it should be, at
/// the size that its layout says.
#include "models/rop/line_encoding.h"

#include "models/raster/tile.h"
#include "models/rop/depth_plane.h"
#include "tests/models/random_source.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>
#include <functional>
#include <vector>

using namespace quadrille::models;

namespace {

using Line = std::vector<std::byte>;

constexpr Format kSurfaceFormats[] = {
    Format::kR8Unorm,          Format::kR8G8Unorm,         Format::kR16Float,          Format::kR8G8B8A8Srgb,
    Format::kA2B10G10R10Unorm, Format::kB10G11R11Ufloat,   Format::kR16G16Float,       Format::kR32Float,
    Format::kR32G32Float,      Format::kR16G16B16A16Float, Format::kR32G32B32A32Float, Format::kD16Unorm,
    Format::kD24UnormS8Uint,   Format::kD32Float,          Format::kD32FloatS8Uint};

/// A line whose pixels are what `pixel` says of their places in it.
Line line_of(Format format, const std::function<PixelCode(int x, int y)>& pixel) {
  const std::uint32_t bytes = format_bytes(format);
  Line line(LineCodec(format).line_bytes());
  for (std::size_t i = 0; i < line.size() / bytes; ++i) {
    const auto entry = static_cast<int>(i);
    const PixelCode code = pixel(entry_x(entry), entry_y(entry));
    std::memcpy(line.data() + i * bytes, code.word.data(), bytes);
  }
  return line;
}

EncodedLine encoded(Format format, const Line& line) { return LineCodec(format, true).encode(line); }

void check_round_trip(Format format, const Line& line) {
  for (const bool planes : {false, true}) {
    const LineCodec codec(format, planes);
    const EncodedLine code = codec.encode(line);
    Line back(line.size());
    codec.decode(code, back);
    if (back != line) FAIL(format_info(format).name << " does not come back");
    if (code.encoding != LineEncoding::kPlain && code.sectors() >= line.size() / kSectorBytes)
      FAIL(format_info(format).name << " grew");
    if (code.bits > 8 * line.size()) FAIL(format_info(format).name << " is longer than it was");
  }
}

/// The format's pixel of these codes, each cut to the bits of its component.
PixelCode pixel_of(Format format, const std::function<std::uint32_t(std::size_t component)>& code) {
  const FormatInfo& info = format_info(format);
  PixelCode pixel;
  const auto put = [&](const ComponentBits& bits, std::uint32_t value) {
    const auto mask = static_cast<std::uint32_t>((std::uint64_t{1} << bits.bits) - 1);
    if (bits.bits != 0) pixel.word[bits.shift / 32] |= (value & mask) << bits.shift % 32;
  };
  for (std::size_t c = 0; c < info.component.size(); ++c) put(info.component[c], code(c));
  put(info.stencil, code(info.component.size()));
  return pixel;
}

Line depths(Format format, const std::function<float(int x, int y)>& depth) {
  return line_of(format, [&](int x, int y) { return encode_depth(format, depth(x, y), 3); });
}

constexpr std::uint32_t header(std::uint32_t components, std::uint32_t component_bits) {
  return 1 + component_bits + 6 * components;
}

}  // namespace

TEST_CASE("line_encoding: lines of random bytes come back in every format") {
  RandomSource random(3);
  for (const Format format : kSurfaceFormats) {
    for (int round = 0; round < 200; ++round) {
      Line line(LineCodec(format).line_bytes());
      for (std::byte& byte : line) byte = static_cast<std::byte>(random.bits());
      check_round_trip(format, line);
    }
  }
  SUCCEED();
}

TEST_CASE("line_encoding: lines of any range of codes come back, to the widest") {
  RandomSource random(4);
  for (const Format format : kSurfaceFormats) {
    for (std::uint32_t width = 0; width <= 32; ++width) {
      for (int round = 0; round < 20; ++round) {
        const std::uint32_t base = random.bits();
        const auto mask = static_cast<std::uint32_t>((std::uint64_t{1} << width) - 1);
        check_round_trip(format, line_of(format, [&](int, int) {
                           return pixel_of(format,
                                           [&](std::size_t) { return base + (random.bits() & mask); });
                         }));
      }
    }
  }
  SUCCEED();
}

TEST_CASE("line_encoding: planes of any slope come back, also those that leave the codes' range") {
  RandomSource random(5);
  for (const Format format : kSurfaceFormats) {
    for (int round = 0; round < 500; ++round) {
      const std::uint32_t base = random.bits(), shift = random.bits() % 32;
      const std::uint32_t dx = random.bits() >> shift, dy = random.bits() >> shift;
      check_round_trip(format, line_of(format, [&](int x, int y) {
                         return pixel_of(format, [&](std::size_t c) {
                           const std::uint32_t place =
                               dx * static_cast<unsigned>(x) - dy * static_cast<unsigned>(y);
                           return c == 0 ? base + place + random.bits() % 3 : 7;
                         });
                       }));
    }
  }
  SUCCEED();
}

TEST_CASE("line_encoding: corners of the codes' range at the corners of the line come back") {
  for (const Format format : kSurfaceFormats) {
    for (unsigned corners = 0; corners < 16; ++corners) {
      check_round_trip(format, line_of(format, [&](int x, int y) {
                         const bool high = (corners >> ((x != 0 ? 1 : 0) + (y != 0 ? 2 : 0)) & 1u) != 0;
                         return pixel_of(format, [&](std::size_t) { return high ? 0xffffffffu : 0u; });
                       }));
    }
  }
  SUCCEED();
}

TEST_CASE("line_encoding: bits that no component has keep a line plain") {
  Line line = depths(Format::kD32FloatS8Uint, [](int, int) { return 0.5f; });
  CHECK(encoded(Format::kD32FloatS8Uint, line).encoding == LineEncoding::kOffset);
  line[7] = std::byte{1};  // of the three bytes beside the stencil value
  CHECK(encoded(Format::kD32FloatS8Uint, line).encoding == LineEncoding::kPlain);
  check_round_trip(Format::kD32FloatS8Uint, line);
}

TEST_CASE("line_encoding: pixels that are all alike take a header and one pixel") {
  const auto bits = [](Format format) {
    const EncodedLine code = encoded(format, line_of(format, [&](int, int) {
                                       return pixel_of(format, [](std::size_t) { return 0x5a5a5a5au; });
                                     }));
    CHECK(code.encoding == LineEncoding::kOffset);
    CHECK(code.sectors() == 1);
    return code.bits;
  };
  CHECK(bits(Format::kR8Unorm) == header(1, 8));
  CHECK(bits(Format::kR8G8B8A8Srgb) == header(4, 32));
  CHECK(bits(Format::kR16G16B16A16Float) == header(4, 64));
  CHECK(bits(Format::kR32G32B32A32Float) == header(4, 128));
  CHECK(bits(Format::kD24UnormS8Uint) == header(2, 32));
}

TEST_CASE("line_encoding: offsets take as many bits a pixel as their components' ranges") {
  // Red spans 0..7, green 0..3, blue and alpha are the same everywhere: 5 bits a pixel of 32.
  const EncodedLine ramp =
      encoded(Format::kR8G8B8A8Unorm, line_of(Format::kR8G8B8A8Unorm, [](int x, int y) {
                return PixelCode{{static_cast<std::uint32_t>(100 + x) |
                                  static_cast<std::uint32_t>(50 + y) << 8 | 0xff200000u}};
              }));
  CHECK(ramp.encoding == LineEncoding::kOffset);
  CHECK(ramp.bits == header(4, 32) + 32 * 5);
  CHECK(ramp.sectors() == 1);
  // 8 bits of red a pixel more than fill the first sector.
  const EncodedLine wide = encoded(Format::kR8G8B8A8Unorm, line_of(Format::kR8G8B8A8Unorm, [](int x, int y) {
                                     return PixelCode{{static_cast<std::uint32_t>(32 * x + 8 * y)}};
                                   }));
  CHECK(wide.bits == header(4, 32) + 32 * 8);
  CHECK(wide.sectors() == 2);
}

TEST_CASE("line_encoding: depths of a plane take a quarter of a line, at half and at all of a tile") {
  const auto slanted = [](Format format, float dx, float dy) {
    return encoded(format, depths(format, [&](int x, int y) {
                     return 0.6f + dx * static_cast<float>(x) + dy * static_cast<float>(y);
                   }));
  };
  for (const Format format :
       {Format::kD16Unorm, Format::kD24UnormS8Uint, Format::kD32Float, Format::kD32FloatS8Uint}) {
    INFO(format_info(format).name);
    const EncodedLine code = slanted(format, 0.0151f, -0.0213f);
    CHECK(code.encoding == LineEncoding::kPlane);
    CHECK(code.sectors() == 1);
    CHECK(slanted(format, 0, 0).encoding == LineEncoding::kOffset);  // all alike: no slopes to keep
  }
}

TEST_CASE("line_encoding: a plane's size is its header, its slopes and what it misses by") {
  // Codes 1000 + 64 x + 32 y: in fractions of 6 bits slopes of 4096 and 2048, 14 bits with a sign; no misses.
  const EncodedLine code =
      encoded(Format::kD24UnormS8Uint, line_of(Format::kD24UnormS8Uint, [](int x, int y) {
                return PixelCode{{static_cast<std::uint32_t>(1000 + 64 * x + 32 * y)}};
              }));
  CHECK(code.encoding == LineEncoding::kPlane);
  CHECK(code.bits == header(2, 32) + 6 + 2 * 14);
}

TEST_CASE("line_encoding: planes are tried for depths alone, and only when they are asked for") {
  const Line line = depths(Format::kD32Float, [](int x, int y) {
    return 0.6f + 0.0151f * static_cast<float>(x) - 0.0213f * static_cast<float>(y);
  });
  CHECK(LineCodec(Format::kD32Float, false).encode(line).encoding != LineEncoding::kPlane);
  CHECK(encoded(Format::kR32Float, line).encoding != LineEncoding::kPlane);
}

TEST_CASE("line_encoding: two depths far apart fit neither way, and the line stays as it is") {
  const Line line = depths(Format::kD32Float, [](int x, int y) {
    return (x + y) % 2 == 0 ? 0.1f + 0.001f * static_cast<float>(x) : 0.9f;
  });
  const EncodedLine code = encoded(Format::kD32Float, line);
  CHECK(code.encoding == LineEncoding::kPlain);
  CHECK(code.sectors() == 4);
  CHECK(std::equal(line.begin(), line.end(), code.bytes.begin()));
}
