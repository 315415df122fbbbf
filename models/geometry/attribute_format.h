/// Vertex attribute formats: how bytes in a vertex buffer become the 32-bit words a vertex shader reads.
/// [VK1.3 #fundamentals-fixedconv,
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
  kR16G16B16A16Snorm,
  kR8G8B8A8Uint,
  kR16G16B16A16Uint
};

/// Bytes of one attribute.
[[nodiscard]] std::uint32_t attribute_bytes(AttributeFormat format);

/// Decodes one attribute from `source` (no alignment asked; `attribute_bytes` bytes are read) to four words:
/// the bits of floats, or unsigned integers for UINT formats. Components that a float format lacks read as
/// (0, 0, 0, 1). UNORM c / (2^n - 1); SNORM max(c / (2^(n-1) - 1), -1).
void decode_attribute(AttributeFormat format, const std::byte* source, std::uint32_t out[4]);

}  // namespace quadrille::models
