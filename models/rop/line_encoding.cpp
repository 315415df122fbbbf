#include "models/rop/line_encoding.h"

#include "models/base/error.h"
#include "models/raster/tile.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace quadrille::models {
namespace {

constexpr std::uint32_t kSlopeBits = 6;  ///< of a slope's fraction: over a line it is off by less than a code
constexpr std::uint32_t kWidthBits = 6;  ///< of a width in the header
constexpr std::uint32_t kHeaderBits = 1;  ///< is it a plane?

/// Numbers of up to 63 bits, one behind the other, from the low end of each byte on.
class BitWriter {
 public:
  explicit BitWriter(std::span<std::byte> bytes) : bytes_(bytes) {}
  void put(std::uint64_t value, std::uint32_t width) {
    for (std::uint32_t done = 0; done < width;) {
      const std::uint32_t at = bits_ % 8, now = std::min(8 - at, width - done);
      const std::uint64_t part = value >> done & ((1u << now) - 1);
      bytes_[bits_ / 8] |= static_cast<std::byte>(part << at);
      done += now;
      bits_ += now;
    }
  }
  [[nodiscard]] std::uint32_t bits() const { return bits_; }

 private:
  std::span<std::byte> bytes_;
  std::uint32_t bits_ = 0;
};

class BitReader {
 public:
  explicit BitReader(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::uint64_t take(std::uint32_t width) {
    std::uint64_t value = 0;
    for (std::uint32_t done = 0; done < width;) {
      const std::uint32_t at = bits_ % 8, now = std::min(8 - at, width - done);
      const auto byte = std::to_integer<std::uint64_t>(bytes_[bits_ / 8]);
      value |= (byte >> at & ((1u << now) - 1)) << done;
      done += now;
      bits_ += now;
    }
    return value;
  }
  std::int64_t take_signed(std::uint32_t width) {
    const std::uint64_t value = take(width);
    const bool negative = width > 0 && (value >> (width - 1) & 1u) != 0;
    return static_cast<std::int64_t>(negative ? value | ~std::uint64_t{0} << width : value);
  }

 private:
  std::span<const std::byte> bytes_;
  std::uint32_t bits_ = 0;
};

std::int64_t rounded_quotient(std::int64_t value, std::int64_t divisor) {
  return (value >= 0 ? value + divisor / 2 : value - divisor / 2) / divisor;
}

/// Of two's complement.
std::uint32_t signed_width(std::int64_t value) {
  const auto magnitude = static_cast<std::uint64_t>(value < 0 ? ~value : value);
  return value == 0 ? 0 : static_cast<std::uint32_t>(std::bit_width(magnitude)) + 1;
}

std::uint32_t mask_of(const ComponentBits& component) {
  return static_cast<std::uint32_t>((std::uint64_t{1} << component.bits) - 1);
}

PixelCode pixel_at(std::span<const std::byte> line, std::size_t pixel, std::size_t bytes) {
  PixelCode code;
  std::memcpy(code.word.data(), line.data() + pixel * bytes, bytes);
  return code;
}

}  // namespace

LineCodec::LineCodec(Format format, bool planes)
    : pixel_bytes_(format_bytes(format)),
      pixels_(std::min<std::uint32_t>(kMaxPixels, kLineBytes / pixel_bytes_)),
      planes_(planes && format_info(format).may(kDepthUse)) {
  for (const ComponentBits& component : format_info(format).component) add(component);
  add(format_info(format).stencil);
}

void LineCodec::add(const ComponentBits& component) {
  if (component.bits != 0) component_[components_++] = component;
}

std::int64_t LineCodec::Slope::at(std::size_t pixel) const {
  const auto entry = static_cast<int>(pixel);
  return (x * entry_x(entry) + y * entry_y(entry)) >> kSlopeBits;
}

std::uint32_t LineCodec::Slope::width() const { return std::max(signed_width(x), signed_width(y)); }

LineCodec::Codes LineCodec::codes_of(std::span<const std::byte> line, std::size_t component) const {
  const ComponentBits& bits = component_[component];
  Codes codes{};
  for (std::size_t i = 0; i < pixels_; ++i)
    codes[i] = pixel_at(line, i, pixel_bytes_).word[bits.shift / 32] >> bits.shift % 32 & mask_of(bits);
  return codes;
}

/// Bits that no component has are 0, so that decoding need not know them.
bool LineCodec::only_components(std::span<const std::byte> line) const {
  PixelCode all;
  for (std::size_t c = 0; c < components_; ++c)
    all.word[component_[c].shift / 32] |= mask_of(component_[c]) << component_[c].shift % 32;
  for (std::size_t i = 0; i < pixels_; ++i) {
    const PixelCode pixel = pixel_at(line, i, pixel_bytes_);
    for (std::size_t w = 0; w < all.word.size(); ++w)
      if ((pixel.word[w] & ~all.word[w]) != 0) return false;
  }
  return true;
}

/// The mean of the slopes along opposite edges of the line's block of pixels.
LineCodec::Slope LineCodec::slope_of(const Codes& depths) const {
  const auto last = static_cast<int>(pixels_) - 1;
  const int right = entry_x(last), bottom = entry_y(last);
  const auto corner = [&](int x, int y) -> std::int64_t {
    return depths[static_cast<std::size_t>(tile_entry(x, y))];
  };
  const std::int64_t a = corner(0, 0), b = corner(right, 0), c = corner(0, bottom), d = corner(right, bottom);
  constexpr std::int64_t kOne = std::int64_t{1} << kSlopeBits;
  return {rounded_quotient((b - a + d - c) * kOne, 2 * std::int64_t{right}),
          rounded_quotient((c - a + d - b) * kOne, 2 * std::int64_t{bottom})};
}

LineCodec::Range LineCodec::range_of(const Codes& codes, const Slope& slope) const {
  std::int64_t least = INT64_MAX, greatest = INT64_MIN;
  for (std::size_t i = 0; i < pixels_; ++i) {
    const std::int64_t missed = std::int64_t{codes[i]} - slope.at(i);
    least = std::min(least, missed);
    greatest = std::max(greatest, missed);
  }
  return {least, static_cast<std::uint32_t>(std::bit_width(static_cast<std::uint64_t>(greatest - least)))};
}

LineCodec::Plan LineCodec::plan(std::span<const Codes> codes, bool plane) const {
  Plan plan{plane};
  plan.bits = kHeaderBits;
  if (plane) {
    plan.slope = slope_of(codes[0]);
    plan.bits += kWidthBits + 2 * plan.slope.width();
  }
  for (std::size_t c = 0; c < components_; ++c) {
    plan.range[c] = range_of(codes[c], plan.slope_of(c));
    plan.bits += component_[c].bits + kWidthBits + pixels_ * plan.range[c].width;
  }
  return plan;
}

LineCodec::Plan LineCodec::best_plan(std::span<const Codes> codes) const {
  const Plan offsets = plan(codes, false);
  if (!planes_) return offsets;
  const Plan plane = plan(codes, true);
  return plane.sectors() < offsets.sectors() ? plane : offsets;
}

EncodedLine LineCodec::encode(std::span<const std::byte> line) const {
  QUADRILLE_CHECK(line.size() == line_bytes(), "a line of {} bytes", line.size());
  std::array<Codes, kMaxComponents> codes{};
  for (std::size_t c = 0; c < components_; ++c) codes[c] = codes_of(line, c);
  const Plan best = best_plan(codes);
  EncodedLine plain{LineEncoding::kPlain, 8 * line_bytes()};
  if (best.sectors() < plain.sectors() && only_components(line)) return packed(codes, best);
  std::ranges::copy(line, plain.bytes.begin());
  return plain;
}

EncodedLine LineCodec::packed(std::span<const Codes> codes, const Plan& plan) const {
  EncodedLine encoded{plan.plane ? LineEncoding::kPlane : LineEncoding::kOffset};
  BitWriter out(encoded.bytes);
  out.put(plan.plane ? 1 : 0, kHeaderBits);
  if (plan.plane) {
    const std::uint32_t width = plan.slope.width();
    out.put(width, kWidthBits);
    out.put(static_cast<std::uint64_t>(plan.slope.x), width);
    out.put(static_cast<std::uint64_t>(plan.slope.y), width);
  }
  for (std::size_t c = 0; c < components_; ++c) {
    const Range& range = plan.range[c];
    out.put(static_cast<std::uint64_t>(range.least), component_[c].bits);
    out.put(range.width, kWidthBits);
    const Slope slope = plan.slope_of(c);
    for (std::size_t i = 0; i < pixels_; ++i)
      out.put(static_cast<std::uint64_t>(std::int64_t{codes[c][i]} - slope.at(i) - range.least), range.width);
  }
  encoded.bits = out.bits();
  return encoded;
}

/// Sums are taken modulo the component's bits, to which a plane's least miss, which may be negative, was cut.
void LineCodec::decode(const EncodedLine& encoded, std::span<std::byte> line) const {
  QUADRILLE_CHECK(line.size() == line_bytes(), "a line of {} bytes", line.size());
  if (encoded.encoding == LineEncoding::kPlain) {
    std::copy_n(encoded.bytes.begin(), line.size(), line.begin());
    return;
  }
  BitReader in(encoded.bytes);
  Slope slope;
  if (in.take(kHeaderBits) != 0) {
    const auto width = static_cast<std::uint32_t>(in.take(kWidthBits));
    slope.x = in.take_signed(width);
    slope.y = in.take_signed(width);
  }
  std::array<PixelCode, kMaxPixels> pixels{};
  for (std::size_t c = 0; c < components_; ++c) {
    const ComponentBits& bits = component_[c];
    const std::uint64_t least = in.take(bits.bits);
    const auto width = static_cast<std::uint32_t>(in.take(kWidthBits));
    for (std::size_t i = 0; i < pixels_; ++i) {
      const std::uint64_t predicted = c == 0 ? static_cast<std::uint64_t>(slope.at(i)) : 0;
      const auto code = static_cast<std::uint32_t>(predicted + least + in.take(width)) & mask_of(bits);
      pixels[i].word[bits.shift / 32] |= code << bits.shift % 32;
    }
  }
  for (std::size_t i = 0; i < pixels_; ++i)
    std::memcpy(line.data() + i * pixel_bytes_, pixels[i].word.data(), pixel_bytes_);
}

}  // namespace quadrille::models
