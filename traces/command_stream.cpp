/// Properties of formats. Sizes and component counts follow the names. [VK1.3 #formats-definition]
#include "traces/command_stream.h"

namespace quadrille::traces {

std::uint32_t format_bytes(Format format) {
  switch (format) {
    case Format::kUndefined: return 0;
    case Format::kR8G8Unorm: return 2;
    case Format::kR8G8B8A8Unorm:
    case Format::kR8G8B8A8Srgb:
    case Format::kD32Float:
    case Format::kR32Float:
    case Format::kR8G8B8A8UnormVertex:
    case Format::kR16G16Unorm:
    case Format::kR8G8B8A8Snorm:
    case Format::kR8G8B8A8Uint: return 4;
    case Format::kR32G32Float:
    case Format::kR16G16B16A16Unorm:
    case Format::kR16G16B16A16Snorm:
    case Format::kR16G16B16A16Uint: return 8;
    case Format::kR32G32B32Float: return 12;
    case Format::kR32G32B32A32Float: return 16;
  }
  return 0;
}

int format_components(Format format) {
  switch (format) {
    case Format::kUndefined: return 0;
    case Format::kD32Float:
    case Format::kR32Float: return 1;
    case Format::kR32G32Float:
    case Format::kR8G8Unorm:
    case Format::kR16G16Unorm: return 2;
    case Format::kR32G32B32Float: return 3;
    case Format::kR8G8B8A8Unorm:
    case Format::kR8G8B8A8Srgb:
    case Format::kR32G32B32A32Float:
    case Format::kR8G8B8A8UnormVertex:
    case Format::kR16G16B16A16Unorm:
    case Format::kR8G8B8A8Snorm:
    case Format::kR16G16B16A16Snorm:
    case Format::kR8G8B8A8Uint:
    case Format::kR16G16B16A16Uint: return 4;
  }
  return 0;
}

bool is_integer_format(Format format) { return format == Format::kR8G8B8A8Uint || format == Format::kR16G16B16A16Uint; }

}  // namespace quadrille::traces
