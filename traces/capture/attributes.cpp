#include "traces/capture/attributes.h"

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace quadrille::capture {
namespace {

using traces::Format;

enum class Kind : std::uint8_t { kUnorm, kSnorm, kUscaled, kSscaled, kUint, kSint, kHalf, kSmallFloat };

struct Component {
  std::uint8_t shift = 0, bits = 0;
};
struct AttributeRow {
  VkFormat format;
  Kind kind;
  std::uint8_t bytes, components;
  std::array<Component, 4> component;
};
/// Components of 8, 16 or 32 bits, one behind the other.
constexpr AttributeRow row(VkFormat format, Kind kind, std::uint8_t bits, std::uint8_t components) {
  AttributeRow made{format, kind, static_cast<std::uint8_t>(bits / 8 * components), components, {}};
  for (std::uint8_t c = 0; c < 4; ++c) made.component[c] = {static_cast<std::uint8_t>(c * bits), bits};
  return made;
}
constexpr AttributeRow tens(VkFormat format, Kind kind, bool blue_first) {
  const std::uint8_t red = blue_first ? 20 : 0, blue = blue_first ? 0 : 20;
  return {format, kind, 4, 4, {{{red, 10}, {10, 10}, {blue, 10}, {30, 2}}}};
}
constexpr AttributeRow kRows[] = {
    tens(VK_FORMAT_A2B10G10R10_UNORM_PACK32, Kind::kUnorm, false),
    tens(VK_FORMAT_A2B10G10R10_SNORM_PACK32, Kind::kSnorm, false),
    tens(VK_FORMAT_A2B10G10R10_USCALED_PACK32, Kind::kUscaled, false),
    tens(VK_FORMAT_A2B10G10R10_SSCALED_PACK32, Kind::kSscaled, false),
    tens(VK_FORMAT_A2R10G10B10_UNORM_PACK32, Kind::kUnorm, true),
    tens(VK_FORMAT_A2R10G10B10_SNORM_PACK32, Kind::kSnorm, true),
    tens(VK_FORMAT_A2R10G10B10_USCALED_PACK32, Kind::kUscaled, true),
    tens(VK_FORMAT_A2R10G10B10_SSCALED_PACK32, Kind::kSscaled, true),
    {VK_FORMAT_B10G11R11_UFLOAT_PACK32, Kind::kSmallFloat, 4, 3, {{{0, 11}, {11, 11}, {22, 10}, {}}}},
    {VK_FORMAT_B8G8R8A8_UNORM, Kind::kUnorm, 4, 4, {{{16, 8}, {8, 8}, {0, 8}, {24, 8}}}},
    row(VK_FORMAT_R16_SFLOAT, Kind::kHalf, 16, 1),
    row(VK_FORMAT_R16G16_SFLOAT, Kind::kHalf, 16, 2),
    row(VK_FORMAT_R16G16B16_SFLOAT, Kind::kHalf, 16, 3),
    row(VK_FORMAT_R16G16B16A16_SFLOAT, Kind::kHalf, 16, 4),
    row(VK_FORMAT_R8_UNORM, Kind::kUnorm, 8, 1),
    row(VK_FORMAT_R8G8B8_UNORM, Kind::kUnorm, 8, 3),
    row(VK_FORMAT_R8_SNORM, Kind::kSnorm, 8, 1),
    row(VK_FORMAT_R8G8_SNORM, Kind::kSnorm, 8, 2),
    row(VK_FORMAT_R8G8B8_SNORM, Kind::kSnorm, 8, 3),
    row(VK_FORMAT_R8_USCALED, Kind::kUscaled, 8, 1),
    row(VK_FORMAT_R8G8_USCALED, Kind::kUscaled, 8, 2),
    row(VK_FORMAT_R8G8B8_USCALED, Kind::kUscaled, 8, 3),
    row(VK_FORMAT_R8G8B8A8_USCALED, Kind::kUscaled, 8, 4),
    row(VK_FORMAT_R8_SSCALED, Kind::kSscaled, 8, 1),
    row(VK_FORMAT_R8G8_SSCALED, Kind::kSscaled, 8, 2),
    row(VK_FORMAT_R8G8B8_SSCALED, Kind::kSscaled, 8, 3),
    row(VK_FORMAT_R8G8B8A8_SSCALED, Kind::kSscaled, 8, 4),
    row(VK_FORMAT_R8_UINT, Kind::kUint, 8, 1),
    row(VK_FORMAT_R8G8_UINT, Kind::kUint, 8, 2),
    row(VK_FORMAT_R8G8B8_UINT, Kind::kUint, 8, 3),
    row(VK_FORMAT_R8_SINT, Kind::kSint, 8, 1),
    row(VK_FORMAT_R8G8_SINT, Kind::kSint, 8, 2),
    row(VK_FORMAT_R8G8B8_SINT, Kind::kSint, 8, 3),
    row(VK_FORMAT_R16_UNORM, Kind::kUnorm, 16, 1),
    row(VK_FORMAT_R16G16B16_UNORM, Kind::kUnorm, 16, 3),
    row(VK_FORMAT_R16_SNORM, Kind::kSnorm, 16, 1),
    row(VK_FORMAT_R16G16_SNORM, Kind::kSnorm, 16, 2),
    row(VK_FORMAT_R16G16B16_SNORM, Kind::kSnorm, 16, 3),
    row(VK_FORMAT_R16_USCALED, Kind::kUscaled, 16, 1),
    row(VK_FORMAT_R16G16_USCALED, Kind::kUscaled, 16, 2),
    row(VK_FORMAT_R16G16B16_USCALED, Kind::kUscaled, 16, 3),
    row(VK_FORMAT_R16G16B16A16_USCALED, Kind::kUscaled, 16, 4),
    row(VK_FORMAT_R16_SSCALED, Kind::kSscaled, 16, 1),
    row(VK_FORMAT_R16G16_SSCALED, Kind::kSscaled, 16, 2),
    row(VK_FORMAT_R16G16B16_SSCALED, Kind::kSscaled, 16, 3),
    row(VK_FORMAT_R16G16B16A16_SSCALED, Kind::kSscaled, 16, 4),
    row(VK_FORMAT_R16_UINT, Kind::kUint, 16, 1),
    row(VK_FORMAT_R16G16_UINT, Kind::kUint, 16, 2),
    row(VK_FORMAT_R16G16B16_UINT, Kind::kUint, 16, 3),
    row(VK_FORMAT_R16_SINT, Kind::kSint, 16, 1),
    row(VK_FORMAT_R16G16_SINT, Kind::kSint, 16, 2),
    row(VK_FORMAT_R16G16B16_SINT, Kind::kSint, 16, 3),
    row(VK_FORMAT_R32G32B32_UINT, Kind::kUint, 32, 3),
    row(VK_FORMAT_R32G32B32_SINT, Kind::kSint, 32, 3),
};

const AttributeRow* row_of(std::uint32_t format) {
  const auto* found = std::ranges::find_if(
      kRows, [=](const AttributeRow& r) { return static_cast<std::uint32_t>(r.format) == format; });
  return found == std::end(kRows) ? nullptr : found;
}

/// A float of 16 bits. [VK1.3 #fundamentals-fp16]
float from_half(std::uint32_t code) {
  const std::uint32_t sign = (code & 0x8000) << 16, exponent = code >> 10 & 31, mantissa = code & 1023;
  if (exponent == 0) {
    const float small = static_cast<float>(mantissa) * 0x1p-24f;
    return sign != 0 ? -small : small;
  }
  const std::uint32_t wide = exponent == 31 ? 255 : exponent + 112;
  return std::bit_cast<float>(sign | wide << 23 | mantissa << 13);
}

std::int64_t signed_of(std::uint64_t code, std::uint32_t bits) {
  const std::uint64_t half = std::uint64_t{1} << (bits - 1);
  return static_cast<std::int64_t>(code ^ half) - static_cast<std::int64_t>(half);
}

/// A float of 5 bits of exponent and no sign. [VK1.3 #fundamentals-fp11]
float from_small_float(std::uint64_t code, std::uint32_t bits) {
  return from_half(static_cast<std::uint32_t>(code << (15 - bits)));
}

float number_of(Kind kind, std::uint64_t code, std::uint32_t bits) {
  const auto most = static_cast<float>((std::uint64_t{1} << (kind == Kind::kSnorm ? bits - 1 : bits)) - 1);
  switch (kind) {
    case Kind::kUnorm: return static_cast<float>(code) / most;
    case Kind::kSnorm: return std::max(static_cast<float>(signed_of(code, bits)) / most, -1.0f);
    case Kind::kUscaled: return static_cast<float>(code);
    case Kind::kSscaled: return static_cast<float>(signed_of(code, bits));
    case Kind::kSmallFloat: return from_small_float(code, bits);
    case Kind::kHalf: return from_half(static_cast<std::uint32_t>(code));
    case Kind::kUint:
    case Kind::kSint: break;
  }
  return 0;
}

bool holds_integers(Kind kind) { return kind == Kind::kUint || kind == Kind::kSint; }

/// The word of a component as it is fetched.
std::uint32_t word_of(Kind kind, std::uint64_t code, std::uint32_t bits) {
  if (kind == Kind::kUint) return static_cast<std::uint32_t>(code);
  if (kind == Kind::kSint) return static_cast<std::uint32_t>(signed_of(code, bits));
  return std::bit_cast<std::uint32_t>(number_of(kind, code, bits));
}

void append(std::uint32_t word, std::vector<std::byte>& to) {
  const auto* from = reinterpret_cast<const std::byte*>(&word);
  to.insert(to.end(), from, from + sizeof(word));
}

void expand(const AttributeRow& row, const std::byte* source, std::vector<std::byte>& to) {
  std::array<std::uint64_t, 2> words{};
  std::memcpy(words.data(), source, row.bytes);
  for (std::size_t c = 0; c < row.components; ++c) {
    const auto [shift, bits] = row.component[c];
    const std::uint64_t code = words.at(shift / 64u) >> shift % 64u & ((std::uint64_t{1} << bits) - 1);
    append(word_of(row.kind, code, bits), to);
  }
  // There is no format of three integers to fetch.
  if (row.components == 3 && holds_integers(row.kind)) append(1, to);
}

}  // namespace

Format expanded_attribute_format(std::uint32_t format) {
  const AttributeRow* row = row_of(format);
  if (row == nullptr) return Format::kUndefined;
  constexpr std::array kFloats{Format::kR32Float, Format::kR32G32Float, Format::kR32G32B32Float,
                               Format::kR32G32B32A32Float};
  constexpr std::array kUnsigned{Format::kR32Uint, Format::kR32G32Uint, Format::kR32G32B32A32Uint,
                                 Format::kR32G32B32A32Uint};
  constexpr std::array kSigned{Format::kR32Sint, Format::kR32G32Sint, Format::kR32G32B32A32Sint,
                               Format::kR32G32B32A32Sint};
  const auto& formats = row->kind == Kind::kUint ? kUnsigned : row->kind == Kind::kSint ? kSigned : kFloats;
  return formats.at(row->components - 1u);
}

std::vector<std::byte> expanded_attributes(std::span<const std::byte> buffer, const AttributeSource& source) {
  const AttributeRow& row = *row_of(source.format);
  std::vector<std::byte> made;
  for (std::uint64_t at = source.offset; at <= buffer.size() && row.bytes <= buffer.size() - at;
       at += source.stride) {
    expand(row, buffer.data() + at, made);
    if (source.stride == 0) break;
  }
  return made;
}

}  // namespace quadrille::capture
