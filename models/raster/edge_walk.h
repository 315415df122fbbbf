/// Edge walking: the rows of a triangle from top to bottom, each a span of pixels between its left and its
/// right edge, without a test of any pixel. Lectures teach it as the triangle DDA.
///
/// The corners, sorted by y, cut a triangle in two parts at the middle one. Each part has one edge on its
/// left and one on its right. Where an edge crosses the first row of its part is found by a division;
/// from there on it steps from row to row as Bresenham's line does: the slope's quotient and remainder are
/// added, and a remainder that is full carries one pixel. All of it is integers, from the very numbers that
/// edge functions are made of. So the spans hold what edge functions cover, to the sample: one on a left edge
/// is inside and one on a right edge outside, and a row at the height of a corner belongs to the part below
/// it, which is the top-left rule.
///
/// With several samples a pixel each sample has rows of its own, at its own height, and edges of its own. A
/// line that is a rectangle, or a point, is walked alike, with up to three parts; the band of a Bresenham
/// line is one part whose ends the bounds cut off.
#pragma once

#include "models/raster/triangle_setup.h"

#include <array>
#include <cstdint>

namespace quadrille::models {

/// A row of samples: the same sample of a row of pixels.
struct SampleRow {
  std::int32_t y = 0;           ///< of its pixels
  int sample = 0;               ///< of each of them
  std::int32_t x0 = 0, x1 = 0;  ///< covered are those of x0 <= x < x1; none if x0 >= x1
  bool begins_part = false;     ///< its edges were found by division
  [[nodiscard]] bool empty() const { return x0 >= x1; }
};

/// The rows of one sample.
class SampleRowWalk {
 public:
  SampleRowWalk() = default;
  /// The sample lies `offset` from its pixel's centre.
  SampleRowWalk(const TriangleSetup& triangle, const GridPoint& offset, int subpixel_bits);
  /// Rows of pixels that have a row of it: from `first_row` on, before `end_row`.
  [[nodiscard]] std::int32_t first_row() const { return first_; }
  [[nodiscard]] std::int32_t end_row() const { return end_; }
  /// Row y: the first one, or the one after the last that was asked for.
  [[nodiscard]] SampleRow row(std::int32_t y);

 private:
  /// An edge that bounds the rows from `first` on and before `end`.
  struct Edge {
    std::int64_t at_zero = 0, slope = 0, per_row = 0;  ///< at pixel 0 of row 0; a pixel, and a row, more
    std::int32_t first = 0, end = 0;
  };
  /// The edges of one side, of which one bounds a row, and the greatest x (or -x) that it allows there.
  struct Side {
    std::array<Edge, 3> edges;
    std::size_t count = 0;
    std::int64_t limit = 0, remainder = 0;                ///< of the row
    std::int64_t step = 0, step_remainder = 0, full = 0;  ///< added a row; `full` carries one
    void add(const Edge& edge) { edges[count++] = edge; }
    void shorten(std::int32_t& first, std::int32_t& end) const;
    /// Finds the edge of row y, and returns where it ends; `end` if there is none.
    std::int32_t begin(std::int32_t y, std::int32_t end_row);
    void advance() {
      limit += step;
      remainder += step_remainder;
      const bool carries = remainder >= full;
      limit += carries ? 1 : 0;
      remainder -= carries ? full : 0;
    }
  };
  void add_edge(const EdgeFunction& edge, std::int64_t sample_y, int subpixel_bits);
  void add_level(const EdgeFunction& edge);

  Side left_, right_;
  PixelRect bounds_;
  std::int32_t first_ = 0, end_ = 0;
  std::int32_t part_end_ = 0;
  bool begun_ = false;
};

class EdgeWalk {
 public:
  EdgeWalk() = default;
  /// Copies what it needs; the set-up need not outlive the walk.
  explicit EdgeWalk(const TriangleSetup& triangle, const SampleGrid& samples = {});
  /// The next row: from top to bottom, and the samples of a row of pixels one after the other. False at the
  /// end.
  bool next(SampleRow& row);
  /// Samples that are walked: one where it decides all samples of its pixel.
  [[nodiscard]] int samples() const { return count_; }

 private:
  std::array<SampleRowWalk, kMaxSamples> walks_;
  int count_ = 0, sample_ = 0;
  std::int32_t y_ = 0, end_ = 0;
};

}  // namespace quadrille::models
