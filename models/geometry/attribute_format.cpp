#include "models/geometry/attribute_format.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <type_traits>

namespace quadrille::models {
namespace {

template <class T>
void decode_components(const std::byte* source, int count, std::uint32_t out[4]) {
  for (int i = 0; i < count; ++i) {
    T value;
    std::memcpy(&value, source + static_cast<std::size_t>(i) * sizeof(T), sizeof(T));
    if constexpr (std::is_floating_point_v<T>) {
      out[i] = std::bit_cast<std::uint32_t>(value);
    } else {
      const float scaled = static_cast<float>(value) / static_cast<float>(std::numeric_limits<T>::max());
      // the most negative SNORM code is -1 too
      out[i] = std::bit_cast<std::uint32_t>(std::max(scaled, -1.0f));
    }
  }
}

/// Signed ones keep their sign in 32 bits; a component that lacks is 0, and the fourth 1.
template <class T>
void decode_integers(const std::byte* source, std::size_t count, std::uint32_t out[4]) {
  out[3] = 1;
  for (std::size_t i = 0; i < count; ++i) {
    T value;
    std::memcpy(&value, source + i * sizeof(T), sizeof(T));
    out[i] = static_cast<std::uint32_t>(value);
  }
}

}  // namespace

void decode_attribute(Format format, const std::byte* source, std::uint32_t out[4]) {
  out[0] = out[1] = out[2] = 0;
  out[3] = std::bit_cast<std::uint32_t>(1.0f);
  switch (format) {
    case Format::kR32Float: return decode_components<float>(source, 1, out);
    case Format::kR32G32Float: return decode_components<float>(source, 2, out);
    case Format::kR32G32B32Float: return decode_components<float>(source, 3, out);
    case Format::kR32G32B32A32Float: return decode_components<float>(source, 4, out);
    case Format::kR8G8Unorm: return decode_components<std::uint8_t>(source, 2, out);
    case Format::kR8G8B8A8UnormVertex: return decode_components<std::uint8_t>(source, 4, out);
    case Format::kR16G16Unorm: return decode_components<std::uint16_t>(source, 2, out);
    case Format::kR16G16B16A16Unorm: return decode_components<std::uint16_t>(source, 4, out);
    case Format::kR8G8B8A8Snorm: return decode_components<std::int8_t>(source, 4, out);
    case Format::kR16G16B16A16Snorm: return decode_components<std::int16_t>(source, 4, out);
    case Format::kR8G8B8A8Uint: return decode_integers<std::uint8_t>(source, 4, out);
    case Format::kR8G8B8A8Sint: return decode_integers<std::int8_t>(source, 4, out);
    case Format::kR16G16B16A16Uint: return decode_integers<std::uint16_t>(source, 4, out);
    case Format::kR16G16B16A16Sint: return decode_integers<std::int16_t>(source, 4, out);
    case Format::kR32Uint:
    case Format::kR32Sint: return decode_integers<std::uint32_t>(source, 1, out);
    case Format::kR32G32Uint:
    case Format::kR32G32Sint: return decode_integers<std::uint32_t>(source, 2, out);
    case Format::kR32G32B32A32Uint:
    case Format::kR32G32B32A32Sint: return decode_integers<std::uint32_t>(source, 4, out);
    default: break;
  }
}

}  // namespace quadrille::models
