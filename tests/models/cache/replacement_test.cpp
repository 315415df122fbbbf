/// Policies of replacement beside what each is known to do, and beside naive forms of themselves.
#include "models/cache/tag_array.h"

#include "tests/models/random_source.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <numeric>

using namespace quadrille::models;

namespace {

/// Part of the look-ups that hit when lines 0..lines-1 are used in turn, so many times, in one set.
double cyclic_hits(const ReplacementPolicy& policy, std::uint32_t ways, std::uint32_t lines, int times) {
  TagArray tags(ways, ways, 1, policy);
  int hits = 0;
  for (int time = 0; time < times; ++time)
    for (std::uint32_t line = 0; line < lines; ++line) {
      if (tags.lookup(line) != TagArray::kNone) ++hits;
      else (void)tags.allocate(line);
    }
  return hits / static_cast<double>(times * static_cast<int>(lines));
}

}  // namespace

TEST_CASE("replacement: whatever the policy, a set that fits stays, and no victim is pending") {
  RandomSource random(3);
  for (const ReplacementPolicy* policy : replacement_policies().all())
    for (const std::uint32_t ways : {1u, 2u, 3u, 7u, 8u, 24u, 64u}) {
      INFO(policy->name << ", " << ways << " ways");
      CHECK(cyclic_hits(*policy, ways, ways, 10) == Approx(0.9));
      const auto made = policy->make(5, ways);
      for (int step = 0; step < 3000; ++step) {
        const auto set = static_cast<std::uint32_t>(random.integer(0, 4));
        const auto way = static_cast<std::uint32_t>(random.integer(0, static_cast<int>(ways) - 1));
        std::uint64_t open = std::uint64_t{1} << way;
        for (std::uint32_t other = 0; other < ways; ++other)
          if (random.integer(0, 1) == 1) open |= std::uint64_t{1} << other;
        const std::uint32_t victim = made->victim(set, open);
        REQUIRE(victim < ways);
        REQUIRE((open >> victim & 1) == 1);
        if (random.integer(0, 1) == 1) made->placed(set * ways + victim);
        else made->used(set * ways + way);
      }
    }
}

TEST_CASE("replacement: of one line too many, those that go by age keep none, a random one keeps most") {
  CHECK(cyclic_hits(kLruReplacement, 8, 9, 200) == 0);
  CHECK(cyclic_hits(kFifoReplacement, 8, 9, 200) == 0);
  CHECK(cyclic_hits(kSrripReplacement, 8, 9, 200) == 0);  // none is used again before it is distant
  CHECK(cyclic_hits(kRandomReplacement, 8, 9, 2000) > 0.5);
}

TEST_CASE("replacement: a line in use stays for all but the first that came") {
  for (const auto& [policy, kept] : {std::pair{&kLruReplacement, true},
                                     {&kTreeReplacement, true},
                                     {&kSrripReplacement, true},
                                     {&kFifoReplacement, false}}) {
    INFO(policy->name);
    TagArray tags(4, 4, 1, *policy);
    (void)tags.allocate(1000);
    bool always = true;
    for (std::uint32_t line = 0; line < 100; ++line) {
      always &= tags.lookup(1000) != TagArray::kNone;
      if (always) (void)tags.allocate(line);
    }
    CHECK(always == kept);
  }
}

TEST_CASE("replacement: a stream that is read once takes no place from lines in use under SRRIP alone") {
  const auto survivors = [](const ReplacementPolicy& policy) {
    TagArray tags(8, 8, 1, policy);
    for (int time = 0; time < 3; ++time)
      for (std::uint32_t line = 0; line < 4; ++line)
        if (tags.lookup(line) == TagArray::kNone) (void)tags.allocate(line);
    for (std::uint32_t line = 100; line < 110; ++line) (void)tags.allocate(line);
    int count = 0;
    for (std::uint32_t line = 0; line < 4; ++line) count += tags.find(line) != TagArray::kNone;
    return count;
  };
  CHECK(survivors(kSrripReplacement) == 4);
  CHECK(survivors(kLruReplacement) == 0);
  CHECK(survivors(kFifoReplacement) == 0);
}

TEST_CASE("replacement: a tree of four ways gives up what its three bits say") {
  const auto tree = kTreeReplacement.make(1, 4);
  for (const std::uint32_t way : {0u, 1u, 2u, 3u}) tree->placed(way);
  CHECK(tree->victim(0, 0xf) == 0);  // both halves point to the older way, the root to the older half
  tree->used(0);
  CHECK(tree->victim(0, 0xf) == 2);
  tree->used(2);
  CHECK(tree->victim(0, 0xf) == 1);
  CHECK(tree->victim(0, 0xc) == 3);  // the other half alone is open
  tree->forget();
  CHECK(tree->victim(0, 0xf) == 0);
}
