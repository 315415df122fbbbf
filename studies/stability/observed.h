/// What a case looks at: its frame as the functional renderer and the machine drew it, with the machine's
/// figures, and the references on demand.
#pragma once

#include "models/reference/reference.h"
#include "pipeline/render.h"
#include "scenes/image/image_io.h"

#include <cstdint>
#include <memory>
#include <optional>

namespace quadrille::studies::stability {

/// The pixels that a pass may touch: the box around the scissors of its draws, within the target.
struct DrawnArea {
  std::uint32_t left = 0, top = 0, right = 0, bottom = 0;  ///< half-open
  [[nodiscard]] bool holds(std::uint32_t x, std::uint32_t y) const {
    return x >= left && x < right && y >= top && y < bottom;
  }
};
[[nodiscard]] DrawnArea drawn_area(const traces::CommandStream& stream);

struct Observed {
  traces::CommandStream stream;
  std::unique_ptr<pipeline::MachineConfig> machine;
  pipeline::RenderedFrame functional, exact;

  /// The picture that the machine drew.
  [[nodiscard]] const pipeline::FrameImage& image() const { return exact.image; }
  [[nodiscard]] std::uint32_t pixel(std::uint32_t x, std::uint32_t y) const {
    return image().color[std::size_t{y} * image().width + x];
  }
  /// One channel (0 red .. 3 alpha) of a pixel.
  [[nodiscard]] std::uint32_t channel(std::uint32_t x, std::uint32_t y, int c) const {
    return (pixel(x, y) >> (8 * c)) & 0xffu;
  }
};

/// Renders `stream` in functional and exact fidelity. SystemC elaborates: once a process.
[[nodiscard]] Observed observe(traces::CommandStream stream,
                               std::unique_ptr<pipeline::MachineConfig> machine);

/// The double-precision reference from the machine's own snapped triangles; and without any precision but the
/// target's.
[[nodiscard]] models::reference::Result given_reference(const Observed& observed);
[[nodiscard]] models::reference::Result ideal_reference(const Observed& observed);

/// 8-bit RGBA of stored colours, opaque.
[[nodiscard]] scenes::Rgba8Image as_picture(const pipeline::FrameImage& image);
/// How often each pixel was covered, read from the red channel of an additive target: black 0, green 1,
/// yellow 2, red more. Pixels outside `area` are grey.
[[nodiscard]] scenes::Rgba8Image count_picture(const pipeline::FrameImage& image, const DrawnArea& area);
/// Box-filtered to at most `side` pixels, by whole factors.
[[nodiscard]] scenes::Rgba8Image reduced(const scenes::Rgba8Image& image, std::uint32_t side);
/// Each pixel repeated by a whole factor, to at least `side` pixels.
[[nodiscard]] scenes::Rgba8Image enlarged(const scenes::Rgba8Image& image, std::uint32_t side);

}  // namespace quadrille::studies::stability
