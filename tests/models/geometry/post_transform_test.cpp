/// Vertex reuse: places of vertices under each policy, and the number shaded, held to meshoptimizer's
/// analyser to the vertex.
#include "models/geometry/post_transform.h"

#include "tests/models/aborts.h"
#include "tests/models/random_source.h"

#include <meshoptimizer.h>
#include <catch2/catch.hpp>

#include <algorithm>
#include <map>

using namespace quadrille::models;

namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Mesh = std::vector<Triangle>;

/// Corners of a grid of `side` x `side` squares, row by row.
Mesh grid(std::uint32_t side) {
  Mesh mesh;
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) {
      const std::uint32_t a = y * (side + 1) + x, b = a + 1, c = a + side + 1, d = c + 1;
      mesh.push_back({a, b, c});
      mesh.push_back({c, b, d});
    }
  }
  return mesh;
}
Mesh strip(std::uint32_t triangles) {
  Mesh mesh;
  for (std::uint32_t i = 0; i < triangles; ++i) mesh.push_back({i, i + 1 + i % 2, i + 2 - i % 2});
  return mesh;
}
Mesh shuffled(Mesh mesh, std::uint32_t seed) {
  RandomSource random(seed);
  for (std::size_t i = mesh.size(); i > 1; --i)
    std::swap(mesh[i - 1], mesh[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
  return mesh;
}
/// Random corners of few vertices: many triangles name one vertex two or three times.
Mesh degenerate(int vertices, int triangles, std::uint32_t seed) {
  RandomSource random(seed);
  Mesh mesh(static_cast<std::size_t>(triangles));
  for (Triangle& t : mesh) {
    for (std::uint32_t& v : t) v = static_cast<std::uint32_t>(random.integer(0, vertices - 1));
  }
  return mesh;
}
Mesh repeated(std::size_t triangles) { return Mesh(triangles, Triangle{0, 1, 2}); }

std::vector<Mesh> meshes() {
  std::vector<Mesh> all{
      grid(1),      grid(7),      grid(40),      strip(500), shuffled(grid(40), 1), shuffled(strip(300), 2),
      repeated(32), repeated(33), repeated(1000)};
  for (std::uint32_t seed = 0; seed < 40; ++seed)
    all.push_back(degenerate(3 + 9 * static_cast<int>(seed), 400, seed));
  return all;
}

/// Vertices shaded, batches formed as vertex fetch forms them, each in a slot of its own.
std::uint64_t shaded(const Mesh& mesh, const VertexReusePolicy& policy, const VertexReuseSetup& setup,
                     std::size_t batch_triangles) {
  const std::unique_ptr<VertexReuse> made = policy.make(setup);
  VertexReuse& reuse = *made;
  std::uint64_t vertices = 0;
  std::uint32_t slot = 0;
  for (std::size_t t = 0; t < mesh.size();) {
    reuse.start_batch(slot++);
    for (std::size_t n = 0; t < mesh.size() && n < batch_triangles && reuse.fits(mesh[t]); ++n, ++t) {
      for (const std::uint32_t v : mesh[t]) (void)reuse.place(v);
    }
    vertices += static_cast<std::uint64_t>(reuse.size());
  }
  return vertices;
}
std::uint64_t analysed(const Mesh& mesh, unsigned cache, unsigned warp, unsigned group) {
  std::vector<unsigned> indices;
  for (const Triangle& t : mesh) indices.insert(indices.end(), t.begin(), t.end());
  return meshopt_analyzeVertexCache(indices.data(), indices.size(),
                                    *std::ranges::max_element(indices) + std::size_t{1}, cache, warp, group)
      .vertices_transformed;
}

}  // namespace

TEST_CASE(
    "post_transform: batches shade as many vertices as meshoptimizer's analyser says, whatever their size") {
  for (const Mesh& mesh : meshes()) {
    for (const unsigned vertices : {3u, 4u, 5u, 16u, 31u, 32u}) {
      for (const unsigned triangles : {1u, 2u, 32u, 64u, 128u}) {
        CHECK(shaded(mesh, kBatchReuse, {static_cast<int>(vertices)}, triangles) ==
              analysed(mesh, vertices, vertices, triangles));
      }
    }
  }
}

TEST_CASE(
    "post_transform: a FIFO shades as many vertices as meshoptimizer's analyser says, however the batches "
    "are cut") {
  for (const Mesh& mesh : meshes()) {
    for (const unsigned entries : {3u, 4u, 16u, 32u, 128u}) {
      for (const int vertices : {3, 5, 32}) {
        CHECK(shaded(mesh, kFifoReuse, {vertices, static_cast<int>(entries)}, 1 + entries) ==
              analysed(mesh, entries, 0, 0));
      }
    }
  }
}

TEST_CASE("post_transform: without reuse every corner is shaded") {
  for (const Mesh& mesh : meshes()) CHECK(shaded(mesh, kNoReuse, {}, 32) == 3 * mesh.size());
}

TEST_CASE(
    "post_transform: the published steps: 0,1,2 repeated is shaded again from the 33rd triangle of a "
    "GeForce, the 129th of a Radeon") {
  for (const std::size_t limit : {32u, 128u}) {
    CHECK(shaded(repeated(limit), kBatchReuse, {}, limit) == 3);
    CHECK(shaded(repeated(limit + 1), kBatchReuse, {}, limit) == 6);
  }
}

TEST_CASE("post_transform: a batch gives each vertex one lane in order of arrival") {
  RandomSource random(101);
  for (int round = 0; round < 300; ++round) {
    const std::unique_ptr<VertexReuse> made = kBatchReuse.make({});
    VertexReuse& reuse = *made;
    std::map<std::uint32_t, int> lanes;
    // Indices that meet in the hash table: the same bits, and far ones.
    const std::uint32_t base = random.bits(), step = round % 3 == 0 ? 1u << 25 : 1u;
    for (int i = 0; i < 500; ++i) {
      Triangle triangle;
      for (std::uint32_t& v : triangle) v = base + step * static_cast<std::uint32_t>(random.integer(0, 60));
      const auto missing =
          std::ranges::count_if(triangle, [&](std::uint32_t v) { return !lanes.contains(v); });
      REQUIRE(reuse.fits(triangle) == (lanes.size() + static_cast<std::size_t>(missing) <= 32));
      if (!reuse.fits(triangle)) {
        reuse.start_batch(0);
        lanes.clear();
        CHECK(reuse.size() == 0);
        continue;
      }
      for (const std::uint32_t v : triangle) {
        const int lane = lanes.emplace(v, reuse.size()).first->second;
        REQUIRE(reuse.place(v).lane == lane);
        REQUIRE(reuse.index(lane) == v);
      }
      REQUIRE(static_cast<std::size_t>(reuse.size()) == lanes.size());
    }
  }
}

TEST_CASE("post_transform: a full batch refuses another vertex, and a new one named twice asks two lanes") {
  const std::unique_ptr<VertexReuse> made = kBatchReuse.make({});
  VertexReuse& reuse = *made;
  for (std::uint32_t i = 0; i < 31; ++i) CHECK(reuse.place(i * 7).lane == i);
  CHECK(reuse.fits(Triangle{0, 7, 1}));
  CHECK_FALSE(reuse.fits(Triangle{0, 1, 1}));
  (void)reuse.place(1);
  CHECK(reuse.fits(Triangle{0, 7, 1}));
  CHECK_FALSE(reuse.fits(Triangle{0, 7, 2}));
  CHECK(aborts([&] { (void)reuse.place(2); }));
}

TEST_CASE(
    "post_transform: a FIFO names the slot that shaded a vertex until it is pushed out, and forgets whole "
    "slots to keep a limit") {
  const std::unique_ptr<VertexReuse> made = kFifoReuse.make({32, 4});
  VertexReuse& reuse = *made;
  reuse.start_batch(5);
  for (const std::uint32_t v : {10u, 11u, 12u}) (void)reuse.place(v);
  reuse.start_batch(6);
  CHECK(reuse.place(11).slot == 5);
  CHECK(reuse.place(11).lane == 1);
  CHECK(reuse.place(13).slot == 6);
  CHECK(reuse.place(14).lane == 1);  // pushes 10 out
  CHECK(reuse.size() == 2);
  CHECK(reuse.slots_remembered() == 2);
  CHECK(reuse.place(10).slot == 6);  // pushes 11 out
  CHECK(reuse.remembers(5));         // for 12
  reuse.limit_slots(1);
  CHECK_FALSE(reuse.remembers(5));
  CHECK(reuse.remembers(6));
  reuse.start_draw();
  CHECK(reuse.slots_remembered() == 0);
  CHECK(reuse.place(14).lane == 3);
}
