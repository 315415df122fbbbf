/// Lossless encodings of a line of a colour or depth surface, which let it move in fewer sectors of memory.
///
/// The encoder works on the stored codes of the pixels' components, as integers. It knows two ways.
///
/// *Offset*: for each component the least code of the line, and for each pixel how far it lies above that, in
/// as many bits as the greatest of them needs. A component that is the same everywhere needs none.
/// *Plane*: the same, but depths are first predicted from a plane over the line, and what is kept of a pixel
/// is how far the prediction misses. A triangle's depths are such a plane, but for their rounding.
///
/// The way that takes fewer sectors is chosen. A line that neither way makes shorter stays plain.
/// [P: Hasselgren 2006]
#pragma once

#include "models/base/format.h"
#include "models/memory/device_memory.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace quadrille::models {

enum class LineEncoding : std::uint8_t { kPlain, kOffset, kPlane };

struct EncodedLine {
  LineEncoding encoding = LineEncoding::kPlain;
  std::uint32_t bits = 0;  ///< that are used of `bytes`
  std::array<std::byte, kLineBytes> bytes{};
  /// What it moves.
  [[nodiscard]] std::uint32_t sectors() const { return (bits + 8 * kSectorBytes - 1) / (8 * kSectorBytes); }
};

/// Encodes and decodes lines of surfaces of one format. A line holds 128 bytes of pixels, quad by quad
/// (raster/tile.h), or 64 where a pixel has one byte.
class LineCodec {
 public:
  /// Planes are tried for depths, which are the first component, and only with `planes`.
  explicit LineCodec(Format format, bool planes = false);
  [[nodiscard]] std::uint32_t line_bytes() const { return pixels_ * pixel_bytes_; }
  /// `line` has `line_bytes()`.
  [[nodiscard]] EncodedLine encode(std::span<const std::byte> line) const;
  /// The reverse: writes `line_bytes()`.
  void decode(const EncodedLine& encoded, std::span<std::byte> line) const;

 private:
  static constexpr std::size_t kMaxComponents = 5, kMaxPixels = 64;
  /// Depths grow by this much a pixel, in fractions of `kSlopeBits` bits.
  struct Slope {
    std::int64_t x = 0, y = 0;
    [[nodiscard]] std::int64_t at(std::size_t pixel) const;
    [[nodiscard]] std::uint32_t width() const;
  };
  /// How a component is kept: what is added to the prediction of each pixel, and the bits of what is left.
  struct Range {
    std::int64_t least = 0;
    std::uint32_t width = 0;
  };
  using Codes = std::array<std::uint32_t, kMaxPixels>;
  struct Plan {
    bool plane = false;
    Slope slope{};
    std::array<Range, kMaxComponents> range{};
    std::uint32_t bits = 0;
    [[nodiscard]] std::uint32_t sectors() const { return EncodedLine{{}, bits}.sectors(); }
    /// Of a component, of which the first may lie along the plane.
    [[nodiscard]] Slope slope_of(std::size_t component) const { return component == 0 ? slope : Slope{}; }
  };

  void add(const ComponentBits& component);
  [[nodiscard]] bool only_components(std::span<const std::byte> line) const;
  [[nodiscard]] Codes codes_of(std::span<const std::byte> line, std::size_t component) const;
  [[nodiscard]] Slope slope_of(const Codes& depths) const;
  [[nodiscard]] Range range_of(const Codes& codes, const Slope& slope) const;
  [[nodiscard]] Plan plan(std::span<const Codes> codes, bool plane) const;
  [[nodiscard]] Plan best_plan(std::span<const Codes> codes) const;
  [[nodiscard]] EncodedLine packed(std::span<const Codes> codes, const Plan& plan) const;

  std::uint32_t pixel_bytes_, pixels_;
  bool planes_;
  std::size_t components_ = 0;
  std::array<ComponentBits, kMaxComponents> component_{};
};

}  // namespace quadrille::models
