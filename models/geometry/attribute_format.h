/// Vertex attribute formats: how bytes in a vertex buffer become the 32-bit words a vertex shader reads.
/// [VK1.3 #fundamentals-fixedconv,
/// #fxvertex-input-extraction]
#pragma once

#include "models/base/format.h"

#include <cstddef>
#include <cstdint>

namespace quadrille::models {

/// Decodes one attribute from `source` (no alignment asked; `format_bytes` bytes are read) to four words:
/// the bits of floats, or unsigned integers for UINT formats. Components that a float format lacks read as
/// (0, 0, 0, 1). UNORM c / (2^n - 1); SNORM max(c / (2^(n-1) - 1), -1).
void decode_attribute(Format format, const std::byte* source, std::uint32_t out[4]);

}  // namespace quadrille::models
