/// The miss table: who waits for a line that is under way, and when they are told.
#include "models/cache/miss_table.h"

#include "tests/models/random_source.h"

#include <catch2/catch.hpp>

#include <map>
#include <set>
#include <vector>

using namespace quadrille::models;

namespace {

constexpr std::size_t kEntries = 2;

/// A cache of eight lines that may have two under way, and the waiters it has told.
struct Cache {
  TagArray tags{8, 8};
  MissTable<int> misses{tags, kEntries};
  std::vector<int> told;

  auto ask(std::uint32_t line, SectorMask sectors) {
    return misses.ask(tags.find(line), sectors, [&] { return tags.allocate(line).slot; });
  }
  bool arrive(std::uint32_t tag, SectorMask sectors) {
    const bool all = misses.arrive(tag, sectors);
    if (all) misses.release(tag, [&](int waiter) { told.push_back(waiter); });
    return all;
  }
};

}  // namespace

TEST_CASE("miss_table: a line under way serves all who ask for it, in the order in which they came") {
  Cache cache;
  const auto first = cache.ask(5, 0x3);
  REQUIRE(first);
  CHECK(first->missing == 0x3);
  cache.misses.wait(first->tag, 10);
  const auto second = cache.ask(5, 0x6);
  REQUIRE(second);
  CHECK(second->tag == first->tag);
  CHECK(second->missing == 0x4);  // the other is on its way already
  cache.misses.wait(second->tag, 11);
  const auto third = cache.ask(5, 0x2);
  REQUIRE(third);
  CHECK(third->missing == 0);
  cache.misses.wait(third->tag, 12);
  CHECK(cache.misses.under_way() == 1);

  CHECK_FALSE(cache.arrive(first->tag, 0x3));
  CHECK(cache.told.empty());
  CHECK(cache.arrive(first->tag, 0x4));
  CHECK(cache.told == std::vector<int>{10, 11, 12});
  CHECK(cache.misses.idle());
}

TEST_CASE("miss_table: a full table refuses another line, and takes more for those under way") {
  Cache cache;
  const auto one = cache.ask(1, 0x1);
  const auto two = cache.ask(2, 0x1);
  REQUIRE(one);
  REQUIRE(two);
  CHECK(one->tag != two->tag);
  CHECK(cache.misses.full());
  CHECK_FALSE(cache.ask(3, 0x1));
  CHECK(cache.tags.find(3) == TagArray::kNone);  // it was given no place either
  CHECK(cache.ask(1, 0x2));
  CHECK_FALSE(cache.arrive(one->tag, 0x1));
  CHECK(cache.arrive(one->tag, 0x2));
  CHECK_FALSE(cache.misses.full());
  CHECK(cache.ask(3, 0x1));
}

TEST_CASE("miss_table: a line that gets no place takes no entry") {
  TagArray tags(1, 1);
  MissTable<int> misses(tags, kEntries);
  const auto place = [&](std::uint32_t line) { return [&tags, line] { return tags.allocate(line).slot; }; };
  const auto one = misses.ask(tags.find(1), 0x1, place(1));
  REQUIRE(one);
  CHECK_FALSE(misses.ask(tags.find(2), 0x1, place(2)));  // the only way is under way
  CHECK(misses.under_way() == 1);
  REQUIRE(misses.arrive(one->tag, 0x1));
  misses.release(one->tag, [](int) {});
  CHECK(misses.ask(tags.find(2), 0x1, place(2)));
}

TEST_CASE("miss_table: every waiter is told once, when all sectors that were asked for are there") {
  RandomSource random(17);
  Cache cache;
  std::map<std::uint32_t, SectorMask> on_the_way;         // by tag
  std::map<std::uint32_t, std::vector<int>> waiting_for;  // by tag
  int asked = 0, refused = 0, told = 0;
  for (int step = 0; step < 20000; ++step) {
    if (cache.misses.idle() && random.integer(0, 7) == 0) cache.tags.invalidate_all();
    if (random.integer(0, 1) == 0) {
      const auto line = static_cast<std::uint32_t>(random.integer(0, 5));
      const auto sectors = static_cast<SectorMask>(random.integer(1, 15));
      const int slot = cache.tags.lookup(line);
      if (slot != TagArray::kNone && (cache.tags.at(slot).valid & sectors) == sectors) continue;
      const auto got = cache.ask(line, sectors);
      if (!got) {
        CHECK(on_the_way.size() == kEntries);
        ++refused;
        continue;
      }
      if (got->missing != 0)
        on_the_way[got->tag] = static_cast<SectorMask>(on_the_way[got->tag] | got->missing);
      cache.misses.wait(got->tag, step);
      waiting_for[got->tag].push_back(step);
      ++asked;
    } else if (!on_the_way.empty()) {
      const auto [tag, sectors] = *on_the_way.begin();
      const auto arriving = static_cast<SectorMask>(sectors & -sectors);  // one at a time
      cache.told.clear();
      const bool all = cache.arrive(tag, arriving);
      REQUIRE(all == (sectors == arriving));
      if (!all) {
        on_the_way[tag] = static_cast<SectorMask>(sectors & ~arriving);
        continue;
      }
      REQUIRE(cache.told == waiting_for[tag]);
      told += static_cast<int>(cache.told.size());
      waiting_for.erase(tag);
      on_the_way.erase(tag);
    }
  }
  for (const auto& [tag, waiters] : waiting_for) told += static_cast<int>(waiters.size());
  CHECK(told == asked);
  CHECK(asked > 1000);
  CHECK(refused > 100);
}
