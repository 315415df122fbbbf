#include "models/cache/tag_array.h"

#include "tests/models/aborts.h"
#include "tests/models/random_source.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <list>
#include <map>
#include <set>

using namespace quadrille::models;

namespace {

/// The same cache as a list a set, most recently used first.
struct NaiveLine {
  std::uint32_t line;
  SectorMask valid = 0, dirty = 0, pending = 0;
};

}  // namespace

TEST_CASE("tag_array: behaves like lists in order of use") {
  RandomSource random(91);
  for (const auto& [lines, ways] :
       {std::pair{16u, 1u}, {48u, 4u}, {24u, 8u}, {60u, 12u}, {64u, 16u}, {7u, 7u}}) {
    TagArray tags(lines, ways);
    CHECK(tags.sets() == lines / ways);
    std::map<std::uint32_t, std::list<NaiveLine>> sets;
    const auto set_of = [over = Interleave(lines / ways)](std::uint32_t line) {
      return over.member_of(line);
    };
    int hits = 0, evictions = 0, refused = 0;
    for (int step = 0; step < 20000; ++step) {
      const auto line = static_cast<std::uint32_t>(random.integer(0, static_cast<int>(lines * 2)));
      std::list<NaiveLine>& set = sets[set_of(line)];
      auto held = std::ranges::find(set, line, &NaiveLine::line);
      const int slot = tags.lookup(line);
      REQUIRE((slot != TagArray::kNone) == (held != set.end()));
      const auto sectors = static_cast<SectorMask>(random.integer(1, 15));
      if (held != set.end()) {
        ++hits;
        set.splice(set.begin(), set, held);
        const TagArray::Line& state = tags.at(slot);
        REQUIRE((state.line == line && state.valid == held->valid && state.dirty == held->dirty &&
                 state.pending == held->pending));
        const int action = random.integer(0, 3);
        if (action == 0) {
          tags.mark_dirty(slot, sectors);
          held->valid |= sectors;
          held->dirty |= sectors;
        } else if (action == 1) {
          tags.fill(slot, held->pending);
          held->valid |= held->pending;
          held->pending = 0;
        } else if (action == 2) {
          tags.clean(slot);
          held->dirty = 0;
        }
        continue;
      }
      const TagArray::Allocation got = tags.allocate(line);
      auto victim = set.end();
      for (auto it = set.begin(); it != set.end(); ++it) {
        if (it->pending == 0) victim = it;
      }
      if (set.size() == ways && victim == set.end()) {
        REQUIRE(got.slot == TagArray::kNone);
        ++refused;
        set.back().pending = 0;  // lets it go on
        tags.fill(tags.find(set.back().line), tags.at(tags.find(set.back().line)).pending);
        set.back().valid = tags.at(tags.find(set.back().line)).valid;
        continue;
      }
      REQUIRE(got.slot != TagArray::kNone);
      REQUIRE(got.victim.valid == (set.size() == ways));
      if (set.size() == ways) {
        ++evictions;
        REQUIRE((got.victim.line == victim->line && got.victim.dirty == victim->dirty));
        set.erase(victim);
      }
      set.push_front({line, 0, 0, sectors});
      tags.mark_pending(got.slot, sectors);
    }
    CHECK(hits > 1000);
    CHECK(evictions > 100);
    if (lines > 7) CHECK(refused > 0);
    std::uint32_t dirty = 0;
    for (const auto& [number, set] : sets)
      dirty += static_cast<std::uint32_t>(
          std::ranges::count_if(set, [](const NaiveLine& l) { return l.dirty != 0; }));
    CHECK(tags.dirty_count() == dirty);
  }
}

