/// Row by row, left to right.
#include "models/raster/tile_order.h"

namespace quadrille::models {
namespace {

class ScanOrder final : public TileOrder {
 public:
  [[nodiscard]] bool as_walked() const override { return true; }
  [[nodiscard]] std::uint64_t place(std::uint32_t tile_x, std::uint32_t tile_y) const override {
    return std::uint64_t{tile_y} << 32 | tile_x;
  }
};

}  // namespace

constinit const TileOrderPolicy kScanTileOrder{
    "scan", "row by row: one division an edge and row finds them, and nothing has to wait",
    []() -> std::unique_ptr<TileOrder> { return std::make_unique<ScanOrder>(); }};

}  // namespace quadrille::models
