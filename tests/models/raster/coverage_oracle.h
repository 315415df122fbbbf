/// An oracle of coverage in exact rational arithmetic. It shares no code with the rasteriser.
///
/// It looks at a square window of pixels. A closed chain of edges winds around a sample as often as edges
/// cross the row of the sample at or before it: one that goes up counts 1, one that goes down -1. Where an
/// edge crosses a row is a fraction of two integers, and is never rounded. An edge holds its upper end and
/// not its lower one, and a sample at a crossing lies behind it. That is the top-left rule, said without
/// edge functions. [VK1.3 #primsrast-polygons-basic]
///
/// A triangle covers what its three edges wind around. Edges that two triangles of a mesh share cancel out,
/// so the outline of a mesh says how often its triangles together must cover each sample.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace quadrille::models {

/// The pixels and samples that are looked at.
struct CoverageWindow {
  static constexpr int kSize = 64;  ///< pixels along each side
  std::int32_t x0 = 0, y0 = 0;      ///< its first pixel
  int subpixel_bits = 8;            ///< 4 to 12
  int samples = 1;                  ///< 1, 2, 4 or 8
};

/// A position in units of 2^-subpixel_bits pixel.
struct OraclePoint {
  std::int64_t x = 0, y = 0;
};

/// From the upper left corner of its pixel: Vulkan's standard sample locations.
[[nodiscard]] OraclePoint oracle_sample(const CoverageWindow& window, int sample);

/// The samples of the window, by sample and row of pixels; bit x of a word is the pixel x0 + x.
using WindowMasks = std::array<std::array<std::uint64_t, CoverageWindow::kSize>, 8>;

class CoverageOracle {
 public:
  explicit CoverageOracle(const CoverageWindow& window);
  /// Adds an edge from a to b, `times` over.
  void add_edge(const OraclePoint& a, const OraclePoint& b, int times = 1);
  /// How much more often the edges wind around a sample than around the one to the left of it; clockwise on
  /// the screen is positive. The sum along a row is how often they wind around a sample.
  [[nodiscard]] int winding_step(int sample, int row, int column) const {
    return steps_of(sample, row)[static_cast<std::size_t>(column)];
  }
  /// The samples that the edges wind around, in either direction.
  void covered(WindowMasks& masks) const;
  void clear();
  /// Crossings so far that lie exactly on a sample of the window.
  [[nodiscard]] std::int64_t ties() const { return ties_; }

 private:
  using Row = std::array<std::int16_t, CoverageWindow::kSize + 1>;
  [[nodiscard]] const Row& steps_of(int sample, int y) const {
    return steps_[static_cast<std::size_t>(sample * CoverageWindow::kSize + y)];
  }
  CoverageWindow window_;
  std::array<OraclePoint, 8> sample_{};
  /// by sample and row: how much the winding grows at each column
  std::vector<Row> steps_;
  std::array<int, 8> first_row_{}, end_row_{};  ///< rows that have steps lie between, by sample
  std::int64_t ties_ = 0;
};

}  // namespace quadrille::models
