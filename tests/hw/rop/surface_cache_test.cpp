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
  AcquiredLines done{};
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
    models::Format format = models::Format::kR8G8B8A8Unorm;
  };
  SurfaceBench(Driver& driver, const contract::Variation& v, const Setup& s) : Bench(driver, v) {
    surface = models::allocate_surface(device, 8, 32, 1, models::format_bytes(s.format));
    attachment = {surface, s.format, s.load, s.store, {{7}}, s.read_later};
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
    if (placed) u.cache.done = {};
  };
}
/// Pixels of tile (0, y) are written.
Use write_pixels(std::uint32_t y, std::uint64_t pixels) {
  return [=](User& u) { u.log += u.cache.write({0, 0, y}, pixels, u.port) ? "" : "not written; "; };
}
/// The same eight of each of these sectors.
Use write(std::uint32_t y, std::uint8_t sectors, std::uint8_t pixels) {
  std::uint64_t written = 0;
  for (unsigned s = 0; s < 8; ++s)
    if ((sectors >> s & 1) != 0) written |= std::uint64_t{pixels} << 8 * s;
  return write_pixels(y, written);
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

namespace {

/// Sectors that a write of these pixels reads, writes whole and writes in part.
std::string wished(std::uint64_t pixels, std::uint32_t pixel_bytes) {
  const SectorWishes wishes = wishes_of_write(pixels, pixel_bytes, false);
  CHECK(sectors_of(pixels, pixel_bytes) == (wishes.read | wishes.write | wishes.part));
  CHECK(wishes_of_write(pixels, pixel_bytes, true).read == sectors_of(pixels, pixel_bytes));
  return fmt::format("r{:x} w{:x} p{:x}", wishes.read, wishes.write, wishes.part);
}

constexpr std::uint64_t kAll = ~std::uint64_t{0};

}  // namespace

TEST_CASE("surface_cache: sectors of a tile by the bytes of its pixels") {
  CHECK(wished(kAll, 1) == "r0 w3 p0");
  CHECK(wished(kAll, 2) == "r0 wf p0");
  CHECK(wished(kAll, 4) == "r0 wff p0");
  CHECK(wished(kAll, 8) == "r0 wffff p0");
  CHECK(wished(kAll, 16) == "r0 wffffffff p0");
  CHECK(wished(0xf, 4) == "r0 w0 p1");     // the first quad: half a sector
  CHECK(wished(0xf, 8) == "r0 w1 p0");     // a sector
  CHECK(wished(0xf, 16) == "r0 w3 p0");    // two
  CHECK(wished(0x1, 16) == "r0 w0 p1");    // half of one
  CHECK(wished(0x1000, 8) == "r0 w0 p8");  // a pixel of the fourth quad
  CHECK(wished(0xffff0000ull, 2) == "r0 w2 p0");
}

TEST_CASE("surface_cache: pixels that fill a word in part have their sector read first") {
  CHECK(wished(0xf, 1) == "r0 w0 p1");  // a quad is a word
  CHECK(wished(0x7, 1) == "r1 w0 p0");
  CHECK(wished(0x3, 2) == "r0 w0 p1");  // two pixels are a word
  CHECK(wished(0x1, 2) == "r1 w0 p0");
  CHECK(wished(0x10003ull, 2) == "r2 w0 p1");
}

TEST_CASE("surface_cache: a tile of one-byte pixels moves half a line, of 16-byte pixels eight lines") {
  const auto whole_tile = [](models::Format format) {
    return seen({.script = {{1, acquire(1, {.write = sectors_of(kAll, models::format_bytes(format))}, 1)},
                            {2, write_pixels(1, kAll)},
                            {3, kFlush}},
                 .load = models::LoadOp::kLoad,
                 .format = format});
  };
  CHECK(whole_tile(models::Format::kR8Unorm) == "missing 0; | w1/3 | marked 0 found 0 written 0 dirty 0");
  CHECK(whole_tile(models::Format::kR16Float) == "missing 0; | w1/f | marked 0 found 0 written 0 dirty 0");
  CHECK(whole_tile(models::Format::kR16G16B16A16Float) ==
        "missing 0; | w4/f w5/f w6/f w7/f | marked 0 found 0 written 0 dirty 0");
  CHECK(whole_tile(models::Format::kR32G32B32A32Float) ==
        "missing 0; | w8/f w9/f w10/f w11/f w12/f w13/f w14/f w15/f | marked 0 found 0 written 0 dirty 0");
}

TEST_CASE("surface_cache: tiles that are still marked are written whole, whatever their pixels") {
  const auto flushed = [](models::Format format) {
    return seen(
        {.script = {{0, acquire(0, {.read = 0x1}, 1)}, {1, kFlush}}, .read_later = true, .format = format});
  };
  CHECK(flushed(models::Format::kR8Unorm) ==
        "missing 0; | w0/3 w1/3 w2/3 w3/3 | marked 4 found 1 written 3 dirty 0");
  CHECK(flushed(models::Format::kR16Float) ==
        "missing 0; | w0/f w1/f w2/f w3/f | marked 4 found 1 written 3 dirty 0");
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
