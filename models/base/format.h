/// Formats of vertex attributes, textures and attachments: one table of what each is and may be used for.
/// [VK1.3 #formats-definition]
///
/// A new format is a value of `Format` and a row of the table in format.cpp. Values are those of trace files
/// and never change.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace quadrille::models {

// clang-format off: formats stay grouped by use
enum class Format : std::uint8_t {
  kUndefined,
  // Images.
  kR8G8B8A8Unorm,
  kR8G8B8A8Srgb,
  kD32Float,
  // Vertex attributes.
  kR32Float,
  kR32G32Float,
  kR32G32B32Float,
  kR32G32B32A32Float,
  kR8G8Unorm,
  kR8G8B8A8UnormVertex,
  kR16G16Unorm,
  kR16G16B16A16Unorm,
  kR8G8B8A8Snorm,
  kR16G16B16A16Snorm,
  // Vertex attributes that a shader reads as unsigned integers, and images of integers.
  kR8G8B8A8Uint,
  kR16G16B16A16Uint,
  // More images.
  kB8G8R8A8Unorm,
  kB8G8R8A8Srgb,
  kA2B10G10R10Unorm,
  // Images of other sizes.
  kR8Unorm,
  kR16Float,
  kR16G16Float,
  kR16G16B16A16Float,
  kB10G11R11Ufloat,
  // Depth and stencil.
  kD16Unorm,
  kD24UnormS8Uint,
  kD32FloatS8Uint,
  // Images of integers.
  kR8Uint,
  kR8Sint,
  kR8G8Uint,
  kR8G8Sint,
  kR8G8B8A8Sint,
  kR16Uint,
  kR16Sint,
  kR16G16Uint,
  kR16G16Sint,
  kR16G16B16A16Sint,
  kR32Uint,
  kR32Sint,
  kR32G32Uint,
  kR32G32Sint,
  kR32G32B32A32Uint,
  kR32G32B32A32Sint,
  // Textures.
  kR8Snorm,
  kR8Srgb,
  kR8G8Snorm,
  kR8G8Srgb,
  kR16Unorm,
  kR16Snorm,
  kR16G16Snorm,
  kR4G4Unorm,
  kR4G4B4A4Unorm,
  kB4G4R4A4Unorm,
  kR5G6B5Unorm,
  kB5G6R5Unorm,
  kR5G5B5A1Unorm,
  kB5G5R5A1Unorm,
  kA1R5G5B5Unorm,
  kA2R10G10B10Unorm,
  kA2B10G10R10Uint,
  kE5B9G9R9Ufloat,
  // Textures of compressed blocks.
  kBc1RgbUnorm,
  kBc1RgbSrgb,
  kBc1RgbaUnorm,
  kBc1RgbaSrgb,
  kBc2Unorm,
  kBc2Srgb,
  kBc3Unorm,
  kBc3Srgb,
  kBc4Unorm,
  kBc4Snorm,
  kBc5Unorm,
  kBc5Snorm,
  kBc6hUfloat,
  kBc6hSfloat,
  kBc7Unorm,
  kBc7Srgb,
  kEtc2Rgb8Unorm,
  kEtc2Rgb8Srgb,
  kEtc2Rgb8A1Unorm,
  kEtc2Rgb8A1Srgb,
  kEtc2Rgba8Unorm,
  kEtc2Rgba8Srgb,
  kEacR11Unorm,
  kEacR11Snorm,
  kEacR11G11Unorm,
  kEacR11G11Snorm,
  kAstc4x4Unorm,
  kAstc4x4Srgb,
  kAstc5x4Unorm,
  kAstc5x4Srgb,
  kAstc5x5Unorm,
  kAstc5x5Srgb,
  kAstc6x5Unorm,
  kAstc6x5Srgb,
  kAstc6x6Unorm,
  kAstc6x6Srgb,
  kAstc8x5Unorm,
  kAstc8x5Srgb,
  kAstc8x6Unorm,
  kAstc8x6Srgb,
  kAstc8x8Unorm,
  kAstc8x8Srgb,
  kAstc10x5Unorm,
  kAstc10x5Srgb,
  kAstc10x6Unorm,
  kAstc10x6Srgb,
  kAstc10x8Unorm,
  kAstc10x8Srgb,
  kAstc10x10Unorm,
  kAstc10x10Srgb,
  kAstc12x10Unorm,
  kAstc12x10Srgb,
  kAstc12x12Unorm,
  kAstc12x12Srgb
};
inline constexpr Format kLastFormat = Format::kAstc12x12Srgb;
// clang-format on

