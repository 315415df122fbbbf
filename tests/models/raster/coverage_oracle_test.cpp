/// The exact oracle of coverage: it says what the definition says, the machine agrees with it in meshes of
/// every kind, and a rasteriser with a fault is found. `coverage_check` tries a million triangles.
#include "tests/models/raster/coverage_oracle.h"
#include "models/raster/coarse.h"
#include "tests/models/raster/brute_force.h"
#include "tests/models/raster/coverage_trial.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>

using namespace quadrille::models;

namespace {

constexpr int kSize = CoverageWindow::kSize;

/// The machine's coverage by edge functions, of a set-up that is spoilt before.
CoverageMethod spoilt(const char* name, void (*spoil)(TriangleSetup&)) {
  return {name, [spoil](const TriangleSetup& setup, const SampleGrid& grid, const CoverageWindow& window,
                        WindowMasks& masks) {
            TriangleSetup t = setup;
            spoil(t);
            return coverage_methods()[0].cover(t, grid, window, masks);
          }};
}

/// Meshes of the first few hundred that fail with a method.
int failures_with(const CoverageMethod& method) {
  int failures = 0;
  for (std::uint32_t number = 0; number < 300; ++number) {
    RandomSource random(number);
    const CoverageWindow window = random_window(random);
    failures += static_cast<int>(try_mesh(random_mesh(random, window), window, {&method, 1}).failed);
  }
  return failures;
}

}  // namespace

TEST_CASE("coverage_oracle: its sample locations are those of the machine") {
  for (const int samples : {1, 2, 4, 8}) {
    for (int bits = 4; bits <= 12; ++bits) {
      const SampleGrid grid = sample_grid(samples, bits);
      const CoverageWindow window{0, 0, bits, samples};
      for (int s = 0; s < samples; ++s) {
        const OraclePoint at = oracle_sample(window, s);
        const std::int64_t half = std::int64_t{1} << (bits - 1);
        CHECK(at.x == half + grid.offset[static_cast<std::size_t>(s)].x);
        CHECK(at.y == half + grid.offset[static_cast<std::size_t>(s)].y);
      }
    }
  }
}

TEST_CASE("coverage_oracle: what three edges wind around is what the definition covers") {
  RandomSource random(31);
  for (int round = 0; round < 300; ++round) {
    const CoverageWindow window{0, 0, random.integer(4, 12), 1 << round % 4};
    const auto v = awkward_triangle(random, kSize, window.subpixel_bits);
    CoverageOracle oracle(window);
    for (std::size_t i = 0; i < 3; ++i)
      oracle.add_edge({v[i].x, v[i].y}, {v[(i + 1) % 3].x, v[(i + 1) % 3].y});
    WindowMasks masks{};
    oracle.covered(masks);
    const SampleGrid grid = sample_grid(window.samples, window.subpixel_bits);
    for (std::size_t s = 0; s < static_cast<std::size_t>(window.samples); ++s)
      for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
          const bool covered = (masks[s][static_cast<std::size_t>(y)] >> x & 1U) != 0;
          if (covered != covers(v, x, y, window.subpixel_bits, grid.offset[s]))
            FAIL("round " << round << " pixel " << x << "," << y << " sample " << s);
        }
  }
  SUCCEED();
}

TEST_CASE("coverage_oracle: meshes of every kind are covered exactly once, in both ways of traversal") {
  std::array<CoverageTally, kMeshKindNames.size()> tallies;
  for (std::uint32_t number = 0; number < 2400; ++number) {
    MeshKind kind{};
    const CoverageTally tally = try_mesh_number(1, number, kind);
    INFO("mesh " << number << ": " << tally.first_failure);
    REQUIRE(tally.failed == 0);
    tallies[static_cast<std::size_t>(kind)].add(tally);
  }
  // What makes the trial worth its name: each kind covers samples, and has some on its edges.
  for (const CoverageTally& tally : tallies) {
    CHECK(tally.triangles > 8000);
    CHECK(tally.covered > 5000);
    CHECK(tally.ties > 2000);
    CHECK(tally.folded < tally.meshes);
  }
}

TEST_CASE(
    "coverage_oracle: a rasteriser that covers both sides of an edge, neither, or too little is found") {
  const auto loosen = [](TriangleSetup& t) {
    for (EdgeFunction& edge : t.edges) edge.fraction += 1;
  };
  const auto tighten = [](TriangleSetup& t) {
    for (EdgeFunction& edge : t.edges) edge.origin -= 1;
  };
  const auto narrow = [](TriangleSetup& t) { ++t.bounds.x0; };
  CHECK(failures_with(coverage_methods()[0]) == 0);
  CHECK(failures_with(spoilt("both sides", loosen)) > 10);
  CHECK(failures_with(spoilt("neither side", tighten)) > 10);
  CHECK(failures_with(spoilt("too narrow", narrow)) > 100);
}
