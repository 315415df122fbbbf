/// The surface cache by itself: tiles that are marked instead of cleared, sectors that are fetched, written
/// whole or in part, and what a flush writes.
#include "hw/rop/surface_cache.h"
#include "tests/hw/cache_user.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

constexpr int kLatency = 20;  ///< of the memory behind the cache, cycles

/// With what `acquire` remembers of the tile that is being acquired.
struct RememberingCache : SurfaceCache {
  using SurfaceCache::SurfaceCache;
  std::uint8_t done = 0;
};
using User = CacheUser<RememberingCache>;
using Use = User::Use;
struct Shape {
  int lines = 16, ways = 16, misses = 4;
};

struct SurfaceBench final : Bench {
  struct Setup {
    std::vector<Timed<Use>> script;
    Shape shape{};
    std::uint32_t partitions = 1;  ///< that share the surface; the cache is of the first
    models::LoadOp load = models::LoadOp::kClear;
    models::StoreOp store = models::StoreOp::kStore;
    bool read_later = false;
  };
  SurfaceBench(Driver& driver, const contract::Variation& v, const Setup& s) : Bench(driver, v) {
    surface = models::allocate_surface(device, 8, 32);
    attachment = {surface, models::Format::kR8G8B8A8Unorm, s.load, s.store, 7, s.read_later};
    unit = std::make_unique<User>("unit", clock, s.script, s.shape.lines, s.shape.ways, s.shape.misses,
                                  device, surface_writer(SurfaceKind::kColor, PartitionId(0)));
    unit->cache.begin_pass({&attachment, 1}, PartitionId(0), s.partitions);
    add(*unit);
    memory = &serve(unit->port, kLatency);
  }
  /// A column of four tiles: lines 0 and 1 of the surface are the first tile's, and so on.
  models::SurfaceLayout surface;
  AttachmentState attachment;
  std::unique_ptr<User> unit;
  StubMemory* memory = nullptr;
};

/// Asks for sectors of tile (0, y): what is missing is noted, or "no place".
Use acquire(std::uint32_t y, const SectorWishes& wishes, std::uint32_t waiter) {
  return [=](User& u) {
    int missing = 0;
    const bool placed = u.cache.acquire({0, 0, y}, wishes, waiter, missing, u.cache.done, u.port);
    u.log += placed ? fmt::format("missing {}; ", missing) : fmt::format("no place, missing {}; ", missing);
    if (placed) u.cache.done = 0;
  };
}
/// Pixels of tile (0, y) are written: the same of each of these sectors.
Use write(std::uint32_t y, std::uint8_t sectors, std::uint8_t pixels) {
  return [=](User& u) {
    SectorPixels written{};
    for (unsigned s = 0; s < 8; ++s) written[s] = (sectors >> s & 1) != 0 ? pixels : std::uint8_t{0};
    u.log += u.cache.write({0, 0, y}, written, u.port) ? "" : "not written; ";
  };
}
const Use kFlush = [](User& u) { u.cache.flush(u.port); };

/// What the user was told, then what reached memory as "kind line/sectors", lines counted from the surface's
/// first, then the counts of clears.
std::string seen(const SurfaceBench::Setup& setup) {
  return run<SurfaceBench>(setup, [](const SurfaceBench& b) {
    const auto first = static_cast<std::uint32_t>(b.surface.base / models::kLineBytes);
    const std::string text = fmt::format("{}|{}", b.unit->log, requests_seen(*b.memory, first));
    return text + fmt::format(" | marked {} found {} written {} dirty {}",
                              counter(*b.unit, "fast_cleared_tiles"), counter(*b.unit, "clear_hits"),
                              counter(*b.unit, "clear_writes"), b.device.dirty_lines());
  });
}

constexpr std::uint8_t kWhole = 0xff, kFirstQuad = 0x0f;

}  // namespace

TEST_CASE("surface_cache: a clear marks tiles and asks nothing of memory") {
  CHECK(seen({.script = {}}) == "| | marked 4 found 0 written 0 dirty 0");
  CHECK(seen({.script = {}, .partitions = 2}) == "| | marked 2 found 0 written 0 dirty 0");
}

TEST_CASE("surface_cache: the first access to a marked tile finds all of it, and it is written once") {
  CHECK(seen({.script = {{0, acquire(0, {.read = 0x01}, 1)},
                         {1, acquire(0, {.read = 0xff}, 2)},
                         {2, kFlush}}}) ==
        "missing 0; missing 0; | w0/f w1/f | marked 4 found 1 written 0 dirty 0");
}

