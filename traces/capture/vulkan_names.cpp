#include "traces/capture/vulkan_names.h"

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "models/base/error.h"

namespace quadrille::capture {
namespace {

using traces::Format;

/// Enumerations of the stream that count as Vulkan's do.
template <class E>
E same_number(std::uint32_t value, E last, const char* what) {
  if (value > static_cast<std::uint32_t>(last)) throw user_error("{} {} is not supported", what, value);
  return static_cast<E>(value);
}

struct FormatRow {
  VkFormat vulkan;
  Format ours;
};
/// What attributes and images both have, or images alone.
constexpr FormatRow kImageFormats[] = {
    {VK_FORMAT_R8G8B8A8_UNORM, Format::kR8G8B8A8Unorm},
    {VK_FORMAT_R8G8B8A8_SRGB, Format::kR8G8B8A8Srgb},
    {VK_FORMAT_B8G8R8A8_UNORM, Format::kB8G8R8A8Unorm},
    {VK_FORMAT_B8G8R8A8_SRGB, Format::kB8G8R8A8Srgb},
    {VK_FORMAT_A2B10G10R10_UNORM_PACK32, Format::kA2B10G10R10Unorm},
    {VK_FORMAT_R8_UNORM, Format::kR8Unorm},
    {VK_FORMAT_R8G8_UNORM, Format::kR8G8Unorm},
    {VK_FORMAT_R16_SFLOAT, Format::kR16Float},
    {VK_FORMAT_R16G16_SFLOAT, Format::kR16G16Float},
    {VK_FORMAT_R16G16B16A16_SFLOAT, Format::kR16G16B16A16Float},
    {VK_FORMAT_R32_SFLOAT, Format::kR32Float},
    {VK_FORMAT_R32G32_SFLOAT, Format::kR32G32Float},
    {VK_FORMAT_R32G32B32A32_SFLOAT, Format::kR32G32B32A32Float},
    {VK_FORMAT_B10G11R11_UFLOAT_PACK32, Format::kB10G11R11Ufloat},
    {VK_FORMAT_R8_UINT, Format::kR8Uint},
    {VK_FORMAT_R8_SINT, Format::kR8Sint},
    {VK_FORMAT_R8G8_UINT, Format::kR8G8Uint},
    {VK_FORMAT_R8G8_SINT, Format::kR8G8Sint},
    {VK_FORMAT_R8G8B8A8_UINT, Format::kR8G8B8A8Uint},
    {VK_FORMAT_R8G8B8A8_SINT, Format::kR8G8B8A8Sint},
    {VK_FORMAT_R16_UINT, Format::kR16Uint},
    {VK_FORMAT_R16_SINT, Format::kR16Sint},
    {VK_FORMAT_R16G16_UINT, Format::kR16G16Uint},
    {VK_FORMAT_R16G16_SINT, Format::kR16G16Sint},
    {VK_FORMAT_R16G16B16A16_UINT, Format::kR16G16B16A16Uint},
    {VK_FORMAT_R16G16B16A16_SINT, Format::kR16G16B16A16Sint},
    {VK_FORMAT_R32_UINT, Format::kR32Uint},
    {VK_FORMAT_R32_SINT, Format::kR32Sint},
    {VK_FORMAT_R32G32_UINT, Format::kR32G32Uint},
    {VK_FORMAT_R32G32_SINT, Format::kR32G32Sint},
    {VK_FORMAT_R32G32B32A32_UINT, Format::kR32G32B32A32Uint},
    {VK_FORMAT_R32G32B32A32_SINT, Format::kR32G32B32A32Sint},
    {VK_FORMAT_A8B8G8R8_UNORM_PACK32, Format::kR8G8B8A8Unorm},  // the same bytes
    {VK_FORMAT_A8B8G8R8_SRGB_PACK32, Format::kR8G8B8A8Srgb},
    {VK_FORMAT_R8_SNORM, Format::kR8Snorm},
    {VK_FORMAT_R8_SRGB, Format::kR8Srgb},
    {VK_FORMAT_R8G8_SNORM, Format::kR8G8Snorm},
    {VK_FORMAT_R8G8_SRGB, Format::kR8G8Srgb},
    {VK_FORMAT_R8G8B8A8_SNORM, Format::kR8G8B8A8Snorm},
    {VK_FORMAT_R16_UNORM, Format::kR16Unorm},
    {VK_FORMAT_R16_SNORM, Format::kR16Snorm},
    {VK_FORMAT_R16G16_UNORM, Format::kR16G16Unorm},
    {VK_FORMAT_R16G16_SNORM, Format::kR16G16Snorm},
    {VK_FORMAT_R16G16B16A16_UNORM, Format::kR16G16B16A16Unorm},
    {VK_FORMAT_R16G16B16A16_SNORM, Format::kR16G16B16A16Snorm},
    {VK_FORMAT_R4G4_UNORM_PACK8, Format::kR4G4Unorm},
    {VK_FORMAT_R4G4B4A4_UNORM_PACK16, Format::kR4G4B4A4Unorm},
    {VK_FORMAT_B4G4R4A4_UNORM_PACK16, Format::kB4G4R4A4Unorm},
    {VK_FORMAT_R5G6B5_UNORM_PACK16, Format::kR5G6B5Unorm},
    {VK_FORMAT_B5G6R5_UNORM_PACK16, Format::kB5G6R5Unorm},
    {VK_FORMAT_R5G5B5A1_UNORM_PACK16, Format::kR5G5B5A1Unorm},
    {VK_FORMAT_B5G5R5A1_UNORM_PACK16, Format::kB5G5R5A1Unorm},
    {VK_FORMAT_A1R5G5B5_UNORM_PACK16, Format::kA1R5G5B5Unorm},
    {VK_FORMAT_A2R10G10B10_UNORM_PACK32, Format::kA2R10G10B10Unorm},
    {VK_FORMAT_A2B10G10R10_UINT_PACK32, Format::kA2B10G10R10Uint},
    {VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, Format::kE5B9G9R9Ufloat},
    {VK_FORMAT_BC1_RGB_UNORM_BLOCK, Format::kBc1RgbUnorm},
    {VK_FORMAT_BC1_RGB_SRGB_BLOCK, Format::kBc1RgbSrgb},
    {VK_FORMAT_BC1_RGBA_UNORM_BLOCK, Format::kBc1RgbaUnorm},
    {VK_FORMAT_BC1_RGBA_SRGB_BLOCK, Format::kBc1RgbaSrgb},
    {VK_FORMAT_BC2_UNORM_BLOCK, Format::kBc2Unorm},
    {VK_FORMAT_BC2_SRGB_BLOCK, Format::kBc2Srgb},
    {VK_FORMAT_BC3_UNORM_BLOCK, Format::kBc3Unorm},
    {VK_FORMAT_BC3_SRGB_BLOCK, Format::kBc3Srgb},
    {VK_FORMAT_BC4_UNORM_BLOCK, Format::kBc4Unorm},
    {VK_FORMAT_BC4_SNORM_BLOCK, Format::kBc4Snorm},
    {VK_FORMAT_BC5_UNORM_BLOCK, Format::kBc5Unorm},
    {VK_FORMAT_BC5_SNORM_BLOCK, Format::kBc5Snorm},
    {VK_FORMAT_BC6H_UFLOAT_BLOCK, Format::kBc6hUfloat},
    {VK_FORMAT_BC6H_SFLOAT_BLOCK, Format::kBc6hSfloat},
    {VK_FORMAT_BC7_UNORM_BLOCK, Format::kBc7Unorm},
    {VK_FORMAT_BC7_SRGB_BLOCK, Format::kBc7Srgb},
    {VK_FORMAT_ETC2_R8G8B8_UNORM_BLOCK, Format::kEtc2Rgb8Unorm},
    {VK_FORMAT_ETC2_R8G8B8_SRGB_BLOCK, Format::kEtc2Rgb8Srgb},
    {VK_FORMAT_ETC2_R8G8B8A1_UNORM_BLOCK, Format::kEtc2Rgb8A1Unorm},
    {VK_FORMAT_ETC2_R8G8B8A1_SRGB_BLOCK, Format::kEtc2Rgb8A1Srgb},
    {VK_FORMAT_ETC2_R8G8B8A8_UNORM_BLOCK, Format::kEtc2Rgba8Unorm},
    {VK_FORMAT_ETC2_R8G8B8A8_SRGB_BLOCK, Format::kEtc2Rgba8Srgb},
    {VK_FORMAT_EAC_R11_UNORM_BLOCK, Format::kEacR11Unorm},
    {VK_FORMAT_EAC_R11_SNORM_BLOCK, Format::kEacR11Snorm},
    {VK_FORMAT_EAC_R11G11_UNORM_BLOCK, Format::kEacR11G11Unorm},
    {VK_FORMAT_EAC_R11G11_SNORM_BLOCK, Format::kEacR11G11Snorm},
    {VK_FORMAT_ASTC_4x4_UNORM_BLOCK, Format::kAstc4x4Unorm},
    {VK_FORMAT_ASTC_4x4_SRGB_BLOCK, Format::kAstc4x4Srgb},
    {VK_FORMAT_ASTC_5x4_UNORM_BLOCK, Format::kAstc5x4Unorm},
    {VK_FORMAT_ASTC_5x4_SRGB_BLOCK, Format::kAstc5x4Srgb},
    {VK_FORMAT_ASTC_5x5_UNORM_BLOCK, Format::kAstc5x5Unorm},
    {VK_FORMAT_ASTC_5x5_SRGB_BLOCK, Format::kAstc5x5Srgb},
    {VK_FORMAT_ASTC_6x5_UNORM_BLOCK, Format::kAstc6x5Unorm},
    {VK_FORMAT_ASTC_6x5_SRGB_BLOCK, Format::kAstc6x5Srgb},
    {VK_FORMAT_ASTC_6x6_UNORM_BLOCK, Format::kAstc6x6Unorm},
    {VK_FORMAT_ASTC_6x6_SRGB_BLOCK, Format::kAstc6x6Srgb},
    {VK_FORMAT_ASTC_8x5_UNORM_BLOCK, Format::kAstc8x5Unorm},
    {VK_FORMAT_ASTC_8x5_SRGB_BLOCK, Format::kAstc8x5Srgb},
    {VK_FORMAT_ASTC_8x6_UNORM_BLOCK, Format::kAstc8x6Unorm},
    {VK_FORMAT_ASTC_8x6_SRGB_BLOCK, Format::kAstc8x6Srgb},
    {VK_FORMAT_ASTC_8x8_UNORM_BLOCK, Format::kAstc8x8Unorm},
    {VK_FORMAT_ASTC_8x8_SRGB_BLOCK, Format::kAstc8x8Srgb},
    {VK_FORMAT_ASTC_10x5_UNORM_BLOCK, Format::kAstc10x5Unorm},
    {VK_FORMAT_ASTC_10x5_SRGB_BLOCK, Format::kAstc10x5Srgb},
    {VK_FORMAT_ASTC_10x6_UNORM_BLOCK, Format::kAstc10x6Unorm},
    {VK_FORMAT_ASTC_10x6_SRGB_BLOCK, Format::kAstc10x6Srgb},
    {VK_FORMAT_ASTC_10x8_UNORM_BLOCK, Format::kAstc10x8Unorm},
    {VK_FORMAT_ASTC_10x8_SRGB_BLOCK, Format::kAstc10x8Srgb},
    {VK_FORMAT_ASTC_10x10_UNORM_BLOCK, Format::kAstc10x10Unorm},
    {VK_FORMAT_ASTC_10x10_SRGB_BLOCK, Format::kAstc10x10Srgb},
    {VK_FORMAT_ASTC_12x10_UNORM_BLOCK, Format::kAstc12x10Unorm},
    {VK_FORMAT_ASTC_12x10_SRGB_BLOCK, Format::kAstc12x10Srgb},
    {VK_FORMAT_ASTC_12x12_UNORM_BLOCK, Format::kAstc12x12Unorm},
    {VK_FORMAT_ASTC_12x12_SRGB_BLOCK, Format::kAstc12x12Srgb},
    {VK_FORMAT_D16_UNORM, Format::kD16Unorm},
    {VK_FORMAT_D32_SFLOAT, Format::kD32Float},
    // 24 bits of depth, whatever is done with the other eight
    {VK_FORMAT_X8_D24_UNORM_PACK32, Format::kD24UnormS8Uint},
    {VK_FORMAT_D24_UNORM_S8_UINT, Format::kD24UnormS8Uint},
    {VK_FORMAT_D32_SFLOAT_S8_UINT, Format::kD32FloatS8Uint},
};
constexpr FormatRow kAttributeFormats[] = {
    {VK_FORMAT_R32_SFLOAT, Format::kR32Float},
    {VK_FORMAT_R32G32_SFLOAT, Format::kR32G32Float},
    {VK_FORMAT_R32G32B32_SFLOAT, Format::kR32G32B32Float},
    {VK_FORMAT_R32G32B32A32_SFLOAT, Format::kR32G32B32A32Float},
    {VK_FORMAT_R8G8_UNORM, Format::kR8G8Unorm},
    {VK_FORMAT_R8G8B8A8_UNORM, Format::kR8G8B8A8UnormVertex},
    {VK_FORMAT_A8B8G8R8_UNORM_PACK32, Format::kR8G8B8A8UnormVertex},  // the same bytes
    {VK_FORMAT_R16G16_UNORM, Format::kR16G16Unorm},
    {VK_FORMAT_R16G16B16A16_UNORM, Format::kR16G16B16A16Unorm},
    {VK_FORMAT_R8G8B8A8_SNORM, Format::kR8G8B8A8Snorm},
    {VK_FORMAT_R16G16B16A16_SNORM, Format::kR16G16B16A16Snorm},
    {VK_FORMAT_R8G8B8A8_UINT, Format::kR8G8B8A8Uint},
    {VK_FORMAT_R16G16B16A16_UINT, Format::kR16G16B16A16Uint},
    {VK_FORMAT_R8G8B8A8_SINT, Format::kR8G8B8A8Sint},
    {VK_FORMAT_R16G16B16A16_SINT, Format::kR16G16B16A16Sint},
    {VK_FORMAT_R32_UINT, Format::kR32Uint},
    {VK_FORMAT_R32_SINT, Format::kR32Sint},
    {VK_FORMAT_R32G32_UINT, Format::kR32G32Uint},
    {VK_FORMAT_R32G32_SINT, Format::kR32G32Sint},
    {VK_FORMAT_R32G32B32A32_UINT, Format::kR32G32B32A32Uint},
    {VK_FORMAT_R32G32B32A32_SINT, Format::kR32G32B32A32Sint},
};

}  // namespace

Format image_format(std::uint32_t format) {
  const auto* row = std::ranges::find_if(
      kImageFormats, [=](const FormatRow& r) { return static_cast<std::uint32_t>(r.vulkan) == format; });
  return row == std::end(kImageFormats) ? Format::kUndefined : row->ours;
}

Format attribute_format(std::uint32_t format) {
  const auto* row = std::ranges::find_if(
      kAttributeFormats, [=](const FormatRow& r) { return static_cast<std::uint32_t>(r.vulkan) == format; });
  return row == std::end(kAttributeFormats) ? Format::kUndefined : row->ours;
}

std::string format_name(std::uint32_t format) {
  const Format known = image_format(format);
  return known == Format::kUndefined ? fmt::format("VkFormat {}", format)
                                     : fmt::format("VK_FORMAT_{}", models::format_info(known).name);
}

traces::Topology topology_of(std::uint32_t value) {
  using traces::Topology;
  constexpr std::array kTopologies{Topology::kPointList,    Topology::kLineList,      Topology::kLineStrip,
                                   Topology::kTriangleList, Topology::kTriangleStrip, Topology::kTriangleFan};
  if (value >= kTopologies.size()) throw user_error("VkPrimitiveTopology {} is not supported", value);
  return kTopologies[value];
}

traces::CompareOp compare_of(std::uint32_t value) {
  return same_number(value, traces::CompareOp::kAlways, "VkCompareOp");
}
traces::StencilOp stencil_op_of(std::uint32_t value) {
  return same_number(value, traces::StencilOp::kDecrementWrap, "VkStencilOp");
}
traces::BlendFactor blend_factor_of(std::uint32_t value) {
  return same_number(value, models::kLastBlendFactor, "VkBlendFactor");
}
traces::BlendOp blend_op_of(std::uint32_t value) {
  return same_number(value, traces::BlendOp::kMax, "VkBlendOp");
}
traces::LogicOp logic_op_of(std::uint32_t value) {
  return same_number(value, traces::LogicOp::kSet, "VkLogicOp");
}
traces::CullMode cull_of(std::uint32_t value) {
  return same_number(value, traces::CullMode::kBack, "VkCullModeFlags (front and back)");
}
traces::PolygonMode polygon_mode_of(std::uint32_t value) {
  return same_number(value, traces::PolygonMode::kPoint, "VkPolygonMode");
}
traces::IndexType index_type_of(std::uint32_t value) {
  if (value == VK_INDEX_TYPE_UINT8_EXT) return traces::IndexType::kUint8;
  if (value == VK_INDEX_TYPE_UINT16) return traces::IndexType::kUint16;
  if (value == VK_INDEX_TYPE_UINT32) return traces::IndexType::kUint32;
  throw user_error("VkIndexType {} is not supported", value);
}

/// What the device chooses is the rule for rectangles. [VK1.3 #primsrast-lines-basic]
traces::LineMode line_mode_of(std::uint32_t value) {
  switch (value) {
    case VK_LINE_RASTERIZATION_MODE_DEFAULT_EXT:
    case VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT: return traces::LineMode::kRectangular;
    case VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT: return traces::LineMode::kBresenham;
    case VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT: return traces::LineMode::kSmooth;
    default: throw user_error("VkLineRasterizationModeEXT {} is not supported", value);
  }
}

traces::LoadOp load_of(std::uint32_t value) {
  if (value == VK_ATTACHMENT_LOAD_OP_LOAD) return traces::LoadOp::kLoad;
  return value == VK_ATTACHMENT_LOAD_OP_CLEAR ? traces::LoadOp::kClear : traces::LoadOp::kDontCare;
}
traces::StoreOp store_of(std::uint32_t value) {
  return value == VK_ATTACHMENT_STORE_OP_STORE ? traces::StoreOp::kStore : traces::StoreOp::kDiscard;
}

namespace {

traces::Wrap wrap_of(std::uint32_t value, std::string& unsupported) {
  switch (value) {
    case VK_SAMPLER_ADDRESS_MODE_REPEAT: return traces::Wrap::kRepeat;
    case VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT: return traces::Wrap::kMirroredRepeat;
    case VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE: return traces::Wrap::kClampToEdge;
    case VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER: return traces::Wrap::kClampToBorder;
    case VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE: return traces::Wrap::kMirrorClampToEdge;
    default: unsupported = fmt::format("VkSamplerAddressMode {}", value); return traces::Wrap::kClampToEdge;
  }
}
using Color = std::array<std::uint32_t, 4>;
/// One of the three colours that have names, or any other.
models::BorderColor custom_border(const Value& info, Color& color) {
  const Value* const custom = info.next(VK_STRUCTURE_TYPE_SAMPLER_CUSTOM_BORDER_COLOR_CREATE_INFO_EXT);
  const bool integers = info["borderColor"].u32() == VK_BORDER_COLOR_INT_CUSTOM_EXT;
  const std::uint32_t one = integers ? 1 : std::bit_cast<std::uint32_t>(1.0f);
  for (std::size_t c = 0; custom != nullptr && c < 4 && c < (*custom)["customBorderColor"].size(); ++c)
    color.at(c) = (*custom)["customBorderColor"].u32(c);
  if (color == Color{}) return models::BorderColor::kTransparentBlack;
  if (color == Color{0, 0, 0, one}) return models::BorderColor::kOpaqueBlack;
  if (color == Color{one, one, one, one}) return models::BorderColor::kOpaqueWhite;
  return models::BorderColor::kOwn;
}
/// Only where a wrap asks for it: elsewhere programs leave anything there.
models::BorderColor border_of(const Value& info, Color& color, std::string& unsupported) {
  const std::uint32_t value = info["borderColor"].u32();
  switch (value) {
    case VK_BORDER_COLOR_FLOAT_CUSTOM_EXT:
    case VK_BORDER_COLOR_INT_CUSTOM_EXT: return custom_border(info, color);
    case VK_BORDER_COLOR_FLOAT_TRANSPARENT_BLACK:
    case VK_BORDER_COLOR_INT_TRANSPARENT_BLACK: return models::BorderColor::kTransparentBlack;
    case VK_BORDER_COLOR_FLOAT_OPAQUE_BLACK:
    case VK_BORDER_COLOR_INT_OPAQUE_BLACK: return models::BorderColor::kOpaqueBlack;
    case VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE:
    case VK_BORDER_COLOR_INT_OPAQUE_WHITE: return models::BorderColor::kOpaqueWhite;
    default: unsupported = fmt::format("VkBorderColor {}", value); return {};
  }
}
traces::Filter filter_of(std::uint32_t value, std::string& unsupported) {
  if (value == VK_FILTER_NEAREST) return traces::Filter::kNearest;
  if (value != VK_FILTER_LINEAR) unsupported = fmt::format("VkFilter {}", value);
  return traces::Filter::kLinear;
}

}  // namespace

traces::ViewKind view_kind_of(std::uint32_t value, std::uint32_t samples) {
  using traces::ViewKind;
  const bool multisampled = samples > 1;
  switch (value) {
    case VK_IMAGE_VIEW_TYPE_1D: return ViewKind::k1D;
    case VK_IMAGE_VIEW_TYPE_2D: return multisampled ? ViewKind::k2DMultisampled : ViewKind::k2D;
    case VK_IMAGE_VIEW_TYPE_3D: return ViewKind::k3D;
    case VK_IMAGE_VIEW_TYPE_CUBE: return ViewKind::kCube;
    case VK_IMAGE_VIEW_TYPE_1D_ARRAY: return ViewKind::k1DArray;
    case VK_IMAGE_VIEW_TYPE_2D_ARRAY:
      return multisampled ? ViewKind::k2DMultisampledArray : ViewKind::k2DArray;
    case VK_IMAGE_VIEW_TYPE_CUBE_ARRAY: return ViewKind::kCubeArray;
    default: throw user_error("VkImageViewType {} is not supported", value);
  }
}

models::ComponentSource component_of(std::uint32_t value, std::size_t c) {
  using models::ComponentSource;
  switch (value) {
    case VK_COMPONENT_SWIZZLE_IDENTITY: return static_cast<ComponentSource>(c);
    case VK_COMPONENT_SWIZZLE_ZERO: return ComponentSource::kZero;
    case VK_COMPONENT_SWIZZLE_ONE: return ComponentSource::kOne;
    case VK_COMPONENT_SWIZZLE_R: return ComponentSource::kRed;
    case VK_COMPONENT_SWIZZLE_G: return ComponentSource::kGreen;
    case VK_COMPONENT_SWIZZLE_B: return ComponentSource::kBlue;
    case VK_COMPONENT_SWIZZLE_A: return ComponentSource::kAlpha;
    default: throw user_error("VkComponentSwizzle {} is not supported", value);
  }
}

traces::ImageKind image_kind_of(std::uint32_t value) {
  switch (value) {
    case VK_IMAGE_TYPE_1D: return traces::ImageKind::k1D;
    case VK_IMAGE_TYPE_2D: return traces::ImageKind::k2D;
    case VK_IMAGE_TYPE_3D: return traces::ImageKind::k3D;
    default: throw user_error("VkImageType {} is not supported", value);
  }
}

SamplerObject sampler_of(const Value& info) {
  SamplerObject made;
  traces::Sampler& state = made.state;
  state.mag = filter_of(info["magFilter"].u32(), made.unsupported);
  state.min = filter_of(info["minFilter"].u32(), made.unsupported);
  state.mip = info["mipmapMode"].u32() == VK_SAMPLER_MIPMAP_MODE_LINEAR ? traces::Filter::kLinear
                                                                        : traces::Filter::kNearest;
  state.wrap_u = wrap_of(info["addressModeU"].u32(), made.unsupported);
  state.wrap_v = wrap_of(info["addressModeV"].u32(), made.unsupported);
  state.wrap_w = wrap_of(info["addressModeW"].u32(), made.unsupported);
  if (models::has_border(state) || state.wrap_w == models::Wrap::kClampToBorder)
    state.border = border_of(info, state.border_bits, made.unsupported);
  state.lod_bias = info["mipLodBias"].f32();
  state.min_lod = info["minLod"].f32();
  state.max_lod = info["maxLod"].f32();
  if (info["compareEnable"].flag()) state.compare = compare_of(info["compareOp"].u32());
  if (info["anisotropyEnable"].flag()) state.max_anisotropy = info["maxAnisotropy"].f32();
  state.seamless = (info["flags"].u32() & VK_SAMPLER_CREATE_NON_SEAMLESS_CUBE_MAP_BIT_EXT) == 0;
  if (info["unnormalizedCoordinates"].flag()) made.unsupported = "unnormalised coordinates";
  if (info.next(VK_STRUCTURE_TYPE_SAMPLER_REDUCTION_MODE_CREATE_INFO) != nullptr)
    made.unsupported = "a reduction mode";
  return made;
}

bool changes_no_picture(std::string_view command) {
  constexpr std::array<std::string_view, 17> kSilent{"CmdBeginQuery",
                                                     "CmdEndQuery",
                                                     "CmdBeginQueryIndexedEXT",
                                                     "CmdEndQueryIndexedEXT",
                                                     "CmdCopyQueryPoolResults",
                                                     "CmdPipelineBarrier",
                                                     "CmdPipelineBarrier2",
                                                     "CmdPipelineBarrier2KHR",
                                                     "CmdSetEvent",
                                                     "CmdResetEvent",
                                                     "CmdWaitEvents",
                                                     "CmdWriteTimestamp",
                                                     "CmdResetQueryPool",
                                                     "CmdSetLineStippleEXT",
                                                     "CmdSetPatchControlPointsEXT",
                                                     "CmdSetDeviceMask",
                                                     "CmdWriteTimestamp2"};
  return std::ranges::find(kSilent, command) != kSilent.end();
}

}  // namespace quadrille::capture
