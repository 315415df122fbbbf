/// Vertex attribute formats: how bytes in a vertex buffer become the floats a vertex shader reads. [VK1.3 #fundamentals-fixedconv,
/// #fxvertex-input-extraction]
#pragma once

#include <cstddef>
#include <cstdint>

namespace quadrille::models {

/// Values equal those of the command stream's `Format`.
enum class AttributeFormat : std::uint8_t {
  kR32Float = 4,
  kR32G32Float,
  kR32G32B32Float,
  kR32G32B32A32Float,
  kR8G8Unorm,
  kR8G8B8A8UnormVertex,
  kR16G16Unorm,
  kR16G16B16A16Unorm,
  kR8G8B8A8Snorm,
  kR16G16B16A16Snorm
};

/// Bytes of one attribute.
[[nodiscard]] std::uint32_t attribute_bytes(AttributeFormat format);

/// Decodes one attribute from `source` (no alignment asked; `attribute_bytes` bytes are read) to four floats; components that the format
/// lacks read as (0, 0, 0, 1). UNORM c / (2^n - 1); SNORM max(c / (2^(n-1) - 1), -1).
void decode_attribute(AttributeFormat format, const std::byte* source, float out[4]);

}  // namespace quadrille::models
