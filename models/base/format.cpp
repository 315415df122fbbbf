#include "models/base/format.h"

#include <cstddef>

namespace quadrille::models {
namespace {

constexpr std::uint8_t kTexture = kFileUse | kSampleUse, kTarget = kColorUse | kBlendUse | kTexture,
                       kIntegers = kColorUse | kTexture, kDepth = kDepthUse | kTexture,
                       kDepthAndStencil = kDepthUse | kSampleUse;

/// Components of eight bits at these shifts; alpha is never sRGB.
constexpr std::array<ComponentBits, 4> bytes_at(std::uint8_t red, std::uint8_t green, std::uint8_t blue,
                                                Numeric numeric) {
  return {{{red, 8, numeric}, {green, 8, numeric}, {blue, 8, numeric}, {24, 8, Numeric::kUnorm}}};
}
constexpr std::array<ComponentBits, 4> kTenTenTenTwo{{{0, 10, Numeric::kUnorm},
                                                      {10, 10, Numeric::kUnorm},
                                                      {20, 10, Numeric::kUnorm},
                                                      {30, 2, Numeric::kUnorm}}};
constexpr std::array<ComponentBits, 4> kTenTenTenTwoUint{
    {{0, 10, Numeric::kUint}, {10, 10, Numeric::kUint}, {20, 10, Numeric::kUint}, {30, 2, Numeric::kUint}}};
constexpr std::array<ComponentBits, 4> kNineNineNine{{{0, 9, Numeric::kSharedExponent},
                                                      {9, 9, Numeric::kSharedExponent},
                                                      {18, 9, Numeric::kSharedExponent},
                                                      {}}};
constexpr std::array<ComponentBits, 4> kElevenElevenTen{
    {{0, 11, Numeric::kUfloat}, {11, 11, Numeric::kUfloat}, {22, 10, Numeric::kUfloat}, {}}};
constexpr std::array<ComponentBits, 4> kOneFloat{{{0, 32, Numeric::kFloat}, {}, {}, {}}};

/// So many components of the same size, the first in the low bits.
constexpr std::array<ComponentBits, 4> in_a_row(int count, std::uint8_t bits, Numeric numeric) {
  std::array<ComponentBits, 4> components{};
  for (int c = 0; c < count; ++c)
    components[static_cast<std::size_t>(c)] = {static_cast<std::uint8_t>(c * bits), bits, numeric};
  return components;
}

/// Where a component lies: its lowest bit, and how many there are.
struct Place {
  std::uint8_t shift = 0, bits = 0;
};
/// Red, green, blue and alpha between 0 and 1, in one word.
constexpr std::array<ComponentBits, 4> packed(Place red, Place green, Place blue = {}, Place alpha = {}) {
  std::array<ComponentBits, 4> components{};
  const std::array<Place, 4> places{red, green, blue, alpha};
  for (std::size_t c = 0; c < 4; ++c)
    if (places[c].bits != 0) components[c] = {places[c].shift, places[c].bits, Numeric::kUnorm};
  return components;
}

/// A texture of compressed blocks.
constexpr FormatInfo blocks(std::string_view name, std::uint8_t bytes, std::uint8_t channels, Numeric numeric,
                            std::uint8_t width = 4, std::uint8_t height = 4) {
  return {name, bytes, channels, kTexture, numeric, {}, {}, width, height};
}

/// By the value of `Format`.
constexpr std::array<FormatInfo, static_cast<std::size_t>(kLastFormat) + 1> kFormats{{
    {"UNDEFINED", 0, 0, 0, Numeric::kNone},
    {"R8G8B8A8_UNORM", 4, 4, kTarget, Numeric::kUnorm, bytes_at(0, 8, 16, Numeric::kUnorm)},
    {"R8G8B8A8_SRGB", 4, 4, kTarget, Numeric::kSrgb, bytes_at(0, 8, 16, Numeric::kSrgb)},
    {"D32_SFLOAT", 4, 1, kDepth, Numeric::kFloat, kOneFloat},
    {"R32_SFLOAT", 4, 1, kAttributeUse | kTarget, Numeric::kFloat, kOneFloat},
    {"R32G32_SFLOAT", 8, 2, kAttributeUse | kTarget, Numeric::kFloat, in_a_row(2, 32, Numeric::kFloat)},
    {"R32G32B32_SFLOAT", 12, 3, kAttributeUse, Numeric::kFloat},
    {"R32G32B32A32_SFLOAT", 16, 4, kAttributeUse | kTarget, Numeric::kFloat,
     in_a_row(4, 32, Numeric::kFloat)},
    {"R8G8_UNORM", 2, 2, kAttributeUse | kTarget, Numeric::kUnorm, in_a_row(2, 8, Numeric::kUnorm)},
    {"R8G8B8A8_UNORM", 4, 4, kAttributeUse, Numeric::kUnorm},
    {"R16G16_UNORM", 4, 2, kAttributeUse | kTexture, Numeric::kUnorm, in_a_row(2, 16, Numeric::kUnorm)},
    {"R16G16B16A16_UNORM", 8, 4, kAttributeUse | kTexture, Numeric::kUnorm, in_a_row(4, 16, Numeric::kUnorm)},
    {"R8G8B8A8_SNORM", 4, 4, kAttributeUse | kTexture, Numeric::kSnorm, in_a_row(4, 8, Numeric::kSnorm)},
    {"R16G16B16A16_SNORM", 8, 4, kAttributeUse | kTexture, Numeric::kSnorm, in_a_row(4, 16, Numeric::kSnorm)},
    {"R8G8B8A8_UINT", 4, 4, kAttributeUse | kIntegers, Numeric::kUint, in_a_row(4, 8, Numeric::kUint)},
    {"R16G16B16A16_UINT", 8, 4, kAttributeUse | kIntegers, Numeric::kUint, in_a_row(4, 16, Numeric::kUint)},
    {"B8G8R8A8_UNORM", 4, 4, kTarget, Numeric::kUnorm, bytes_at(16, 8, 0, Numeric::kUnorm)},
    {"B8G8R8A8_SRGB", 4, 4, kTarget, Numeric::kSrgb, bytes_at(16, 8, 0, Numeric::kSrgb)},
    {"A2B10G10R10_UNORM_PACK32", 4, 4, kTarget, Numeric::kUnorm, kTenTenTenTwo},
    {"R8_UNORM", 1, 1, kTarget, Numeric::kUnorm, in_a_row(1, 8, Numeric::kUnorm)},
    {"R16_SFLOAT", 2, 1, kTarget, Numeric::kFloat, in_a_row(1, 16, Numeric::kFloat)},
    {"R16G16_SFLOAT", 4, 2, kTarget, Numeric::kFloat, in_a_row(2, 16, Numeric::kFloat)},
    {"R16G16B16A16_SFLOAT", 8, 4, kTarget, Numeric::kFloat, in_a_row(4, 16, Numeric::kFloat)},
    {"B10G11R11_UFLOAT_PACK32", 4, 3, kTarget, Numeric::kUfloat, kElevenElevenTen},
    {"D16_UNORM", 2, 1, kDepth, Numeric::kUnorm, in_a_row(1, 16, Numeric::kUnorm)},
    {"D24_UNORM_S8_UINT",
     4,
     1,
     kDepthAndStencil,
     Numeric::kUnorm,
     in_a_row(1, 24, Numeric::kUnorm),
     {24, 8, Numeric::kUint}},
    {"D32_SFLOAT_S8_UINT", 8, 1, kDepthAndStencil, Numeric::kFloat, kOneFloat, {32, 8, Numeric::kUint}},
    {"R8_UINT", 1, 1, kIntegers, Numeric::kUint, in_a_row(1, 8, Numeric::kUint)},
    {"R8_SINT", 1, 1, kIntegers, Numeric::kSint, in_a_row(1, 8, Numeric::kSint)},
    {"R8G8_UINT", 2, 2, kIntegers, Numeric::kUint, in_a_row(2, 8, Numeric::kUint)},
    {"R8G8_SINT", 2, 2, kIntegers, Numeric::kSint, in_a_row(2, 8, Numeric::kSint)},
    {"R8G8B8A8_SINT", 4, 4, kAttributeUse | kIntegers, Numeric::kSint, in_a_row(4, 8, Numeric::kSint)},
    {"R16_UINT", 2, 1, kIntegers, Numeric::kUint, in_a_row(1, 16, Numeric::kUint)},
    {"R16_SINT", 2, 1, kIntegers, Numeric::kSint, in_a_row(1, 16, Numeric::kSint)},
    {"R16G16_UINT", 4, 2, kIntegers, Numeric::kUint, in_a_row(2, 16, Numeric::kUint)},
    {"R16G16_SINT", 4, 2, kIntegers, Numeric::kSint, in_a_row(2, 16, Numeric::kSint)},
    {"R16G16B16A16_SINT", 8, 4, kAttributeUse | kIntegers, Numeric::kSint, in_a_row(4, 16, Numeric::kSint)},
    {"R32_UINT", 4, 1, kAttributeUse | kIntegers, Numeric::kUint, in_a_row(1, 32, Numeric::kUint)},
    {"R32_SINT", 4, 1, kAttributeUse | kIntegers, Numeric::kSint, in_a_row(1, 32, Numeric::kSint)},
    {"R32G32_UINT", 8, 2, kAttributeUse | kIntegers, Numeric::kUint, in_a_row(2, 32, Numeric::kUint)},
    {"R32G32_SINT", 8, 2, kAttributeUse | kIntegers, Numeric::kSint, in_a_row(2, 32, Numeric::kSint)},
    {"R32G32B32A32_UINT", 16, 4, kAttributeUse | kIntegers, Numeric::kUint, in_a_row(4, 32, Numeric::kUint)},
    {"R32G32B32A32_SINT", 16, 4, kAttributeUse | kIntegers, Numeric::kSint, in_a_row(4, 32, Numeric::kSint)},
    {"R8_SNORM", 1, 1, kTexture, Numeric::kSnorm, in_a_row(1, 8, Numeric::kSnorm)},
    {"R8_SRGB", 1, 1, kTexture, Numeric::kSrgb, in_a_row(1, 8, Numeric::kSrgb)},
    {"R8G8_SNORM", 2, 2, kTexture, Numeric::kSnorm, in_a_row(2, 8, Numeric::kSnorm)},
    {"R8G8_SRGB", 2, 2, kTexture, Numeric::kSrgb, in_a_row(2, 8, Numeric::kSrgb)},
    {"R16_UNORM", 2, 1, kTexture, Numeric::kUnorm, in_a_row(1, 16, Numeric::kUnorm)},
    {"R16_SNORM", 2, 1, kTexture, Numeric::kSnorm, in_a_row(1, 16, Numeric::kSnorm)},
    {"R16G16_SNORM", 4, 2, kTexture, Numeric::kSnorm, in_a_row(2, 16, Numeric::kSnorm)},
    {"R4G4_UNORM_PACK8", 1, 2, kTexture, Numeric::kUnorm, packed({4, 4}, {0, 4})},
    {"R4G4B4A4_UNORM_PACK16", 2, 4, kTexture, Numeric::kUnorm, packed({12, 4}, {8, 4}, {4, 4}, {0, 4})},
    {"B4G4R4A4_UNORM_PACK16", 2, 4, kTexture, Numeric::kUnorm, packed({4, 4}, {8, 4}, {12, 4}, {0, 4})},
    {"R5G6B5_UNORM_PACK16", 2, 3, kTexture, Numeric::kUnorm, packed({11, 5}, {5, 6}, {0, 5})},
    {"B5G6R5_UNORM_PACK16", 2, 3, kTexture, Numeric::kUnorm, packed({0, 5}, {5, 6}, {11, 5})},
    {"R5G5B5A1_UNORM_PACK16", 2, 4, kTexture, Numeric::kUnorm, packed({11, 5}, {6, 5}, {1, 5}, {0, 1})},
    {"B5G5R5A1_UNORM_PACK16", 2, 4, kTexture, Numeric::kUnorm, packed({1, 5}, {6, 5}, {11, 5}, {0, 1})},
    {"A1R5G5B5_UNORM_PACK16", 2, 4, kTexture, Numeric::kUnorm, packed({10, 5}, {5, 5}, {0, 5}, {15, 1})},
    {"A2R10G10B10_UNORM_PACK32", 4, 4, kTexture, Numeric::kUnorm,
     packed({20, 10}, {10, 10}, {0, 10}, {30, 2})},
    {"A2B10G10R10_UINT_PACK32", 4, 4, kTexture, Numeric::kUint, kTenTenTenTwoUint},
    {"E5B9G9R9_UFLOAT_PACK32", 4, 3, kTexture, Numeric::kSharedExponent, kNineNineNine},
    blocks("BC1_RGB_UNORM_BLOCK", 8, 3, Numeric::kUnorm),
    blocks("BC1_RGB_SRGB_BLOCK", 8, 3, Numeric::kSrgb),
    blocks("BC1_RGBA_UNORM_BLOCK", 8, 4, Numeric::kUnorm),
    blocks("BC1_RGBA_SRGB_BLOCK", 8, 4, Numeric::kSrgb),
    blocks("BC2_UNORM_BLOCK", 16, 4, Numeric::kUnorm),
    blocks("BC2_SRGB_BLOCK", 16, 4, Numeric::kSrgb),
    blocks("BC3_UNORM_BLOCK", 16, 4, Numeric::kUnorm),
    blocks("BC3_SRGB_BLOCK", 16, 4, Numeric::kSrgb),
    blocks("BC4_UNORM_BLOCK", 8, 1, Numeric::kUnorm),
    blocks("BC4_SNORM_BLOCK", 8, 1, Numeric::kSnorm),
    blocks("BC5_UNORM_BLOCK", 16, 2, Numeric::kUnorm),
    blocks("BC5_SNORM_BLOCK", 16, 2, Numeric::kSnorm),
    blocks("BC6H_UFLOAT_BLOCK", 16, 3, Numeric::kUfloat),
    blocks("BC6H_SFLOAT_BLOCK", 16, 3, Numeric::kFloat),
    blocks("BC7_UNORM_BLOCK", 16, 4, Numeric::kUnorm),
    blocks("BC7_SRGB_BLOCK", 16, 4, Numeric::kSrgb),
    blocks("ETC2_R8G8B8_UNORM_BLOCK", 8, 3, Numeric::kUnorm),
    blocks("ETC2_R8G8B8_SRGB_BLOCK", 8, 3, Numeric::kSrgb),
    blocks("ETC2_R8G8B8A1_UNORM_BLOCK", 8, 4, Numeric::kUnorm),
    blocks("ETC2_R8G8B8A1_SRGB_BLOCK", 8, 4, Numeric::kSrgb),
    blocks("ETC2_R8G8B8A8_UNORM_BLOCK", 16, 4, Numeric::kUnorm),
    blocks("ETC2_R8G8B8A8_SRGB_BLOCK", 16, 4, Numeric::kSrgb),
    blocks("EAC_R11_UNORM_BLOCK", 8, 1, Numeric::kUnorm),
    blocks("EAC_R11_SNORM_BLOCK", 8, 1, Numeric::kSnorm),
    blocks("EAC_R11G11_UNORM_BLOCK", 16, 2, Numeric::kUnorm),
    blocks("EAC_R11G11_SNORM_BLOCK", 16, 2, Numeric::kSnorm),
    blocks("ASTC_4x4_UNORM_BLOCK", 16, 4, Numeric::kUnorm, 4, 4),
    blocks("ASTC_4x4_SRGB_BLOCK", 16, 4, Numeric::kSrgb, 4, 4),
    blocks("ASTC_5x4_UNORM_BLOCK", 16, 4, Numeric::kUnorm, 5, 4),
    blocks("ASTC_5x4_SRGB_BLOCK", 16, 4, Numeric::kSrgb, 5, 4),
    blocks("ASTC_5x5_UNORM_BLOCK", 16, 4, Numeric::kUnorm, 5, 5),
    blocks("ASTC_5x5_SRGB_BLOCK", 16, 4, Numeric::kSrgb, 5, 5),
    blocks("ASTC_6x5_UNORM_BLOCK", 16, 4, Numeric::kUnorm, 6, 5),
    blocks("ASTC_6x5_SRGB_BLOCK", 16, 4, Numeric::kSrgb, 6, 5),
    blocks("ASTC_6x6_UNORM_BLOCK", 16, 4, Numeric::kUnorm, 6, 6),
    blocks("ASTC_6x6_SRGB_BLOCK", 16, 4, Numeric::kSrgb, 6, 6),
    blocks("ASTC_8x5_UNORM_BLOCK", 16, 4, Numeric::kUnorm, 8, 5),
    blocks("ASTC_8x5_SRGB_BLOCK", 16, 4, Numeric::kSrgb, 8, 5),
    blocks("ASTC_8x6_UNORM_BLOCK", 16, 4, Numeric::kUnorm, 8, 6),
    blocks("ASTC_8x6_SRGB_BLOCK", 16, 4, Numeric::kSrgb, 8, 6),
    blocks("ASTC_8x8_UNORM_BLOCK", 16, 4, Numeric::kUnorm, 8, 8),
    blocks("ASTC_8x8_SRGB_BLOCK", 16, 4, Numeric::kSrgb, 8, 8),
    blocks("ASTC_10x5_UNORM_BLOCK", 16, 4, Numeric::kUnorm, 10, 5),
    blocks("ASTC_10x5_SRGB_BLOCK", 16, 4, Numeric::kSrgb, 10, 5),
    blocks("ASTC_10x6_UNORM_BLOCK", 16, 4, Numeric::kUnorm, 10, 6),
    blocks("ASTC_10x6_SRGB_BLOCK", 16, 4, Numeric::kSrgb, 10, 6),
    blocks("ASTC_10x8_UNORM_BLOCK", 16, 4, Numeric::kUnorm, 10, 8),
    blocks("ASTC_10x8_SRGB_BLOCK", 16, 4, Numeric::kSrgb, 10, 8),
    blocks("ASTC_10x10_UNORM_BLOCK", 16, 4, Numeric::kUnorm, 10, 10),
    blocks("ASTC_10x10_SRGB_BLOCK", 16, 4, Numeric::kSrgb, 10, 10),
    blocks("ASTC_12x10_UNORM_BLOCK", 16, 4, Numeric::kUnorm, 12, 10),
    blocks("ASTC_12x10_SRGB_BLOCK", 16, 4, Numeric::kSrgb, 12, 10),
    blocks("ASTC_12x12_UNORM_BLOCK", 16, 4, Numeric::kUnorm, 12, 12),
    blocks("ASTC_12x12_SRGB_BLOCK", 16, 4, Numeric::kSrgb, 12, 12),
}};

}  // namespace

const FormatInfo& format_info(Format format) { return kFormats[static_cast<std::size_t>(format)]; }

}  // namespace quadrille::models
