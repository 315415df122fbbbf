#include "pipeline/report/draws_by_square.h"

#include "models/raster/coarse.h"
#include "models/raster/fine.h"
#include "pipeline/driver/frame_builder.h"
#include "pipeline/functional/functional.h"
#include "pipeline/report/detail_log.h"

namespace quadrille::pipeline {

namespace {

class Squares {
 public:
  explicit Squares(const hw::Frame& frame) : frame_(frame), screen_(screen_cells(frame)) {
    draws_.resize(screen_.count());
  }

  void note(const RasterizedPiece& p) {
    const hw::DrawState& draw = frame_.draws[p.draw.index()];
    models::TriangleSetup setup;
    const auto outcome =
        models::setup_piece(p.piece, draw.primitives, draw.views[p.piece.viewport].setup, setup);
    if (outcome != models::SetupOutcome::kKept) return;
    models::TileWalk walk(setup, draw.samples());
    models::TileHit tile;
    while (walk.next(tile)) {
      const std::uint32_t cell =
          screen_.cell_of({p.draw, hw::tile_at(static_cast<std::uint32_t>(tile.tile_x),
                                               static_cast<std::uint32_t>(tile.tile_y))});
      if (cell == screen_.count()) continue;
      std::vector<std::uint32_t>& here = draws_[cell];
      // draws come one after another
      if (!here.empty() && here.back() == p.draw.index()) continue;
      if (covers(draw, setup, tile)) here.push_back(p.draw.index());
    }
  }

  [[nodiscard]] std::vector<std::vector<std::uint32_t>> take() { return std::move(draws_); }

 private:
  static bool covers(const hw::DrawState& draw, const models::TriangleSetup& setup,
                     const models::TileHit& tile) {
    if (tile.fully_covered) return true;
    for (int s = 0; s < draw.samples().count; ++s)
      if (models::sample_coverage(setup, tile.tile_x, tile.tile_y, draw.samples(), s) != 0) return true;
    return false;
  }

  const hw::Frame& frame_;
  hw::ScreenCells screen_;
  std::vector<std::vector<std::uint32_t>> draws_;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> draws_by_square(const traces::CommandStream& stream,
                                                        const models::Precision& precision) {
  DeviceFrame frame(std::uint64_t{4} << 30);
  build_frame(stream, precision, frame);
  Squares squares(frame.frame);
  (void)render_functional(frame.frame, frame.memory,
                          [&](const RasterizedPiece& piece) { squares.note(piece); });
  return squares.take();
}

}  // namespace quadrille::pipeline
