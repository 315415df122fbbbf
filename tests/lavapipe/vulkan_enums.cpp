/// The stream's enumerations as Vulkan's, one to one.
#include "tests/lavapipe/vulkan_enums.h"

#include "models/base/error.h"

namespace quadrille::lavapipe {

VkFormat vk_format(traces::Format format) {
  using F = traces::Format;
  switch (format) {
    case F::kUndefined: return VK_FORMAT_UNDEFINED;
    case F::kR8G8B8A8Unorm: return VK_FORMAT_R8G8B8A8_UNORM;
    case F::kR8G8B8A8Srgb: return VK_FORMAT_R8G8B8A8_SRGB;
    case F::kD32Float: return VK_FORMAT_D32_SFLOAT;
    case F::kR32Float: return VK_FORMAT_R32_SFLOAT;
    case F::kR32G32Float: return VK_FORMAT_R32G32_SFLOAT;
    case F::kR32G32B32Float: return VK_FORMAT_R32G32B32_SFLOAT;
    case F::kR32G32B32A32Float: return VK_FORMAT_R32G32B32A32_SFLOAT;
    case F::kR8G8Unorm: return VK_FORMAT_R8G8_UNORM;
    case F::kR8G8B8A8UnormVertex: return VK_FORMAT_R8G8B8A8_UNORM;
    case F::kR16G16Unorm: return VK_FORMAT_R16G16_UNORM;
    case F::kR16G16B16A16Unorm: return VK_FORMAT_R16G16B16A16_UNORM;
    case F::kR8G8B8A8Snorm: return VK_FORMAT_R8G8B8A8_SNORM;
    case F::kR16G16B16A16Snorm: return VK_FORMAT_R16G16B16A16_SNORM;
    case F::kR8G8B8A8Uint: return VK_FORMAT_R8G8B8A8_UINT;
    case F::kR16G16B16A16Uint: return VK_FORMAT_R16G16B16A16_UINT;
    case F::kB8G8R8A8Unorm: return VK_FORMAT_B8G8R8A8_UNORM;
    case F::kB8G8R8A8Srgb: return VK_FORMAT_B8G8R8A8_SRGB;
    case F::kA2B10G10R10Unorm: return VK_FORMAT_A2B10G10R10_UNORM_PACK32;
    case F::kR8Unorm: return VK_FORMAT_R8_UNORM;
    case F::kR16Float: return VK_FORMAT_R16_SFLOAT;
    case F::kR16G16Float: return VK_FORMAT_R16G16_SFLOAT;
    case F::kR16G16B16A16Float: return VK_FORMAT_R16G16B16A16_SFLOAT;
    case F::kB10G11R11Ufloat: return VK_FORMAT_B10G11R11_UFLOAT_PACK32;
    case F::kD16Unorm: return VK_FORMAT_D16_UNORM;
    case F::kD24UnormS8Uint: return VK_FORMAT_D24_UNORM_S8_UINT;
    case F::kD32FloatS8Uint: return VK_FORMAT_D32_SFLOAT_S8_UINT;
    case F::kR8Uint: return VK_FORMAT_R8_UINT;
    case F::kR8Sint: return VK_FORMAT_R8_SINT;
    case F::kR8G8Uint: return VK_FORMAT_R8G8_UINT;
    case F::kR8G8Sint: return VK_FORMAT_R8G8_SINT;
    case F::kR8G8B8A8Sint: return VK_FORMAT_R8G8B8A8_SINT;
    case F::kR16Uint: return VK_FORMAT_R16_UINT;
    case F::kR16Sint: return VK_FORMAT_R16_SINT;
    case F::kR16G16Uint: return VK_FORMAT_R16G16_UINT;
    case F::kR16G16Sint: return VK_FORMAT_R16G16_SINT;
    case F::kR16G16B16A16Sint: return VK_FORMAT_R16G16B16A16_SINT;
    case F::kR32Uint: return VK_FORMAT_R32_UINT;
    case F::kR32Sint: return VK_FORMAT_R32_SINT;
    case F::kR32G32Uint: return VK_FORMAT_R32G32_UINT;
    case F::kR32G32Sint: return VK_FORMAT_R32G32_SINT;
    case F::kR32G32B32A32Uint: return VK_FORMAT_R32G32B32A32_UINT;
    case F::kR32G32B32A32Sint: return VK_FORMAT_R32G32B32A32_SINT;
    case F::kR8Snorm: return VK_FORMAT_R8_SNORM;
    case F::kR8Srgb: return VK_FORMAT_R8_SRGB;
    case F::kR8G8Snorm: return VK_FORMAT_R8G8_SNORM;
    case F::kR8G8Srgb: return VK_FORMAT_R8G8_SRGB;
    case F::kR16Unorm: return VK_FORMAT_R16_UNORM;
    case F::kR16Snorm: return VK_FORMAT_R16_SNORM;
    case F::kR16G16Snorm: return VK_FORMAT_R16G16_SNORM;
    case F::kR4G4Unorm: return VK_FORMAT_R4G4_UNORM_PACK8;
    case F::kR4G4B4A4Unorm: return VK_FORMAT_R4G4B4A4_UNORM_PACK16;
    case F::kB4G4R4A4Unorm: return VK_FORMAT_B4G4R4A4_UNORM_PACK16;
    case F::kR5G6B5Unorm: return VK_FORMAT_R5G6B5_UNORM_PACK16;
    case F::kB5G6R5Unorm: return VK_FORMAT_B5G6R5_UNORM_PACK16;
    case F::kR5G5B5A1Unorm: return VK_FORMAT_R5G5B5A1_UNORM_PACK16;
    case F::kB5G5R5A1Unorm: return VK_FORMAT_B5G5R5A1_UNORM_PACK16;
    case F::kA1R5G5B5Unorm: return VK_FORMAT_A1R5G5B5_UNORM_PACK16;
    case F::kA2R10G10B10Unorm: return VK_FORMAT_A2R10G10B10_UNORM_PACK32;
    case F::kA2B10G10R10Uint: return VK_FORMAT_A2B10G10R10_UINT_PACK32;
    case F::kE5B9G9R9Ufloat: return VK_FORMAT_E5B9G9R9_UFLOAT_PACK32;
    case F::kBc1RgbUnorm: return VK_FORMAT_BC1_RGB_UNORM_BLOCK;
    case F::kBc1RgbSrgb: return VK_FORMAT_BC1_RGB_SRGB_BLOCK;
    case F::kBc1RgbaUnorm: return VK_FORMAT_BC1_RGBA_UNORM_BLOCK;
    case F::kBc1RgbaSrgb: return VK_FORMAT_BC1_RGBA_SRGB_BLOCK;
    case F::kBc2Unorm: return VK_FORMAT_BC2_UNORM_BLOCK;
    case F::kBc2Srgb: return VK_FORMAT_BC2_SRGB_BLOCK;
    case F::kBc3Unorm: return VK_FORMAT_BC3_UNORM_BLOCK;
    case F::kBc3Srgb: return VK_FORMAT_BC3_SRGB_BLOCK;
    case F::kBc4Unorm: return VK_FORMAT_BC4_UNORM_BLOCK;
    case F::kBc4Snorm: return VK_FORMAT_BC4_SNORM_BLOCK;
    case F::kBc5Unorm: return VK_FORMAT_BC5_UNORM_BLOCK;
    case F::kBc5Snorm: return VK_FORMAT_BC5_SNORM_BLOCK;
    case F::kBc6hUfloat: return VK_FORMAT_BC6H_UFLOAT_BLOCK;
    case F::kBc6hSfloat: return VK_FORMAT_BC6H_SFLOAT_BLOCK;
    case F::kBc7Unorm: return VK_FORMAT_BC7_UNORM_BLOCK;
    case F::kBc7Srgb: return VK_FORMAT_BC7_SRGB_BLOCK;
    case F::kEtc2Rgb8Unorm: return VK_FORMAT_ETC2_R8G8B8_UNORM_BLOCK;
    case F::kEtc2Rgb8Srgb: return VK_FORMAT_ETC2_R8G8B8_SRGB_BLOCK;
    case F::kEtc2Rgb8A1Unorm: return VK_FORMAT_ETC2_R8G8B8A1_UNORM_BLOCK;
    case F::kEtc2Rgb8A1Srgb: return VK_FORMAT_ETC2_R8G8B8A1_SRGB_BLOCK;
    case F::kEtc2Rgba8Unorm: return VK_FORMAT_ETC2_R8G8B8A8_UNORM_BLOCK;
    case F::kEtc2Rgba8Srgb: return VK_FORMAT_ETC2_R8G8B8A8_SRGB_BLOCK;
    case F::kEacR11Unorm: return VK_FORMAT_EAC_R11_UNORM_BLOCK;
    case F::kEacR11Snorm: return VK_FORMAT_EAC_R11_SNORM_BLOCK;
    case F::kEacR11G11Unorm: return VK_FORMAT_EAC_R11G11_UNORM_BLOCK;
    case F::kEacR11G11Snorm: return VK_FORMAT_EAC_R11G11_SNORM_BLOCK;
    case F::kAstc4x4Unorm: return VK_FORMAT_ASTC_4x4_UNORM_BLOCK;
    case F::kAstc4x4Srgb: return VK_FORMAT_ASTC_4x4_SRGB_BLOCK;
    case F::kAstc5x4Unorm: return VK_FORMAT_ASTC_5x4_UNORM_BLOCK;
    case F::kAstc5x4Srgb: return VK_FORMAT_ASTC_5x4_SRGB_BLOCK;
    case F::kAstc5x5Unorm: return VK_FORMAT_ASTC_5x5_UNORM_BLOCK;
    case F::kAstc5x5Srgb: return VK_FORMAT_ASTC_5x5_SRGB_BLOCK;
    case F::kAstc6x5Unorm: return VK_FORMAT_ASTC_6x5_UNORM_BLOCK;
    case F::kAstc6x5Srgb: return VK_FORMAT_ASTC_6x5_SRGB_BLOCK;
    case F::kAstc6x6Unorm: return VK_FORMAT_ASTC_6x6_UNORM_BLOCK;
    case F::kAstc6x6Srgb: return VK_FORMAT_ASTC_6x6_SRGB_BLOCK;
    case F::kAstc8x5Unorm: return VK_FORMAT_ASTC_8x5_UNORM_BLOCK;
    case F::kAstc8x5Srgb: return VK_FORMAT_ASTC_8x5_SRGB_BLOCK;
    case F::kAstc8x6Unorm: return VK_FORMAT_ASTC_8x6_UNORM_BLOCK;
    case F::kAstc8x6Srgb: return VK_FORMAT_ASTC_8x6_SRGB_BLOCK;
    case F::kAstc8x8Unorm: return VK_FORMAT_ASTC_8x8_UNORM_BLOCK;
    case F::kAstc8x8Srgb: return VK_FORMAT_ASTC_8x8_SRGB_BLOCK;
    case F::kAstc10x5Unorm: return VK_FORMAT_ASTC_10x5_UNORM_BLOCK;
    case F::kAstc10x5Srgb: return VK_FORMAT_ASTC_10x5_SRGB_BLOCK;
    case F::kAstc10x6Unorm: return VK_FORMAT_ASTC_10x6_UNORM_BLOCK;
    case F::kAstc10x6Srgb: return VK_FORMAT_ASTC_10x6_SRGB_BLOCK;
    case F::kAstc10x8Unorm: return VK_FORMAT_ASTC_10x8_UNORM_BLOCK;
    case F::kAstc10x8Srgb: return VK_FORMAT_ASTC_10x8_SRGB_BLOCK;
    case F::kAstc10x10Unorm: return VK_FORMAT_ASTC_10x10_UNORM_BLOCK;
    case F::kAstc10x10Srgb: return VK_FORMAT_ASTC_10x10_SRGB_BLOCK;
    case F::kAstc12x10Unorm: return VK_FORMAT_ASTC_12x10_UNORM_BLOCK;
    case F::kAstc12x10Srgb: return VK_FORMAT_ASTC_12x10_SRGB_BLOCK;
    case F::kAstc12x12Unorm: return VK_FORMAT_ASTC_12x12_UNORM_BLOCK;
    case F::kAstc12x12Srgb: return VK_FORMAT_ASTC_12x12_SRGB_BLOCK;
  }
  QUADRILLE_CHECK(false, "format {}", static_cast<int>(format));
}

VkFilter vk_filter(traces::Filter filter) {
  return filter == traces::Filter::kLinear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
}

VkSamplerMipmapMode vk_mip_mode(traces::Filter filter) {
  return filter == traces::Filter::kLinear ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
}

VkSamplerAddressMode vk_wrap(traces::Wrap wrap) {
  switch (wrap) {
    case traces::Wrap::kRepeat: return VK_SAMPLER_ADDRESS_MODE_REPEAT;
    case traces::Wrap::kMirroredRepeat: return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
    case traces::Wrap::kClampToEdge: return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    case traces::Wrap::kClampToBorder: return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    case traces::Wrap::kMirrorClampToEdge: return VK_SAMPLER_ADDRESS_MODE_MIRROR_CLAMP_TO_EDGE;
  }
  QUADRILLE_CHECK(false, "wrap {}", static_cast<int>(wrap));
}

VkBorderColor vk_border(traces::BorderColor border, bool integers) {
  switch (border) {
    case traces::BorderColor::kTransparentBlack:
      return integers ? VK_BORDER_COLOR_INT_TRANSPARENT_BLACK : VK_BORDER_COLOR_FLOAT_TRANSPARENT_BLACK;
    case traces::BorderColor::kOpaqueBlack:
      return integers ? VK_BORDER_COLOR_INT_OPAQUE_BLACK : VK_BORDER_COLOR_FLOAT_OPAQUE_BLACK;
    case traces::BorderColor::kOpaqueWhite:
      return integers ? VK_BORDER_COLOR_INT_OPAQUE_WHITE : VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
    case traces::BorderColor::kOwn:
      return integers ? VK_BORDER_COLOR_INT_CUSTOM_EXT : VK_BORDER_COLOR_FLOAT_CUSTOM_EXT;
  }
  QUADRILLE_CHECK(false, "border {}", static_cast<int>(border));
}

VkImageType vk_image_type(traces::ImageKind kind) {
  switch (kind) {
    case traces::ImageKind::k1D: return VK_IMAGE_TYPE_1D;
    case traces::ImageKind::k2D: return VK_IMAGE_TYPE_2D;
    case traces::ImageKind::k3D: return VK_IMAGE_TYPE_3D;
  }
  QUADRILLE_CHECK(false, "image kind {}", static_cast<int>(kind));
}

VkComponentMapping vk_components(const models::ComponentMapping& components) {
  const auto swizzle = [&](std::size_t c) {
    switch (components.at(c)) {
      case models::ComponentSource::kRed: return VK_COMPONENT_SWIZZLE_R;
      case models::ComponentSource::kGreen: return VK_COMPONENT_SWIZZLE_G;
      case models::ComponentSource::kBlue: return VK_COMPONENT_SWIZZLE_B;
      case models::ComponentSource::kAlpha: return VK_COMPONENT_SWIZZLE_A;
      case models::ComponentSource::kZero: return VK_COMPONENT_SWIZZLE_ZERO;
      case models::ComponentSource::kOne: return VK_COMPONENT_SWIZZLE_ONE;
    }
    return VK_COMPONENT_SWIZZLE_IDENTITY;
  };
  return {swizzle(0), swizzle(1), swizzle(2), swizzle(3)};
}

VkImageViewType vk_view_type(traces::ViewKind kind) {
  switch (kind) {
    case traces::ViewKind::k1D: return VK_IMAGE_VIEW_TYPE_1D;
    case traces::ViewKind::k2D:
    case traces::ViewKind::k2DMultisampled: return VK_IMAGE_VIEW_TYPE_2D;
    case traces::ViewKind::k3D: return VK_IMAGE_VIEW_TYPE_3D;
    case traces::ViewKind::kCube: return VK_IMAGE_VIEW_TYPE_CUBE;
    case traces::ViewKind::k1DArray: return VK_IMAGE_VIEW_TYPE_1D_ARRAY;
    case traces::ViewKind::k2DArray:
    case traces::ViewKind::k2DMultisampledArray: return VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    case traces::ViewKind::kCubeArray: return VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
  }
  QUADRILLE_CHECK(false, "view kind {}", static_cast<int>(kind));
}

VkPolygonMode vk_polygon_mode(traces::PolygonMode mode) {
  switch (mode) {
    case traces::PolygonMode::kFill: return VK_POLYGON_MODE_FILL;
    case traces::PolygonMode::kLine: return VK_POLYGON_MODE_LINE;
    case traces::PolygonMode::kPoint: return VK_POLYGON_MODE_POINT;
  }
  QUADRILLE_CHECK(false, "polygon mode {}", static_cast<int>(mode));
}

VkLineRasterizationModeEXT vk_line_mode(traces::LineMode mode) {
  switch (mode) {
    case traces::LineMode::kBresenham: return VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT;
    case traces::LineMode::kRectangular: return VK_LINE_RASTERIZATION_MODE_RECTANGULAR_EXT;
    case traces::LineMode::kSmooth: return VK_LINE_RASTERIZATION_MODE_RECTANGULAR_SMOOTH_EXT;
  }
  QUADRILLE_CHECK(false, "line mode {}", static_cast<int>(mode));
}

VkPrimitiveTopology vk_topology(traces::Topology topology) {
  switch (topology) {
    case traces::Topology::kTriangleList: return VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    case traces::Topology::kTriangleStrip: return VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
    case traces::Topology::kTriangleFan: return VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN;
    case traces::Topology::kPointList: return VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
    case traces::Topology::kLineList: return VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
    case traces::Topology::kLineStrip: return VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
  }
  QUADRILLE_CHECK(false, "topology {}", static_cast<int>(topology));
}

VkCullModeFlags vk_cull(traces::CullMode cull) {
  switch (cull) {
    case traces::CullMode::kNone: return VK_CULL_MODE_NONE;
    case traces::CullMode::kFront: return VK_CULL_MODE_FRONT_BIT;
    case traces::CullMode::kBack: return VK_CULL_MODE_BACK_BIT;
  }
  QUADRILLE_CHECK(false, "cull mode {}", static_cast<int>(cull));
}

VkFrontFace vk_front(traces::FrontFace front) {
  return front == traces::FrontFace::kClockwise ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE;
}

VkCompareOp vk_compare(traces::CompareOp compare) {
  using C = traces::CompareOp;
  switch (compare) {
    case C::kNever: return VK_COMPARE_OP_NEVER;
    case C::kLess: return VK_COMPARE_OP_LESS;
    case C::kEqual: return VK_COMPARE_OP_EQUAL;
    case C::kLessOrEqual: return VK_COMPARE_OP_LESS_OR_EQUAL;
    case C::kGreater: return VK_COMPARE_OP_GREATER;
    case C::kNotEqual: return VK_COMPARE_OP_NOT_EQUAL;
    case C::kGreaterOrEqual: return VK_COMPARE_OP_GREATER_OR_EQUAL;
    case C::kAlways: return VK_COMPARE_OP_ALWAYS;
  }
  QUADRILLE_CHECK(false, "compare operation {}", static_cast<int>(compare));
}

VkBlendFactor vk_blend_factor(traces::BlendFactor factor) {
  using B = traces::BlendFactor;
  switch (factor) {
    case B::kZero: return VK_BLEND_FACTOR_ZERO;
    case B::kOne: return VK_BLEND_FACTOR_ONE;
    case B::kSrcColor: return VK_BLEND_FACTOR_SRC_COLOR;
    case B::kOneMinusSrcColor: return VK_BLEND_FACTOR_ONE_MINUS_SRC_COLOR;
    case B::kDstColor: return VK_BLEND_FACTOR_DST_COLOR;
    case B::kOneMinusDstColor: return VK_BLEND_FACTOR_ONE_MINUS_DST_COLOR;
    case B::kSrcAlpha: return VK_BLEND_FACTOR_SRC_ALPHA;
    case B::kOneMinusSrcAlpha: return VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    case B::kDstAlpha: return VK_BLEND_FACTOR_DST_ALPHA;
    case B::kOneMinusDstAlpha: return VK_BLEND_FACTOR_ONE_MINUS_DST_ALPHA;
    case B::kConstantColor: return VK_BLEND_FACTOR_CONSTANT_COLOR;
    case B::kOneMinusConstantColor: return VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_COLOR;
    case B::kConstantAlpha: return VK_BLEND_FACTOR_CONSTANT_ALPHA;
    case B::kOneMinusConstantAlpha: return VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_ALPHA;
    case B::kSrcAlphaSaturate: return VK_BLEND_FACTOR_SRC_ALPHA_SATURATE;
    case B::kSrc1Color: return VK_BLEND_FACTOR_SRC1_COLOR;
    case B::kOneMinusSrc1Color: return VK_BLEND_FACTOR_ONE_MINUS_SRC1_COLOR;
    case B::kSrc1Alpha: return VK_BLEND_FACTOR_SRC1_ALPHA;
    case B::kOneMinusSrc1Alpha: return VK_BLEND_FACTOR_ONE_MINUS_SRC1_ALPHA;
  }
  QUADRILLE_CHECK(false, "blend factor {}", static_cast<int>(factor));
}

VkStencilOp vk_stencil_op(traces::StencilOp op) {
  using S = traces::StencilOp;
  switch (op) {
    case S::kKeep: return VK_STENCIL_OP_KEEP;
    case S::kZero: return VK_STENCIL_OP_ZERO;
    case S::kReplace: return VK_STENCIL_OP_REPLACE;
    case S::kIncrementClamp: return VK_STENCIL_OP_INCREMENT_AND_CLAMP;
    case S::kDecrementClamp: return VK_STENCIL_OP_DECREMENT_AND_CLAMP;
    case S::kInvert: return VK_STENCIL_OP_INVERT;
    case S::kIncrementWrap: return VK_STENCIL_OP_INCREMENT_AND_WRAP;
    case S::kDecrementWrap: return VK_STENCIL_OP_DECREMENT_AND_WRAP;
  }
  QUADRILLE_CHECK(false, "stencil operation {}", static_cast<int>(op));
}

VkLogicOp vk_logic_op(traces::LogicOp op) {
  // The order is Vulkan's.
  return static_cast<VkLogicOp>(op);
}

VkBlendOp vk_blend_op(traces::BlendOp op) {
  switch (op) {
    case traces::BlendOp::kAdd: return VK_BLEND_OP_ADD;
    case traces::BlendOp::kSubtract: return VK_BLEND_OP_SUBTRACT;
    case traces::BlendOp::kReverseSubtract: return VK_BLEND_OP_REVERSE_SUBTRACT;
    case traces::BlendOp::kMin: return VK_BLEND_OP_MIN;
    case traces::BlendOp::kMax: return VK_BLEND_OP_MAX;
  }
  QUADRILLE_CHECK(false, "blend operation {}", static_cast<int>(op));
}

VkIndexType vk_index_type(traces::IndexType type) {
  switch (type) {
    case traces::IndexType::kUint8: return VK_INDEX_TYPE_UINT8_EXT;
    case traces::IndexType::kUint16: return VK_INDEX_TYPE_UINT16;
    case traces::IndexType::kUint32: return VK_INDEX_TYPE_UINT32;
  }
  QUADRILLE_CHECK(false, "index type {}", static_cast<int>(type));
}

}  // namespace quadrille::lavapipe
