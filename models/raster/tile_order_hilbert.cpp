/// Along Hilbert's curve: squares within squares, turned so that each tile is a neighbour of the one before.
#include "models/raster/tile_order.h"

#include <utility>

namespace quadrille::models {
namespace {

class HilbertOrder final : public TileOrder {
 public:
  [[nodiscard]] std::uint64_t place(std::uint32_t tile_x, std::uint32_t tile_y) const override {
    std::uint64_t place = 0;
    for (std::uint32_t side = 1u << 15; side != 0; side /= 2) {
      const bool right = (tile_x & side) != 0, lower = (tile_y & side) != 0;
      // The quarters follow each other down, to the right and up again.
      const std::uint64_t quarter = right ? (lower ? 2 : 3) : (lower ? 1 : 0);
      place += quarter * side * side;
      // The first and the last quarter are mirrored, the last one about its other diagonal.
      if (!lower) {
        if (right) {
          tile_x = ~tile_x;
          tile_y = ~tile_y;
        }
        std::swap(tile_x, tile_y);
      }
    }
    return place;
  }
};

}  // namespace

constinit const TileOrderPolicy kHilbertTileOrder{
    "hilbert",
    "squares within squares without a jump: where the triangle is whole, each tile touches the one before",
    []() -> std::unique_ptr<TileOrder> { return std::make_unique<HilbertOrder>(); }};

}  // namespace quadrille::models
