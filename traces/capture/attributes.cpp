#include "traces/capture/attributes.h"

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace quadrille::capture {
namespace {

using traces::Format;

enum class Kind : std::uint8_t { kUnorm, kSnorm, kUscaled, kSscaled, kHalf };

struct Component {
  std::uint8_t shift = 0, bits = 0;
};
struct AttributeRow {
  VkFormat format;
  Kind kind;
  std::uint8_t bytes, components;
  std::array<Component, 4> component;
};
constexpr std::array<Component, 4> even(std::uint8_t bits) {
  std::array<Component, 4> made{};
  for (std::uint8_t c = 0; c < 4; ++c) made[c] = {static_cast<std::uint8_t>(c * bits), bits};
  return made;
}
constexpr std::array<Component, 4> kTens{{{0, 10}, {10, 10}, {20, 10}, {30, 2}}};
constexpr AttributeRow kRows[] = {
    {VK_FORMAT_A2B10G10R10_SNORM_PACK32, Kind::kSnorm, 4, 4, kTens},
    {VK_FORMAT_A2B10G10R10_UNORM_PACK32, Kind::kUnorm, 4, 4, kTens},
    {VK_FORMAT_R16_SFLOAT, Kind::kHalf, 2, 1, even(16)},
    {VK_FORMAT_R16G16_SFLOAT, Kind::kHalf, 4, 2, even(16)},
    {VK_FORMAT_R16G16B16A16_SFLOAT, Kind::kHalf, 8, 4, even(16)},
    {VK_FORMAT_R8_UNORM, Kind::kUnorm, 1, 1, even(8)},
    {VK_FORMAT_R8G8_SNORM, Kind::kSnorm, 2, 2, even(8)},
    {VK_FORMAT_R16_UNORM, Kind::kUnorm, 2, 1, even(16)},
    {VK_FORMAT_R16G16_SNORM, Kind::kSnorm, 4, 2, even(16)},
    {VK_FORMAT_R16G16_USCALED, Kind::kUscaled, 4, 2, even(16)},
    {VK_FORMAT_R16G16_SSCALED, Kind::kSscaled, 4, 2, even(16)},
    {VK_FORMAT_R8G8B8A8_USCALED, Kind::kUscaled, 4, 4, even(8)},
    {VK_FORMAT_R8G8B8A8_SSCALED, Kind::kSscaled, 4, 4, even(8)},
};

const AttributeRow* row_of(std::uint32_t format) {
  const auto* row = std::ranges::find(kRows, static_cast<VkFormat>(format), &AttributeRow::format);
  return row == std::end(kRows) ? nullptr : row;
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

float number_of(Kind kind, std::uint64_t code, std::uint32_t bits) {
  const auto most = static_cast<float>((std::uint64_t{1} << (kind == Kind::kSnorm ? bits - 1 : bits)) - 1);
  switch (kind) {
    case Kind::kUnorm: return static_cast<float>(code) / most;
    case Kind::kSnorm: return std::max(static_cast<float>(signed_of(code, bits)) / most, -1.0f);
    case Kind::kUscaled: return static_cast<float>(code);
    case Kind::kSscaled: return static_cast<float>(signed_of(code, bits));
    case Kind::kHalf: break;
  }
  return from_half(static_cast<std::uint32_t>(code));
}

void expand(const AttributeRow& row, const std::byte* source, std::vector<std::byte>& to) {
  std::uint64_t word = 0;
  std::memcpy(&word, source, row.bytes);
  for (std::size_t c = 0; c < row.components; ++c) {
    const std::uint32_t bits = row.component[c].bits;
    const std::uint64_t code = word >> row.component[c].shift & ((std::uint64_t{1} << bits) - 1);
    const float number = number_of(row.kind, code, bits);
    const auto* from = reinterpret_cast<const std::byte*>(&number);
    to.insert(to.end(), from, from + sizeof(number));
  }
}

}  // namespace

Format expanded_attribute_format(std::uint32_t format) {
  const AttributeRow* row = row_of(format);
  if (row == nullptr) return Format::kUndefined;
  return row->components == 1   ? Format::kR32Float
         : row->components == 2 ? Format::kR32G32Float
                                : Format::kR32G32B32A32Float;
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
