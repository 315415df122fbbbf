/// Vulkan's enumerations as the command stream's. Each refuses, by name or number, what the machine does not
/// have.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "traces/capture/objects.h"

namespace quadrille::capture {

/// Of an attachment, or of an image whose texels the stream brings as they are; `kUndefined` if there is
/// none.
[[nodiscard]] traces::Format image_format(std::uint32_t format);
/// Of what the vertex fetch reads; `kUndefined` if it is none of that.
[[nodiscard]] traces::Format attribute_format(std::uint32_t format);
/// "VK_FORMAT_..." of the formats that this program knows, else its number.
[[nodiscard]] std::string format_name(std::uint32_t format);

[[nodiscard]] traces::Topology topology_of(std::uint32_t value);
[[nodiscard]] traces::CompareOp compare_of(std::uint32_t value);
[[nodiscard]] traces::StencilOp stencil_op_of(std::uint32_t value);
[[nodiscard]] traces::BlendFactor blend_factor_of(std::uint32_t value);
[[nodiscard]] traces::BlendOp blend_op_of(std::uint32_t value);
[[nodiscard]] traces::LogicOp logic_op_of(std::uint32_t value);
[[nodiscard]] traces::CullMode cull_of(std::uint32_t value);
[[nodiscard]] traces::PolygonMode polygon_mode_of(std::uint32_t value);
[[nodiscard]] traces::LineMode line_mode_of(std::uint32_t value);
[[nodiscard]] traces::IndexType index_type_of(std::uint32_t value);
[[nodiscard]] traces::LoadOp load_of(std::uint32_t value);
[[nodiscard]] traces::StoreOp store_of(std::uint32_t value);

[[nodiscard]] traces::ViewKind view_kind_of(std::uint32_t value, std::uint32_t samples);
/// What a VkComponentSwizzle shows as component `c`.
[[nodiscard]] models::ComponentSource component_of(std::uint32_t value, std::size_t c);
[[nodiscard]] traces::ImageKind image_kind_of(std::uint32_t value);

/// A VkSamplerCreateInfo.
[[nodiscard]] SamplerObject sampler_of(const Value& info);

/// A command that changes nothing of the picture: barriers, queries, stipples of lines that are not stippled.
[[nodiscard]] bool changes_no_picture(std::string_view command);

}  // namespace quadrille::capture
