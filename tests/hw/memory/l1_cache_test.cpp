/// First-level cache: hits, merged misses, stalls, and sectors written whole or in part.
#include "hw/memory/l1_cache.h"
#include "tests/hw/cache_user.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

constexpr int kLatency = 20;  ///< of the memory behind the cache, cycles

using User = CacheUser<L1Cache>;
using Use = User::Use;
struct Shape {
  int lines = 4, ways = 4, misses = 4;
};

Use read(std::uint32_t line, std::uint8_t sectors, std::uint32_t waiter) {
  return [=](User& u) {
    constexpr const char* kNames[] = {"hit", "pending", "stall"};
    u.log += fmt::format("{}; ", kNames[static_cast<int>(u.cache.access(line, sectors, waiter, u.port))]);
  };
}
Use claim(std::uint32_t line, std::uint8_t sectors) {
  return [=](User& u) { u.log += u.cache.claim(line, sectors, u.port) ? "" : "no place; "; };
}
Use write(std::uint32_t line, std::uint32_t words) {
  return [=](User& u) { u.cache.write(line, words); };
}
const Use kFlush = [](User& u) { u.cache.flush(u.port); };

struct CacheBench final : Bench {
  struct Setup {
    std::vector<Timed<Use>> script;
    Shape shape{};
  };
  CacheBench(Driver& driver, const contract::Variation& v, const Setup& s) : Bench(driver, v) {
    (void)device.allocate(1 << 12);
    unit = std::make_unique<User>("unit", clock, s.script, s.shape.lines, s.shape.ways, s.shape.misses);
    unit->cache.own_dirty_lines(device, 1);
    add(*unit);
    memory = &serve(unit->port, kLatency);
  }
  std::unique_ptr<User> unit;
  StubMemory* memory = nullptr;
};

/// The same for a cache that only reads.
struct ReadBench final : Bench {
  using Setup = CacheBench::Setup;
  ReadBench(Driver& driver, const contract::Variation& v, const Setup& s) : Bench(driver, v) {
    (void)device.allocate(1 << 12);
    unit = std::make_unique<User>("unit", clock, s.script, s.shape.lines, s.shape.ways, s.shape.misses);
    add(*unit);
    (void)serve(unit->port, kLatency);
  }
  std::unique_ptr<User> unit;
};

/// What the user was told, and what reached memory as "kind line/sectors" without times.
std::string seen(const CacheBench& b) {
  return fmt::format("{}|{} | dirty {}", b.unit->log, requests_seen(*b.memory), b.device.dirty_lines());
}
std::string seen(std::vector<Timed<Use>> script, Shape shape = {}) {
  return run<CacheBench>({std::move(script), shape}, [](const CacheBench& b) { return seen(b); });
}

constexpr std::uint32_t kFirstSector = 0xff, kHalf = 0x0f, kOtherHalf = 0xf0;

}  // namespace

TEST_CASE("l1_cache: a line under way serves all who ask for it, and is a hit afterwards") {
  CHECK(seen({{0, read(3, 0x3, 1)}, {1, read(3, 0x1, 2)}, {2, read(3, 0x6, 3)}, {60, read(3, 0x7, 4)}}) ==
        "pending; pending; pending; ready 1; ready 2; ready 3; hit; | r3/3 r3/4 | dirty 0");
}

TEST_CASE("l1_cache: every look-up is a hit, merged or a miss, and a place for a write is a hit") {
  const CacheBench::Setup s{
      {{0, read(3, 0x3, 1)}, {1, read(3, 0x1, 2)}, {60, read(3, 0x3, 3)}, {61, claim(4, 0)}, {62, kFlush}}};
  CHECK(run<CacheBench>(s, [](const CacheBench& b) {
          const L1CacheStats& c = b.unit->cache.stats();
          return fmt::format("requests {} hits {} merged {} misses {}", c.requests.value(), c.hits.value(),
                             c.merged.value(), c.misses.value());
        }) == "requests 4 hits 2 merged 1 misses 1");
}

TEST_CASE("l1_cache: no free way, or no free entry for a miss, is a stall") {
  CHECK(seen({{0, read(1, 0xf, 1)}, {1, read(2, 0xf, 2)}, {60, read(2, 0xf, 2)}},
             {.lines = 1, .ways = 1, .misses = 4}) ==
        "pending; stall; ready 1; pending; ready 2; | r1/f r2/f | dirty 0");
  CHECK(seen({{0, read(1, 0xf, 1)}, {1, read(2, 0xf, 2)}}, {.lines = 4, .ways = 4, .misses = 1}) ==
        "pending; stall; ready 1; | r1/f | dirty 0");
}

