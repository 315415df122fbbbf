#include "models/base/format.h"

#include <cstddef>

namespace quadrille::models {
namespace {

constexpr std::uint8_t kTexture = kFileUse | kSampleUse, kTarget = kColorUse | kSampleUse;

/// Components of eight bits at these shifts; alpha is never sRGB.
constexpr std::array<ComponentBits, 4> bytes_at(std::uint8_t red, std::uint8_t green, std::uint8_t blue,
                                                Numeric numeric) {
  return {{{red, 8, numeric}, {green, 8, numeric}, {blue, 8, numeric}, {24, 8, Numeric::kUnorm}}};
}
constexpr std::array<ComponentBits, 4> kTenTenTenTwo{{{0, 10, Numeric::kUnorm},
                                                      {10, 10, Numeric::kUnorm},
                                                      {20, 10, Numeric::kUnorm},
                                                      {30, 2, Numeric::kUnorm}}};
constexpr std::array<ComponentBits, 4> kOneFloat{{{0, 32, Numeric::kFloat}, {}, {}, {}}};

/// By the value of `Format`.
constexpr std::array<FormatInfo, static_cast<std::size_t>(kLastFormat) + 1> kFormats{{
    {"UNDEFINED", 0, 0, 0, Numeric::kNone},
    {"R8G8B8A8_UNORM", 4, 4, kTexture | kTarget, Numeric::kUnorm, bytes_at(0, 8, 16, Numeric::kUnorm)},
    {"R8G8B8A8_SRGB", 4, 4, kTexture | kTarget, Numeric::kSrgb, bytes_at(0, 8, 16, Numeric::kSrgb)},
    {"D32_SFLOAT", 4, 1, kDepthUse | kSampleUse, Numeric::kFloat, kOneFloat},
    {"R32_SFLOAT", 4, 1, kAttributeUse, Numeric::kFloat},
    {"R32G32_SFLOAT", 8, 2, kAttributeUse, Numeric::kFloat},
    {"R32G32B32_SFLOAT", 12, 3, kAttributeUse, Numeric::kFloat},
    {"R32G32B32A32_SFLOAT", 16, 4, kAttributeUse, Numeric::kFloat},
    {"R8G8_UNORM", 2, 2, kAttributeUse, Numeric::kUnorm},
    {"R8G8B8A8_UNORM", 4, 4, kAttributeUse, Numeric::kUnorm},
    {"R16G16_UNORM", 4, 2, kAttributeUse, Numeric::kUnorm},
    {"R16G16B16A16_UNORM", 8, 4, kAttributeUse, Numeric::kUnorm},
    {"R8G8B8A8_SNORM", 4, 4, kAttributeUse, Numeric::kSnorm},
    {"R16G16B16A16_SNORM", 8, 4, kAttributeUse, Numeric::kSnorm},
    {"R8G8B8A8_UINT", 4, 4, kAttributeUse, Numeric::kUint},
    {"R16G16B16A16_UINT", 8, 4, kAttributeUse, Numeric::kUint},
    {"B8G8R8A8_UNORM", 4, 4, kTarget, Numeric::kUnorm, bytes_at(16, 8, 0, Numeric::kUnorm)},
    {"B8G8R8A8_SRGB", 4, 4, kTarget, Numeric::kSrgb, bytes_at(16, 8, 0, Numeric::kSrgb)},
    {"A2B10G10R10_UNORM_PACK32", 4, 4, kTarget, Numeric::kUnorm, kTenTenTenTwo},
}};

}  // namespace

const FormatInfo& format_info(Format format) { return kFormats[static_cast<std::size_t>(format)]; }

}  // namespace quadrille::models
