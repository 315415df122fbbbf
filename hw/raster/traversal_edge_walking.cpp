/// Rows of samples are walked between the edges, from top to bottom, and their spans are gathered in a row of
/// tiles. There are two such rows: while the tiles of one leave, the next one is walked.
///
/// A part of the triangle costs its set-up, a row its turn, and a span each tile that it crosses. Rows
/// without a covered sample cost as much as others. An engine walks every row, and gathers what is its own.
#include "hw/base/work_rate.h"
#include "hw/raster/traversal.h"

#include <algorithm>
#include <utility>

namespace quadrille::hw {
namespace {

class EdgeWalking final : public Traversal {
 public:
  explicit EdgeWalking(const TraversalSetup& setup) : setup_(setup) {}

  std::int64_t begin(const models::TriangleSetup& triangle, const models::SampleGrid& samples) override {
    walk_ = models::EdgeWalk(triangle, samples);
    for (models::SpanTiles& row : rows_)
      row = models::SpanTiles(triangle.bounds, samples.count, triangle.whole_pixels);
    has_row_ = walk_.next(row_);
    return walk_tiles();
  }

  bool next(Tile& tile) override {
    models::SpanTiles::Tile walked;
    tile.next_row_clk = Tile::kNoRow;
    if (!take_own(rows_[leaving_], walked)) {
      leaving_ = 1 - leaving_;
      if (!take_own(rows_[leaving_], walked)) return false;
      tile.next_row_clk = walk_tiles();
    }
    ++work_.tests;
    tile.hit = {walked.tile_x, walked.tile_y, walked.full};
    tile.walked = true;
    tile.coverage = walked.coverage;
    return true;
  }

  Work take_work() override { return std::exchange(work_, {}); }
  [[nodiscard]] std::string_view limited_by() const override { return "walk"; }

 private:
  /// Walks rows of tiles into the row that is not leaving until one holds a tile of the engine, or the
  /// triangle ends; returns the cycles that takes.
  std::int64_t walk_tiles() {
    std::int64_t cost = 0;
    for (bool found = false; has_row_ && !found;) {
      const std::int32_t tile_y = row_.y >> 3;
      for (; has_row_ && row_.y >> 3 == tile_y; has_row_ = walk_.next(row_)) {
        const std::uint64_t segments = segments_of(row_);
        cost += cost_of(segments);
        if (segments == 0) continue;
        found = true;
        rows_[1 - leaving_].add(row_);
      }
    }
    return (cost + WorkRate::kCycle - 1) / WorkRate::kCycle;
  }

  /// The engine's tiles that a row's span lies in.
  std::uint64_t segments_of(const models::SampleRow& row) const {
    if (row.empty()) return 0;
    const std::int32_t from = row.x0 >> 3, to = (row.x1 - 1) >> 3;
    if (setup_.screen.engines == 1) return static_cast<std::uint64_t>(to - from + 1);
    std::uint64_t segments = 0;
    for (std::int32_t x = from; x <= to; ++x) segments += setup_.owns(x, row.y >> 3) ? 1 : 0;
    return segments;
  }

  /// Of the row at hand, counted; in parts of a cycle.
  std::int64_t cost_of(std::uint64_t segments) {
    ++work_.rows;
    work_.parts += row_.begins_part ? 1 : 0;
    work_.spans += row_.empty() ? 0 : 1;
    work_.segments += segments;
    const std::int64_t crossed =
        static_cast<std::int64_t>(segments) * WorkRate::cost(setup_.segments_per_clk);
    return (row_.begins_part ? setup_.walk_setup_clk * WorkRate::kCycle : 0) +
           std::max(WorkRate::cost(setup_.rows_per_clk), crossed);
  }

  bool take_own(models::SpanTiles& row, models::SpanTiles::Tile& tile) const {
    while (row.take(tile))
      if (setup_.owns(tile.tile_x, tile.tile_y)) return true;
    return false;
  }

  const TraversalSetup setup_;
  models::EdgeWalk walk_;
  models::SampleRow row_;  ///< to be walked next
  bool has_row_ = false;
  std::array<models::SpanTiles, 2> rows_;
  std::size_t leaving_ = 0;
  Work work_;
};

}  // namespace

constinit const TraversalPolicy kEdgeWalking{
    "edge_walking",
    "row by row from the left edge to the right one, without tests: each row of samples costs a turn, each "
    "tile that its span crosses a part of one",
    [](const TraversalSetup& setup) -> std::unique_ptr<Traversal> {
      return std::make_unique<EdgeWalking>(setup);
    }};

}  // namespace quadrille::hw