TEST_CASE("tag_array: invalidating forgets all and refuses to lose dirty data") {
  TagArray tags(64, 4);
  const int slot = tags.allocate(77).slot;
  tags.mark_dirty(slot, 3);
  CHECK(aborts([&] { tags.invalidate_all(); }));
  tags.clean(slot);
  tags.invalidate_all();
  CHECK(tags.find(77) == TagArray::kNone);
  const TagArray::Allocation again = tags.allocate(77);
  CHECK_FALSE(again.victim.valid);
  CHECK(tags.at(again.slot).valid == 0);
  CHECK(aborts([&] { (void)tags.allocate(77); }));
  CHECK(aborts([&] { tags.fill(again.slot, 1); }));  // was not pending
  CHECK(aborts([] { TagArray bad(10, 4); }));
}

namespace {

/// Share of `sets` that as many lines of a stride reach, by an index of a line.
template <class Index>
double reached(std::uint32_t sets, std::uint32_t first, std::uint32_t stride, Index&& index) {
  std::set<std::uint32_t> used;
  for (std::uint32_t i = 0; i < sets; ++i) used.insert(index(first + i * stride));
  return static_cast<double>(used.size()) / sets;
}

/// Least share over strides of 1 to 4096 lines.
template <class Index>
double least_reached(std::uint32_t sets, Index&& index) {
  double least = 1;
  for (std::uint32_t stride = 1; stride <= 4096; ++stride)
    least = std::min(least, reached(sets, 1000, stride, index));
  return least;
}

}  // namespace

TEST_CASE("tag_array: no stride crowds into few sets, as it does by the remainder or by Fibonacci hashing") {
  for (const std::uint32_t sets : {64u, 100u, 256u, 1000u}) {
    const Interleave over(sets);
    INFO(sets << " sets");
    CHECK(least_reached(sets, [&](std::uint32_t line) { return over.member_of(line); }) >= 0.40);
    CHECK(least_reached(sets, [&](std::uint32_t line) { return line % sets; }) <= 0.02);
    CHECK(least_reached(sets, [&](std::uint32_t line) {
            return static_cast<std::uint32_t>((std::uint64_t{line * 2654435769u} * sets) >> 32);
          }) <= 0.04);
  }
}

TEST_CASE("tag_array: strides of powers of two reach half of the sets and more") {
  for (const std::uint32_t sets : {16u, 64u, 100u, 256u, 1000u}) {
    const Interleave over(sets);
    for (std::uint32_t stride = 1; stride <= 65536; stride *= 2) {
      INFO(sets << " sets, stride " << stride);
      CHECK(reached(sets, 0, stride, [&](std::uint32_t line) { return over.member_of(line); }) >= 0.5);
    }
  }
}

TEST_CASE("tag_array: a stream of lines evicts in the order in which it came, but for one turn a block") {
  for (const auto& [lines, ways] : {std::pair{1024u, 4u}, {300u, 3u}, {4096u, 16u}}) {
    TagArray tags(lines, ways);
    std::uint32_t last = 0, victims = 0, jumps = 0;
    for (std::uint32_t line = 0; line < 8 * lines; ++line) {
      const TagArray::Allocation got = tags.allocate(line);
      if (!got.victim.valid) continue;
      if (victims++ > 0 && got.victim.line != last + 1) ++jumps;
      last = got.victim.line;
    }
    CHECK(victims == 7 * lines);
    // A block of a line a set starts and wraps at another place than the block that it throws out.
    CHECK(jumps <= 3 * victims / (lines / ways));
  }
}

TEST_CASE("tag_array: a slice's cache uses all sets, however many slices there are") {
  for (const std::uint32_t slices : {1u, 2u, 3u, 16u, 64u}) {
    const Interleave over_slices(slices);
    for (std::uint32_t slice = 0; slice < slices; slice += 5) {
      TagArray tags(64 * 4, 4, slices);
      for (std::uint32_t index = 640; index < 640 + 256; ++index) {
        INFO(slices << " slices, line " << index << " of slice " << slice);
        // four aligned blocks fill every set
        CHECK_FALSE(tags.allocate(over_slices.line_of(slice, index)).victim.valid);
      }
    }
  }
}
