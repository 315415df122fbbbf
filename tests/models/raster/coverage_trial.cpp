/// The two ways of traversal as masks of a window, and what they are compared with.
#include "tests/models/raster/coverage_trial.h"

#include "models/raster/coarse.h"
#include "models/raster/fine.h"
#include "models/raster/span_tiles.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

namespace quadrille::models {
namespace {

constexpr std::size_t kSize = CoverageWindow::kSize;

/// Adds a tile's coverage of one sample to the window. False if some of it was there.
bool add_tile(const CoverageWindow& window, int tile_x, int tile_y, std::uint64_t mask,
              std::array<std::uint64_t, kSize>& rows) {
  bool once = true;
  for (; mask != 0; mask &= mask - 1) {
    const int entry = std::countr_zero(mask);
    const int x = 8 * tile_x + entry_x(entry) - window.x0, y = 8 * tile_y + entry_y(entry) - window.y0;
    const std::uint64_t bit = std::uint64_t{1} << x;
    std::uint64_t& row = rows.at(static_cast<std::size_t>(y));
    once = once && (row & bit) == 0;
    row |= bit;
  }
  return once;
}

bool cover_by_edge_functions(const TriangleSetup& t, const SampleGrid& grid, const CoverageWindow& window,
                             WindowMasks& masks) {
  bool good = true;
  TileWalk walk(t, grid);
  for (TileHit hit; walk.next(hit);) {
    for (int s = 0; s < grid.count; ++s) {
      const std::uint64_t mask = sample_coverage(t, hit.tile_x, hit.tile_y, grid, s);
      good = good && (!hit.fully_covered || ~mask == 0);
      good = add_tile(window, hit.tile_x, hit.tile_y, mask, masks[static_cast<std::size_t>(s)]) && good;
    }
  }
  return good;
}

bool cover_by_edge_walking(const TriangleSetup& t, const SampleGrid& grid, const CoverageWindow& window,
                           WindowMasks& masks) {
  bool good = true;
  SpanTiles gathered(t.bounds, grid.count, t.whole_pixels);
  const auto take = [&] {
    for (SpanTiles::Tile tile; gathered.take(tile);) {
      bool full = true;
      for (std::size_t s = 0; s < static_cast<std::size_t>(grid.count); ++s) {
        full = full && ~tile.coverage[s] == 0;
        good = add_tile(window, tile.tile_x, tile.tile_y, tile.coverage[s], masks[s]) && good;
      }
      good = good && tile.full == full;
    }
  };
  EdgeWalk walk(t, grid);
  std::int32_t tile_y = t.bounds.y0 >> 3;
  for (SampleRow row; walk.next(row);) {
    if (row.y >> 3 != tile_y) take();
    tile_y = row.y >> 3;
    gathered.add(row);
  }
  take();
  return good;
}

/// A trial of one mesh.
class MeshTrial {
 public:
  MeshTrial(const CoverageMesh& mesh, const CoverageWindow& window, std::span<const CoverageMethod> methods)
      : mesh_(mesh),
        window_(window),
        methods_(methods),
        grid_(sample_grid(window.samples, window.subpixel_bits)),
        oracle_(window),
        counts_(methods.size()) {
    for (auto& counts : counts_) counts.resize(static_cast<std::size_t>(window.samples) * kSize * kSize);
    state_.scissor = {window.x0, window.y0, window.x0 + CoverageWindow::kSize,
                      window.y0 + CoverageWindow::kSize};
    state_.subpixel_bits = window.subpixel_bits;
    state_.samples = grid_;
  }

  CoverageTally run() {
    tally_.meshes = 1;
    tally_.triangles = static_cast<std::int64_t>(mesh_.triangles.size());
    snap();
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) try_triangle(i);
    tally_.ties = oracle_.ties();
    check_counts();
    tally_.folded = folded_ ? 1 : 0;
    tally_.failed = tally_.first_failure.empty() ? 0 : 1;
    return std::move(tally_);
  }

 private:
  template <class... Values>
  void fail(fmt::format_string<Values...> text, Values&&... values) {
    if (tally_.first_failure.empty())
      tally_.first_failure = fmt::format("{}, {} bits, {} samples, window at {},{}: {}",
                                         kMeshKindNames[static_cast<std::size_t>(mesh_.kind)],
                                         window_.subpixel_bits, window_.samples, window_.x0, window_.y0,
                                         fmt::format(text, std::forward<Values>(values)...));
  }

  /// Positions to the grid, as the machine does it. Each must be the nearest place of the grid.
  void snap() {
    constexpr Viewport kPixels{-1, -1, 2, 2, 0, 1};  // x and y of clip space are pixels
    for (const glm::vec2& p : mesh_.at) {
      WindowVertex v;
      if (!to_window({p.x, p.y, 0.5F, 1}, kPixels, window_.subpixel_bits, v))
        fail("{},{} is not on the grid", p.x, p.y);
      const auto off = [&](std::int32_t snapped, float pixels) {
        return std::abs(std::ldexp(static_cast<double>(pixels), window_.subpixel_bits) - snapped);
      };
      if (off(v.x, p.x) > 0.5 || off(v.y, p.y) > 0.5) fail("{},{} is not at its nearest place", p.x, p.y);
      snapped_.push_back(v);
    }
  }

  [[nodiscard]] OraclePoint place(std::uint32_t vertex) const {
    return {snapped_[vertex].x, snapped_[vertex].y};
  }

