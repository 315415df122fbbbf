/// Numbers of 16 bits, for textures that are made here.
#pragma once

#include <immintrin.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace quadrille::scenes {

/// Adds a value as a 16-bit float, rounded to nearest, low byte first.
inline void append_half(std::vector<std::byte>& bytes, double value) {
  const __m128i half =
      _mm_cvtps_ph(_mm_set_ss(static_cast<float>(value)), _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
  const auto bits = static_cast<std::uint32_t>(_mm_cvtsi128_si32(half));
  bytes.push_back(static_cast<std::byte>(bits & 255));
  bytes.push_back(static_cast<std::byte>(bits >> 8 & 255));
}

}  // namespace quadrille::scenes