/// How the bits of a component stand for a number.
enum class Numeric : std::uint8_t {
  kNone,
  kUnorm,  ///< c / (2^bits - 1)
  kSnorm,  ///< max(c / (2^(bits - 1) - 1), -1)
  kSrgb,   ///< as kUnorm, and encoded by the sRGB transfer function
  kFloat,  ///< of 16 or 32 bits
  kUint,
  kSint,    ///< two's complement
  kUfloat,  ///< of 10 or 11 bits: no sign, five bits of exponent [VK1.3 #fundamentals-fp11]
  /// c 2^(e - 24), with an exponent for all components of a texel in the high five bits of its word [VK1.3
  /// #textures-RGB-sexp]
  kSharedExponent
};

/// Uses of a format, as bits.
enum FormatUse : std::uint8_t {
  kAttributeUse = 1,  ///< of a vertex
  kFileUse = 2,       ///< of an image that a stream brings texels for
  kColorUse = 4,      ///< of a colour attachment
  kDepthUse = 8,      ///< of a depth attachment
  kSampleUse = 16,    ///< of an image that shaders sample, with linear filtering unless it holds integers
  kBlendUse = 32      ///< of a colour attachment that is blended
};

/// A component of a pixel or texel, which never lies in two words of 32 bits.
struct ComponentBits {
  std::uint8_t shift = 0, bits = 0;
  Numeric numeric = Numeric::kNone;
};

/// A pixel as an image stores it, from its first byte on; one of less than four bytes is in the low bits of
/// the first word. What the format does not fill is 0.
struct PixelCode {
  std::array<std::uint32_t, 4> word{};
  friend bool operator==(const PixelCode&, const PixelCode&) = default;
};

struct FormatInfo {
  std::string_view name;      ///< Vulkan's, without VK_FORMAT_
  std::uint8_t bytes = 0;     ///< of a texel, pixel or attribute; of a block where `block_width` is not 1
  std::uint8_t channels = 0;  ///< 1..4; those that lack read as (0, 0, 0, 1)
  std::uint8_t uses = 0;      ///< of `FormatUse`
  Numeric numeric = Numeric::kNone;
  /// Images: red, green, blue and alpha. Depth is red.
  std::array<ComponentBits, 4> component{};
  ComponentBits stencil{};
  /// Texels of a compressed block, 4..12 along each side; else 1x1.
  std::uint8_t block_width = 1, block_height = 1;
  [[nodiscard]] constexpr bool may(FormatUse use) const { return (uses & use) != 0; }
};

[[nodiscard]] const FormatInfo& format_info(Format format);

[[nodiscard]] inline bool has_stencil(Format format) { return format_info(format).stencil.bits != 0; }
/// Bytes of a texel, of a vertex attribute, or of a block of a compressed format; images have 1, 2, 4, 8 or
/// 16.
[[nodiscard]] inline std::uint32_t format_bytes(Format format) { return format_info(format).bytes; }
[[nodiscard]] inline bool is_block_format(Format format) { return format_info(format).block_width != 1; }
[[nodiscard]] constexpr bool is_astc_format(Format format) {
  return format >= Format::kAstc4x4Unorm && format <= Format::kAstc12x12Srgb;
}
/// Bytes of the texels of so many columns and rows: of whole blocks, where the format has blocks.
[[nodiscard]] inline std::uint64_t format_area_bytes(Format format, std::uint32_t width,
                                                     std::uint32_t height) {
  const FormatInfo& info = format_info(format);
  const std::uint64_t columns = info.block_width, rows = info.block_height;
  return info.bytes * ((width + columns - 1) / columns) * ((height + rows - 1) / rows);
}
/// Components that an attribute of this format supplies (1..4).
[[nodiscard]] inline int format_components(Format format) { return format_info(format).channels; }
/// What a number is to a shader that reads or writes it. Of integers, registers hold the bits.
enum class NumberKind : std::uint8_t { kFloat, kUint, kSint };
[[nodiscard]] constexpr NumberKind number_kind(Numeric numeric) {
  if (numeric == Numeric::kUint) return NumberKind::kUint;
  return numeric == Numeric::kSint ? NumberKind::kSint : NumberKind::kFloat;
}
[[nodiscard]] inline NumberKind number_kind(Format format) {
  return number_kind(format_info(format).numeric);
}
[[nodiscard]] constexpr std::string_view name_of(NumberKind kind) {
  return kind == NumberKind::kFloat  ? "floats"
         : kind == NumberKind::kUint ? "unsigned integers"
                                     : "signed integers";
}
/// Do shaders read and write this format as integers? All others are floats to them.
[[nodiscard]] inline bool is_integer_format(Format format) {
  return number_kind(format) != NumberKind::kFloat;
}
/// Does an image of this format hold numbers outside 0..1 too?
[[nodiscard]] inline bool is_float_format(Format format) {
  const Numeric numeric = format_info(format).numeric;
  return numeric == Numeric::kFloat || numeric == Numeric::kUfloat || numeric == Numeric::kSharedExponent;
}
[[nodiscard]] inline bool is_srgb_format(Format format) {
  return format_info(format).numeric == Numeric::kSrgb;
}

}  // namespace quadrille::models