TEST_CASE("l1_cache: a sector that is written whole is never read") {
  CHECK(seen({{0, claim(3, 0x1)}, {1, write(3, kFirstSector)}, {2, read(3, 0x1, 1)}, {3, kFlush}}) ==
        "hit; | w3/1 | dirty 0");
}

TEST_CASE("l1_cache: two parts make a whole sector, which leaves as if it had been written at once") {
  CHECK(seen({{0, claim(3, 0)},
              {1, write(3, kHalf)},
              {2, write(3, kOtherHalf)},
              {3, read(3, 0x1, 1)},
              {4, kFlush}}) == "hit; | w3/1 | dirty 0");
}

TEST_CASE("l1_cache: a sector written in part leaves in part, by a flush or as a victim") {
  CHECK(seen({{0, claim(3, 0)}, {1, write(3, kHalf | kFirstSector << 16)}, {2, kFlush}}) ==
        "| w3/4 p3/1 | dirty 0");
  CHECK(seen({{0, claim(3, 0)}, {1, write(3, kHalf)}, {2, claim(4, 0x2)}}, {.lines = 1, .ways = 1}) ==
        "| p3/1 | dirty 0");
}

TEST_CASE(
    "l1_cache: reading a sector that was written in part fetches the rest, and it is dirty as a whole") {
  CHECK(seen({{0, claim(3, 0)},
              {1, write(3, kHalf)},
              {2, read(3, 0x1, 1)},
              {60, read(3, 0x1, 2)},
              {61, kFlush}}) == "pending; ready 1; hit; | r3/1 w3/1 | dirty 0");
}

TEST_CASE("l1_cache: a part written while its sector is under way is kept") {
  CHECK(seen({{0, read(3, 0x1, 1)}, {1, write(3, kHalf)}, {60, kFlush}}) ==
        "pending; ready 1; | r3/1 w3/1 | dirty 0");
  CHECK(seen({{0, read(3, 0x1, 1)}, {1, write(3, kFirstSector)}, {60, kFlush}}) ==
        "pending; ready 1; | r3/1 w3/1 | dirty 0");
}

TEST_CASE("l1_cache: overwriting a sector that was written in part keeps it dirty until it leaves") {
  CHECK(seen({{0, claim(3, 0)}, {1, write(3, kHalf)}, {2, claim(3, 0x1)}, {3, kFlush}}) ==
        "| w3/1 | dirty 0");
}

namespace {

/// The kinds of misses of look-ups far enough apart for lines to arrive in between, but where `at` repeats.
std::string kinds_of(const std::vector<std::pair<std::int64_t, std::uint32_t>>& look_ups, Shape shape) {
  std::vector<Timed<Use>> script{{0, [](User& u) { u.cache.keep_miss_kinds(); }}};
  for (const auto& [at, line] : look_ups) script.push_back({at, read(line, 0xf, line)});
  return run<ReadBench>({std::move(script), shape}, [](const ReadBench& b) {
    const MissKindCounts& kinds = *b.unit->cache.miss_kinds();
    const L1CacheStats& c = b.unit->cache.stats();
    return fmt::format("{} merged, {} misses: {} compulsory {} capacity {} conflict, {} without sets",
                       c.merged.value(), c.misses.value(), kinds.misses[0], kinds.misses[1], kinds.misses[2],
                       kinds.associative_misses);
  });
}

}  // namespace

TEST_CASE("l1_cache: misses are told by kind, and a look-up that joins one under way is none") {
  CHECK(kinds_of({{10, 1}, {11, 1}, {12, 1}, {100, 1}}, {}) ==
        "2 merged, 1 misses: 1 compulsory 0 capacity 0 conflict, 1 without sets");
  CHECK(kinds_of({{100, 1}, {200, 2}, {300, 3}, {400, 1}, {500, 1}}, {.lines = 2, .ways = 2}) ==
        "0 merged, 4 misses: 3 compulsory 1 capacity 0 conflict, 4 without sets");
}

TEST_CASE("l1_cache: a look-up that is stalled counts once, when it gets through") {
  CHECK(kinds_of({{100, 1}, {101, 2}, {200, 2}}, {.lines = 1, .ways = 1, .misses = 4}) ==
        "0 merged, 2 misses: 2 compulsory 0 capacity 0 conflict, 2 without sets");
}