TEST_CASE("surface_cache: a flush writes tiles that are still marked if they are read later, else not") {
  CHECK(seen({.script = {{0, acquire(1, {.read = 0x01}, 1)}, {1, kFlush}}, .read_later = true}) ==
        "missing 0; | w2/f w3/f w0/f w1/f w4/f w5/f w6/f w7/f | marked 4 found 1 written 3 dirty 0");
  CHECK(seen({.script = {{0, kFlush}}}) == "| | marked 4 found 0 written 0 dirty 0");
}

TEST_CASE("surface_cache: a surface that is discarded leaves nothing to write") {
  CHECK(seen({.script = {{0, acquire(1, {.write = 0x12}, 1)}, {1, write(1, 0x12, kWhole)}, {2, kFlush}},
              .store = models::StoreOp::kDiscard,
              .read_later = true}) == "missing 0; | | marked 4 found 1 written 0 dirty 0");
}

TEST_CASE("surface_cache: sectors of both lines of a tile are fetched, and the waiter is told of each") {
  CHECK(seen({.script = {{1, acquire(1, {.read = 0x21}, 9)}, {60, acquire(1, {.read = 0x21}, 9)}},
              .load = models::LoadOp::kLoad}) ==
        "missing 2; ready 9; ready 9; missing 0; | r2/1 r3/2 | marked 0 found 0 written 0 dirty 0");
}

TEST_CASE("surface_cache: a sector that is overwritten whole is not fetched") {
  CHECK(seen({.script = {{1, acquire(1, {.write = 0x12}, 1)}, {2, write(1, 0x12, kWhole)}, {3, kFlush}},
              .load = models::LoadOp::kLoad}) ==
        "missing 0; | w2/2 w3/1 | marked 0 found 0 written 0 dirty 0");
}

TEST_CASE("surface_cache: a sector that is written in part leaves in part") {
  CHECK(seen({.script = {{1, acquire(1, {.part = 0x10}, 1)}, {2, write(1, 0x10, kFirstQuad)}, {3, kFlush}},
              .load = models::LoadOp::kLoad}) == "missing 0; | p3/1 | marked 0 found 0 written 0 dirty 0");
}

TEST_CASE("surface_cache: a sector that is read and written is fetched before it is written back") {
  CHECK(seen({.script = {{1, acquire(0, {.read = 0x01, .write = 0x01}, 1)},
                         {60, write(0, 0x01, kFirstQuad)},
                         {61, kFlush}},
              .load = models::LoadOp::kLoad}) ==
        "missing 1; ready 1; | r0/1 w0/1 | marked 0 found 0 written 0 dirty 0");
}

TEST_CASE(
    "surface_cache: without a free entry a tile is asked for in two steps, and nothing is asked twice") {
  CHECK(
      seen({.script = {{1, acquire(1, {.read = 0x11}, 1)},
                       {2, acquire(1, {.read = 0x11}, 1)},
                       {60, acquire(1, {.read = 0x11}, 1)}},
            .shape = {.lines = 16, .ways = 16, .misses = 1},
            .load = models::LoadOp::kLoad}) ==
      "no place, missing 1; no place, missing 0; ready 1; missing 1; ready 1; | r2/1 r3/1 | marked 0 found 0 "
      "written 0 dirty 0");
}

TEST_CASE("surface_cache: a cache of one line gets a marked tile through, and its lines are written") {
  CHECK(seen({.script = {{0, acquire(0, {.part = 0x11}, 1)},
                         {1, write(0, 0x01, kWhole)},
                         {2, write(0, 0x10, kWhole)},
                         {3, kFlush}},
              .shape = {.lines = 1, .ways = 1, .misses = 1}}) ==
        "missing 0; | w0/f w1/f w0/1 w1/1 | marked 4 found 1 written 0 dirty 0");
}

TEST_CASE("surface_cache: quads of a tile lie two a sector") {
  CHECK(sectors_of_quads(0x0001) == 0x01);
  CHECK(sectors_of_quads(0x0003) == 0x01);
  CHECK(sectors_of_quads(0x000c) == 0x02);
  CHECK(sectors_of_quads(0x8000) == 0x80);
  CHECK(sectors_of_quads(0xffff) == 0xff);
}

TEST_CASE("surface_cache: the caches of depth and colour of all partitions are writers of their own") {
  std::vector<models::DeviceMemory::Owner> writers;
  for (int partition = 0; partition < 64; ++partition)
    for (const SurfaceKind kind : {SurfaceKind::kDepth, SurfaceKind::kColor})
      writers.push_back(surface_writer(kind, PartitionId(partition)));
  std::sort(writers.begin(), writers.end());
  CHECK(std::adjacent_find(writers.begin(), writers.end()) == writers.end());
  CHECK(writers.front() != models::DeviceMemory::kClean);
}
