/// Along Morton's curve: squares of tiles within squares, each by its four quarters in the form of a Z.
#include "models/raster/tile_order.h"

namespace quadrille::models {
namespace {

/// Bit i of a number of 16 bits moves to bit 2 i.
constexpr std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 8) & 0x00ff00ffu;
  bits = (bits | bits << 4) & 0x0f0f0f0fu;
  bits = (bits | bits << 2) & 0x33333333u;
  return (bits | bits << 1) & 0x55555555u;
}

class MortonOrder final : public TileOrder {
 public:
  [[nodiscard]] std::uint64_t place(std::uint32_t tile_x, std::uint32_t tile_y) const override {
    return spread(tile_x) | spread(tile_y) << 1;
  }
};

}  // namespace

constinit const TileOrderPolicy kMortonTileOrder{
    "morton",
    "squares within squares: neighbours in both directions follow soon, from one square to the next it jumps",
    []() -> std::unique_ptr<TileOrder> { return std::make_unique<MortonOrder>(); }};

}  // namespace quadrille::models
