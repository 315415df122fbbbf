#include "models/rop/depth_plane.h"

#include "models/rop/depth.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace quadrille::models {
namespace {

double greatest_code(const ComponentBits& depth) { return std::ldexp(1.0, depth.bits) - 1; }

/// The product is exact to a part in 2^53, far less than codes are apart.
std::uint32_t code_of(const ComponentBits& depth, float value) {
  const float within = value > 0 ? std::min(value, 1.0f) : 0.0f;  // NaN: 0
  return static_cast<std::uint32_t>(std::nearbyint(static_cast<double>(within) * greatest_code(depth)));
}

float value_of(const ComponentBits& depth, std::uint32_t code) {
  return static_cast<float>(code / greatest_code(depth));
}

std::uint32_t bits_of(const ComponentBits& component, const PixelCode& pixel) {
  return static_cast<std::uint32_t>(pixel.word[component.shift / 32] >> component.shift % 32 &
                                    ((std::uint64_t{1} << component.bits) - 1));
}

void put(const ComponentBits& component, std::uint32_t bits, PixelCode& pixel) {
  const auto mask = static_cast<std::uint32_t>((std::uint64_t{1} << component.bits) - 1);
  std::uint32_t& word = pixel.word[component.shift / 32];
  word = (word & ~(mask << component.shift % 32)) | bits << component.shift % 32;
}

std::uint32_t depth_bits(const FormatInfo& format, float depth) {
  return format.numeric == Numeric::kFloat ? std::bit_cast<std::uint32_t>(depth)
                                           : code_of(format.component[0], depth);
}

}  // namespace

DepthPlane::DepthPlane(Format format, std::byte* plane)
    : format_(format), plane_(plane), in_place_(format == Format::kD32Float) {
  if (in_place_) return;
  const FormatInfo& info = format_info(format);
  for (std::size_t i = 0; i < decoded_.size(); ++i) {
    PixelCode pixel;
    std::memcpy(pixel.word.data(), plane + i * info.bytes, info.bytes);
    decoded_[i] = decode_depth(format, pixel);
    if (info.stencil.bits != 0) stencil_[i] = static_cast<std::uint8_t>(bits_of(info.stencil, pixel));
  }
}

template <class Change>
void DepthPlane::change(std::uint64_t mask, const Change& change) {
  const std::size_t bytes = format_bytes(format_);
  for (; mask != 0; mask &= mask - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(mask));
    PixelCode pixel;
    std::memcpy(pixel.word.data(), plane_ + i * bytes, bytes);
    change(i, pixel);
    std::memcpy(plane_ + i * bytes, pixel.word.data(), bytes);
  }
}

void DepthPlane::write_depths(const float depths[64], std::uint64_t mask) {
  if (in_place_) return depth_write(stored_floats(), depths, mask);
  const FormatInfo& info = format_info(format_);
  change(mask, [&](std::size_t i, PixelCode& pixel) {
    put(info.component[0], depth_bits(info, depths[i]), pixel);
    decoded_[i] = depths[i];
  });
}

void DepthPlane::write_stencil(const std::array<std::uint8_t, 64>& values, std::uint64_t mask) {
  const FormatInfo& info = format_info(format_);
  change(mask, [&](std::size_t i, PixelCode& pixel) {
    put(info.stencil, values[i], pixel);
    stencil_[i] = values[i];
  });
}

float round_depth(Format format, float depth) {
  const FormatInfo& info = format_info(format);
  if (info.numeric == Numeric::kFloat) return depth;
  return value_of(info.component[0], code_of(info.component[0], depth));
}

void round_depths(Format format, float depths[64]) {
  if (format_info(format).numeric == Numeric::kFloat) return;
  for (int i = 0; i < 64; ++i) depths[i] = round_depth(format, depths[i]);
}

PixelCode encode_depth(Format format, float depth, std::uint8_t stencil) {
  const FormatInfo& info = format_info(format);
  PixelCode pixel;
  put(info.component[0], depth_bits(info, depth), pixel);
  if (info.stencil.bits != 0) put(info.stencil, stencil, pixel);
  return pixel;
}

float decode_depth(Format format, const PixelCode& pixel) {
  const FormatInfo& info = format_info(format);
  const std::uint32_t bits = bits_of(info.component[0], pixel);
  return info.numeric == Numeric::kFloat ? std::bit_cast<float>(bits) : value_of(info.component[0], bits);
}

}  // namespace quadrille::models
