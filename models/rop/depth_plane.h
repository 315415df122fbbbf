/// Depths and stencil values of a tile, of one sample a pixel, as numbers: what the tests compare, however
/// the attachment's format stores them.
#pragma once

#include "models/base/format.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace quadrille::models {

/// A view of the 64 pixels of a tile in memory, which must outlive it. Depths of D32 are used where they lie,
/// others are decoded first.
class DepthPlane {
 public:
  DepthPlane(Format format, std::byte* plane);
  [[nodiscard]] Format format() const { return format_; }
  /// Quad-major (raster/tile.h).
  [[nodiscard]] const float* depths() const { return in_place_ ? stored_floats() : decoded_.data(); }
  /// Zeros where the format has no stencil values.
  [[nodiscard]] const std::array<std::uint8_t, 64>& stencil() const { return stencil_; }
  /// Writes depths, which the format can hold (`round_depths`), where `mask` is set.
  void write_depths(const float depths[64], std::uint64_t mask);
  void write_stencil(const std::array<std::uint8_t, 64>& values, std::uint64_t mask);

 private:
  [[nodiscard]] float* stored_floats() const { return reinterpret_cast<float*>(plane_); }
  template <class Change>
  void change(std::uint64_t mask, const Change& change);

  Format format_;
  std::byte* plane_;
  bool in_place_;
  alignas(32) std::array<float, 64> decoded_;
  std::array<std::uint8_t, 64> stencil_{};
};

/// Moves depths to the nearest that the format can hold, ties to even, as they are before they are compared.
/// Formats of floats hold all. A NaN becomes 0 in the others. [VK1.3 #fragops-depth]
void round_depths(Format format, float depths[64]);
[[nodiscard]] float round_depth(Format format, float depth);
/// A pixel of a depth attachment.
[[nodiscard]] PixelCode encode_depth(Format format, float depth, std::uint8_t stencil);
[[nodiscard]] float decode_depth(Format format, const PixelCode& pixel);

}  // namespace quadrille::models
