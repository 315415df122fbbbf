/// Work counted from a mesh: by hand where it is small, and against the machine's counters, which count the
/// same events without sharing code.
#include "studies/experiments/triangle_work.h"
#include "studies/experiments/experiment.h"

#include <fmt/format.h>
#include <catch2/catch.hpp>

using namespace quadrille::studies::experiments;

namespace {

constexpr Sample kCentre[] = {{}};

TriangleMesh one_triangle(std::array<WindowCorner, 3> corners) {
  return {64, 64, {corners.begin(), corners.end()}, {{0, 1, 2}}};
}

}  // namespace

TEST_CASE(
    "triangle_work: a tile of 8x8 pixels is two triangles of ten quads, three cycles each at four quads a "
    "cycle") {
  const TriangleWork w = work_of(tiled_frame(8, 8, 8, 8), {});
  CHECK(w.triangles == 2);
  CHECK(w.fragments == 64);
  CHECK(w.quads == 20);
  CHECK(w.tiles == 2);
  CHECK(w.fine_clk == 6);
  CHECK(w.batches == 1);
  CHECK(w.vertices == 4);
}

TEST_CASE(
    "triangle_work: tiles of 2x1 pixels are triangles of one pixel, and neighbours never own a pixel twice") {
  for (const auto& [width, height] : {std::pair{2u, 1u}, {1u, 1u}, {3u, 5u}, {7u, 2u}}) {
    const TriangleMesh mesh = tiled_frame(30, 20, width, height);
    INFO(width << "x" << height);
    CHECK(work_of(mesh, {}).fragments == 600);
    CHECK(coverage_of(mesh, kCentre).pixels == 600);
  }
  const TriangleWork w = work_of(tiled_frame(32, 8, 2, 1), {});
  CHECK(w.triangles == w.fragments);
  CHECK(w.quads == w.fragments);
}

TEST_CASE(
    "triangle_work: left and top edges own the centres that lie on them, whichever way the triangle turns") {
  const WindowCorner a{128, 128}, b{128 + 4 * 256, 128}, c{128, 128 + 4 * 256};
  CHECK(coverage_of(one_triangle({a, b, c}), kCentre).pixels == 10);  // rows of 4, 3, 2, 1: not the diagonal
  CHECK(coverage_of(one_triangle({a, c, b}), kCentre).pixels == 10);
  const WindowCorner d{128 + 4 * 256, 128 + 4 * 256};
  // the diagonal is its left edge, its right and lower ones own nothing
  CHECK(coverage_of(one_triangle({b, d, c}), kCentre).pixels == 6);
}

TEST_CASE("triangle_work: samples off the centre find pixels that the centre misses") {
  const TriangleMesh speck = one_triangle({{{10, 10}, {100, 10}, {10, 100}}});
  constexpr Sample kCorner[] = {{}, {32, 32}};
  CHECK(coverage_of(speck, kCentre).quads == 0);
  CHECK(coverage_of(speck, kCorner).quads == 1);
}

TEST_CASE("triangle_work: what is counted is what the machine counts") {
  for (const auto& [width, height] :
       {std::pair{1u, 1u}, {3u, 5u}, {8u, 8u}, {16u, 16u}, {40u, 40u}, {256u, 1u}, {1u, 256u}, {100u, 7u}}) {
    INFO(width << "x" << height);
    const TriangleMesh mesh = tiled_frame(93, 57, width, height);
    const auto stream = stream_of(mesh);
    const Readings r = draw({{&stream, {}}}, {}).front();
    const TriangleWork w = work_of(mesh, {});
    const auto count = [&](const char* name) { return static_cast<std::uint64_t>(r[name]); };
    CHECK(w.triangles == count("triangle_setup.triangles"));
    CHECK(w.batches == count("vertex_fetch.batches"));
    CHECK(w.vertices == count("vertex_fetch.vertices"));
    CHECK(w.tile_tests == count("coarse_raster.tiles_tested"));
    CHECK(w.tiles == count("fine_raster.tiles"));
    CHECK(w.quads == count("fine_raster.quads"));
    CHECK(w.fragments == count("fine_raster.fragments"));
  }
}

TEST_CASE("triangle_work: rows and spans of edge walking are those that the machine counts") {
  for (const auto& [width, height] :
       {std::pair{1u, 1u}, {3u, 5u}, {8u, 8u}, {40u, 40u}, {256u, 1u}, {1u, 256u}, {100u, 7u}}) {
    INFO(width << "x" << height);
    const TriangleMesh mesh = tiled_frame(93, 57, width, height);
    const auto stream = stream_of(mesh);
    const Readings r = draw({{&stream, {"coarse_raster.traversal=edge_walking"}}}, {}).front();
    const TriangleWork w = work_of(mesh, {});
    const auto count = [&](const char* name) { return static_cast<std::uint64_t>(r[name]); };
    CHECK(w.walk_parts == count("coarse_raster.walked_parts"));
    CHECK(w.walk_rows == count("coarse_raster.rows"));
    CHECK(w.walk_spans == count("coarse_raster.spans"));
    CHECK(w.walk_segments == count("coarse_raster.segments"));
    CHECK(w.walk_tiles == count("fine_raster.tiles"));
    CHECK(w.quads == count("fine_raster.quads"));
    CHECK(w.fragments == count("fine_raster.fragments"));
    CHECK(count("fine_raster.tiles_empty") == 0);
  }
}

TEST_CASE("triangle_work: of a right triangle of edge walking, a row of tiles is walked while one leaves") {
  // Rows of 16 to 1 pixels: set-up and eight rows of two tiles or one, 2 + 8 cycles; then 8 more, while two
  // tiles leave, and the last one.
  const TriangleWork w = work_of(one_triangle({{{0, 0}, {0, 16 * 256}, {16 * 256, 0}}}), {});
  CHECK(w.walk_parts == 1);
  CHECK(w.walk_rows == 16);
  CHECK(w.walk_tiles == 3);
  CHECK(w.walk_clk == 2 + 8 + 8 + 1);
}
