/// Orders of tiles: each puts every tile of a square in a place of its own, and keeps to its curve.
#include "models/raster/tile_order.h"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <map>
#include <utility>
#include <vector>

using namespace quadrille::models;

namespace {

/// The tiles of a square, in their order.
std::vector<std::pair<int, int>> walked(const TileOrderPolicy& policy, int side) {
  const std::unique_ptr<TileOrder> order = policy.make();
  std::map<std::uint64_t, std::pair<int, int>> by_place;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      by_place[order->place(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y))] = {x, y};
  std::vector<std::pair<int, int>> all;
  all.reserve(by_place.size());
  for (const auto& [place, tile] : by_place) all.push_back(tile);
  return all;
}

}  // namespace

TEST_CASE("tile orders: no two tiles have one place") {
  for (const TileOrderPolicy* policy : tile_order_policies().all())
    for (const int side : {5, 16, 33})
      CHECK(walked(*policy, side).size() == static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
}

TEST_CASE("tile orders: scan goes row by row, Morton by Z, Hilbert from neighbour to neighbour") {
  using Tiles = std::vector<std::pair<int, int>>;
  CHECK(walked(kScanTileOrder, 2) == Tiles{{0, 0}, {1, 0}, {0, 1}, {1, 1}});
  CHECK(walked(kScanTileOrder, 3)[2] == std::pair{2, 0});
  const Tiles morton = walked(kMortonTileOrder, 4);
  CHECK(Tiles(morton.begin(), morton.begin() + 6) == Tiles{{0, 0}, {1, 0}, {0, 1}, {1, 1}, {2, 0}, {3, 0}});
  const Tiles hilbert = walked(kHilbertTileOrder, 64);
  for (std::size_t i = 1; i < hilbert.size(); ++i) {
    const auto [ax, ay] = hilbert[i - 1];
    const auto [bx, by] = hilbert[i];
    if (std::abs(ax - bx) + std::abs(ay - by) != 1) FAIL("step " << i);
  }
}

TEST_CASE("tile orders: every square of a power of two is done before the next, along both curves") {
  for (const TileOrderPolicy* policy : {&kMortonTileOrder, &kHilbertTileOrder}) {
    const auto tiles = walked(*policy, 32);
    for (const int side : {2, 4, 8, 16}) {
      const auto square = [&](std::size_t i) {
        return std::pair{tiles[i].first / side, tiles[i].second / side};
      };
      const auto area = static_cast<std::size_t>(side * side);
      for (std::size_t i = 0; i < tiles.size(); ++i)
        if (square(i) != square(i / area * area)) FAIL("side " << side << ", tile " << i);
    }
  }
}