  void try_triangle(std::size_t number) {
    const auto& corners = mesh_.triangles[number];
    oracle_.clear();
    for (std::size_t i = 0; i < 3; ++i) oracle_.add_edge(place(corners[i]), place(corners[(i + 1) % 3]));
    oracle_.covered(expected_);
    for (std::size_t s = 0; s < static_cast<std::size_t>(window_.samples); ++s)
      for (const std::uint64_t row : expected_[s]) samples_ += std::popcount(row);
    tally_.covered += samples_;
    tally_.covering += std::exchange(samples_, 0) > 0 ? 1 : 0;

    // The machine gets the corners in another order, by turns.
    std::array<WindowVertex, 3> v;
    for (std::size_t i = 0; i < 3; ++i) v[i] = snapped_[corners[(i + number) % 3]];
    const std::int64_t area = doubled_area(v);
    if (number % 2 == 1) std::swap(v[0], v[1]);
    folded_ = folded_ || area < 0;
    TriangleSetup setup;
    const bool kept = setup_triangle(v, whole_triangle_weights(), state_, setup) == SetupOutcome::kKept;
    tally_.kept += kept ? 1 : 0;
    for (std::size_t m = 0; m < methods_.size(); ++m) try_method(m, number, kept ? &setup : nullptr, area);
  }

  void try_method(std::size_t method, std::size_t triangle, const TriangleSetup* setup, std::int64_t area) {
    for (std::size_t s = 0; s < static_cast<std::size_t>(window_.samples); ++s) masks_[s].fill(0);
    const bool good = setup == nullptr || methods_[method].cover(*setup, grid_, window_, masks_);
    if (!good) fail("{} contradicts itself in triangle {}", methods_[method].name, triangle);
    for (std::size_t s = 0; s < static_cast<std::size_t>(window_.samples); ++s) {
      for (std::size_t y = 0; y < kSize; ++y) {
        const std::uint64_t mask = masks_[s][y];
        if (mask != expected_[s][y])
          fail("{}, triangle {}, sample {}, row {}: pixels {:x} in place of {:x}", methods_[method].name,
               triangle, s, y, mask, expected_[s][y]);
        if (mask == 0) continue;
        std::int8_t* const counts = &counts_[method][(s * kSize + y) * kSize];
        for (std::size_t x = 0; x < kSize; ++x) {
          const int covered = static_cast<int>(mask >> x & 1U);
          counts[x] = static_cast<std::int8_t>(counts[x] + (area < 0 ? -covered : covered));
        }
      }
    }
  }

  /// The edges that are not shared, as often as they are run along one way more than the other.
  void add_outline() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const auto& corners : mesh_.triangles)
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = corners[i], b = corners[(i + 1) % 3];
        edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
      }
    oracle_.clear();
    for (const auto& [edge, times] : edges)
      if (times != 0) oracle_.add_edge(place(edge.first), place(edge.second), times);
  }

  void check_counts() {
    add_outline();
    bool twice = false;
    for (int s = 0; s < window_.samples; ++s)
      for (int y = 0; y < CoverageWindow::kSize; ++y)
        for (int x = 0, winding = 0; x < CoverageWindow::kSize; ++x) {
          winding += oracle_.winding_step(s, y, x);
          check_count(s, y, x, winding);
          twice = twice || winding > 1;
        }
    folded_ = folded_ || twice;
  }

  void check_count(int s, int y, int x, int winding) {
    const auto at = static_cast<std::size_t>((s * CoverageWindow::kSize + y) * CoverageWindow::kSize + x);
    for (std::size_t m = 0; m < methods_.size(); ++m) {
      const int count = counts_[m][at];
      if (count != winding)
        fail("{}, sample {}, pixel {},{} of the window: covered {} times in place of {}", methods_[m].name, s,
             x, y, count, winding);
    }
  }

  const CoverageMesh& mesh_;
  const CoverageWindow& window_;
  std::span<const CoverageMethod> methods_;
  SampleGrid grid_;
  SetupState state_;
  CoverageOracle oracle_;
  std::vector<WindowVertex> snapped_;
  WindowMasks expected_{}, masks_{};
  std::vector<std::vector<std::int8_t>> counts_;  ///< by method: at each sample, row and column
  std::int64_t samples_ = 0;
  bool folded_ = false;  ///< a triangle was turned round, or the outline winds around a sample twice
  CoverageTally tally_;
};

}  // namespace

std::span<const CoverageMethod> coverage_methods() {
  static const std::array<CoverageMethod, 2> methods{
      {{"edge functions", cover_by_edge_functions}, {"edge walking", cover_by_edge_walking}}};
  return methods;
}

void CoverageTally::add(const CoverageTally& other) {
  meshes += other.meshes;
  triangles += other.triangles;
  kept += other.kept;
  covering += other.covering;
  covered += other.covered;
  ties += other.ties;
  folded += other.folded;
  failed += other.failed;
  if (first_failure.empty()) first_failure = other.first_failure;
}

CoverageTally try_mesh(const CoverageMesh& mesh, const CoverageWindow& window,
                       std::span<const CoverageMethod> methods) {
  return MeshTrial(mesh, window, methods).run();
}

CoverageTally try_mesh_number(std::uint32_t seed, std::uint32_t number, MeshKind& kind) {
  RandomSource random(seed * 2654435761U + number);
  const CoverageWindow window = random_window(random);
  const CoverageMesh mesh = random_mesh(random, window);
  kind = mesh.kind;
  return try_mesh(mesh, window);
}

}  // namespace quadrille::models
