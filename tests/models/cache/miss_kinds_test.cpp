/// Kinds of misses on sequences of addresses for which they are known, and beside caches of all shapes.
#include "models/cache/miss_kinds.h"

#include <catch2/catch.hpp>

#include <array>
#include <random>
#include <string>
#include <vector>

#include "models/cache/tag_array.h"

using namespace quadrille::models;

namespace {

constexpr SectorMask kAll = 0xf;

/// A cache whose fills take no time, and the kinds of its misses.
struct Watched {
  Watched(std::uint32_t lines, std::uint32_t ways, const ReplacementPolicy& policy = kLruReplacement)
      : tags(lines, ways, 1, policy), kinds(lines) {}

  void look_up(std::uint32_t line, SectorMask sectors = kAll) {
    const MissKind kind = kinds.look_up(line, sectors, sectors);
    ideal_misses += kind != MissKind::kConflict;
    int slot = tags.lookup(line);
    if (slot == TagArray::kNone) slot = tags.allocate(line).slot;
    const auto missing = static_cast<SectorMask>(sectors & ~tags.at(slot).valid);
    if (missing == 0) return;
    tags.mark_pending(slot, missing);
    tags.fill(slot, missing);
    ++misses[static_cast<std::size_t>(kind)];
  }
  Watched& sequence(const std::vector<std::uint32_t>& lines, int times = 1) {
    for (int i = 0; i < times; ++i)
      for (const std::uint32_t line : lines) look_up(line);
    return *this;
  }
  [[nodiscard]] std::uint64_t all() const { return misses[0] + misses[1] + misses[2]; }

  TagArray tags;
  MissKinds kinds;
  std::array<std::uint64_t, 3> misses{};  ///< by kind
  std::uint64_t ideal_misses = 0;         ///< of the associative cache
};

using Misses = std::array<std::uint64_t, 3>;

std::vector<std::uint32_t> run_of(std::uint32_t count) {
  std::vector<std::uint32_t> lines(count);
  for (std::uint32_t i = 0; i < count; ++i) lines[i] = i;
  return lines;
}

/// Another line of the set in which line 0 lies.
std::uint32_t rival(const Watched& cache) {
  TagArray tags = TagArray(cache.tags.sets() * cache.tags.ways(), cache.tags.ways());
  const int ways = static_cast<int>(tags.ways());
  const int slot = tags.allocate(0).slot;
  for (std::uint32_t line = 1;; ++line)
    if (const int other = tags.allocate(line).slot; other / ways == slot / ways) return line;
}

}  // namespace

TEST_CASE("miss kinds: each line of a stream misses once, because it comes for the first time") {
  CHECK(Watched(8, 2).sequence(run_of(1000)).misses == Misses{1000, 0, 0});
  CHECK(Watched(8, 2).sequence({5}, 100).misses == Misses{1, 0, 0});
}

TEST_CASE("miss kinds: a stream that is larger than the cache misses at each pass for want of room") {
  CHECK(Watched(8, 8).sequence(run_of(9), 4).misses == Misses{9, 27, 0});
  CHECK(Watched(8, 8).sequence(run_of(8), 4).misses == Misses{8, 0, 0});
}

TEST_CASE("miss kinds: two lines that take turns in one place are in conflict") {
  Watched direct(8, 1);
  const std::uint32_t other = rival(direct);
  CHECK(direct.sequence({0, other}, 50).misses == Misses{2, 0, 98});
  CHECK(Watched(8, 2).sequence({0, other}, 50).misses == Misses{2, 0, 0});
}

TEST_CASE(
    "miss kinds: a sector that comes for the first time is compulsory, whether its line is there or not") {
  Watched cache(2, 2);
  cache.look_up(1, 0x1);
  cache.look_up(1, 0x2);
  cache.look_up(1, 0x3);
  CHECK(cache.misses == Misses{2, 0, 0});
  cache.sequence({2, 3});  // line 1 leaves
  cache.look_up(1, 0x1);
  CHECK(cache.misses == Misses{4, 1, 0});
  cache.look_up(1, 0x2);  // came and went with its line
  CHECK(cache.misses == Misses{4, 2, 0});
  cache.look_up(1, 0x6);
  CHECK(cache.misses == Misses{5, 2, 0});
}

TEST_CASE("miss kinds: what a miss brings beside what is asked for is there afterwards") {
  MissKinds kinds(4);
  CHECK(kinds.look_up(7, 0x1, kAll) == MissKind::kCompulsory);
  CHECK(kinds.look_up(7, 0x8, kAll) ==
        MissKind::kConflict);  // a cache that misses here lost it for another reason
}

TEST_CASE("miss kinds: a cache that was emptied meets its lines for the first time") {
  MissKinds kinds(2);
  for (const std::uint32_t line : {1U, 2U, 3U}) (void)kinds.look_up(line, kAll, kAll);
  CHECK(kinds.look_up(1, kAll, kAll) == MissKind::kCapacity);
  kinds.forget();
  for (const std::uint32_t line : {1U, 2U}) CHECK(kinds.look_up(line, kAll, kAll) == MissKind::kCompulsory);
  for (const std::uint32_t line : {1U, 2U}) CHECK(kinds.look_up(line, kAll, kAll) == MissKind::kConflict);
}

TEST_CASE(
    "miss kinds: with as many ways as lines and LRU nothing is in conflict, and all caches see the same "
    "first misses") {
  std::mt19937 random(3);
  std::vector<std::pair<std::uint32_t, SectorMask>> looks;
  looks.reserve(20000);
  for (int i = 0; i < 20000; ++i)  // most look-ups near where the latest were
    looks.emplace_back(static_cast<std::uint32_t>(i / 40 + static_cast<int>(random() % 60)),
                       static_cast<SectorMask>(1 + random() % 15));
  std::uint64_t compulsory = 0, ideal = 0;
  for (const std::uint32_t ways : {32U, 8U, 4U, 2U, 1U}) {
    Watched cache(32, ways);
    for (const auto& [line, sectors] : looks) cache.look_up(line, sectors);
    CAPTURE(ways);
    if (ways == 32) {
      CHECK(cache.misses[2] == 0);
      CHECK(cache.all() == cache.ideal_misses);
      compulsory = cache.misses[0];
      ideal = cache.ideal_misses;
    } else {
      CHECK(cache.misses[2] > 0);
    }
    CHECK(cache.misses[0] == compulsory);
    CHECK(cache.ideal_misses == ideal);
    CHECK(cache.misses[1] <= ideal - compulsory);
  }
}
