/// The stream's enumerations as Vulkan's, one to one.
#pragma once

#include <vulkan/vulkan.h>

#include "traces/command_stream.h"

namespace quadrille::lavapipe {

/// `kUndefined` maps to VK_FORMAT_UNDEFINED.
[[nodiscard]] VkFormat vk_format(traces::Format format);
[[nodiscard]] VkFilter vk_filter(traces::Filter filter);
[[nodiscard]] VkSamplerMipmapMode vk_mip_mode(traces::Filter filter);
[[nodiscard]] VkSamplerAddressMode vk_wrap(traces::Wrap wrap);
/// `integers`: of an image that holds integers.
[[nodiscard]] VkBorderColor vk_border(traces::BorderColor border, bool integers);
[[nodiscard]] VkImageType vk_image_type(traces::ImageKind kind);
[[nodiscard]] VkImageViewType vk_view_type(traces::ViewKind kind);
[[nodiscard]] VkComponentMapping vk_components(const models::ComponentMapping& components);
[[nodiscard]] VkPrimitiveTopology vk_topology(traces::Topology topology);
[[nodiscard]] VkPolygonMode vk_polygon_mode(traces::PolygonMode mode);
[[nodiscard]] VkLineRasterizationModeEXT vk_line_mode(traces::LineMode mode);
[[nodiscard]] VkCullModeFlags vk_cull(traces::CullMode cull);
[[nodiscard]] VkFrontFace vk_front(traces::FrontFace front);
[[nodiscard]] VkCompareOp vk_compare(traces::CompareOp compare);
[[nodiscard]] VkBlendFactor vk_blend_factor(traces::BlendFactor factor);
[[nodiscard]] VkBlendOp vk_blend_op(traces::BlendOp op);
[[nodiscard]] VkStencilOp vk_stencil_op(traces::StencilOp op);
[[nodiscard]] VkLogicOp vk_logic_op(traces::LogicOp op);
[[nodiscard]] VkIndexType vk_index_type(traces::IndexType type);

}  // namespace quadrille::lavapipe
