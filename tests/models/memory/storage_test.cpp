/// Memory that programs write: the last store in API order stays, atomic operations add up, races are named.
#include "models/memory/storage.h"
#include "models/base/error.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <random>
#include <vector>

using namespace quadrille;
using namespace quadrille::models;

namespace {

struct Buffer {
  Buffer() {
    view.address = memory.allocate(64) + 16;
    view.bytes = 32;
    view.buffer = storage.watch("scores", view.address - 16, 64);
  }
  [[nodiscard]] std::uint32_t word(std::uint32_t offset) const {
    return memory.load<std::uint32_t>(view.address + offset);
  }
  DeviceMemory memory;
  StorageMemory storage{memory};
  StorageView view;
};

StorageMemory::Access fragment(std::uint32_t primitive, std::uint16_t x, std::uint32_t pass = 0) {
  return {invocation_of_fragment(3, 0, primitive, x, 5), pass};
}

template <class Act>
std::string error_of(const Act& act) {
  try {
    act();
    return "";
  } catch (const UserError& error) { return error.what(); }
}

}  // namespace

TEST_CASE("storage: invocations are ordered by draw, stage, instance, primitive and place") {
  const std::vector<Invocation> in_order{
      invocation_of_vertex(1, 0, 9),         invocation_of_vertex(1, 4, 0),
      invocation_of_fragment(1, 0, 0, 0, 0), invocation_of_fragment(1, 0, 0, 7, 0),
      invocation_of_fragment(1, 0, 0, 0, 1), invocation_of_fragment(1, 0, 2, 0, 0),
      invocation_of_fragment(1, 1, 0, 0, 0), invocation_of_vertex(2, 0, 0),
  };
  CHECK(std::ranges::is_sorted(in_order));
  CHECK(std::ranges::adjacent_find(in_order) == in_order.end());
}

TEST_CASE("storage: of several stores to a word the last in API order stays, whichever comes last in time") {
  std::vector<std::uint32_t> order{0, 1, 2, 3, 4, 5, 6, 7};
  std::mt19937 random(1);
  for (int turn = 0; turn < 20; ++turn) {
    Buffer b;
    std::ranges::shuffle(order, random);
    for (const std::uint32_t primitive : order)
      b.storage.store(b.view, 8, 100 + primitive, fragment(primitive, 1));
    CHECK(b.word(8) == 107);
  }
}

TEST_CASE("storage: an invocation's own stores follow its program, and it reads what it stored") {
  Buffer b;
  b.storage.store(b.view, 4, 1, fragment(2, 1));
  CHECK(b.storage.load(b.view, 4, fragment(2, 1)) == 1);
  b.storage.store(b.view, 4, 2, fragment(2, 1));
  CHECK(b.word(4) == 2);
}

TEST_CASE("storage: atomic operations of any order add up, and return what the word was") {
  Buffer b;
  const auto update = [&](AtomicOp op, std::uint32_t value, std::uint32_t compare = 0) {
    return b.storage.update(b.view, 0, {.op = op, .value = value, .comparator = compare}, fragment(0, 0));
  };
  CHECK(update(AtomicOp::kAdd, 5) == 0);
  CHECK(update(AtomicOp::kAdd, ~0u) == 5);
  CHECK(update(AtomicOp::kUMax, 9) == 4);
  CHECK(update(AtomicOp::kUMin, 7) == 9);
  CHECK(update(AtomicOp::kIMin, ~0u) == 7);
  CHECK(update(AtomicOp::kIMax, 12) == ~0u);
  CHECK(update(AtomicOp::kAnd, 10) == 12);
  CHECK(update(AtomicOp::kOr, 1) == 8);
  CHECK(update(AtomicOp::kXor, 3) == 9);
  CHECK(update(AtomicOp::kExchange, 20) == 10);
  CHECK(update(AtomicOp::kCompareExchange, 30, 21) == 20);
  CHECK(update(AtomicOp::kCompareExchange, 40, 20) == 20);
  CHECK(b.word(0) == 40);
}

TEST_CASE("storage: a vertex that is run again updates once and gets the same answers") {
  Buffer b;
  const StorageMemory::Access vertex{invocation_of_vertex(0, 0, 17), 0},
      other{invocation_of_vertex(0, 0, 18), 0};
  const auto add = [&](const StorageMemory::Access& who, std::uint32_t ordinal) {
    return b.storage.update(b.view, 0, {.value = 1, .ordinal = ordinal, .may_repeat = true}, who);
  };
  CHECK(add(vertex, 0) == 0);
  CHECK(add(other, 0) == 1);
  CHECK(add(vertex, 1) == 2);
  CHECK(add(vertex, 0) == 0);
  CHECK(add(vertex, 1) == 2);
  CHECK(b.word(0) == 3);
}

TEST_CASE("storage: a race is an error that names buffer and byte, in either order of the two") {
  using Act = void (*)(Buffer&, std::uint32_t primitive);
  const Act load = [](Buffer& b, std::uint32_t p) { (void)b.storage.load(b.view, 12, fragment(p, 0)); };
  const Act store = [](Buffer& b, std::uint32_t p) { b.storage.store(b.view, 12, 1, fragment(p, 0)); };
  const Act update = [](Buffer& b, std::uint32_t p) {
    (void)b.storage.update(b.view, 12, {.value = 1}, fragment(p, 0));
  };
  for (const std::pair<Act, Act>& acts :
       {std::pair{load, store}, std::pair{load, update}, std::pair{store, update}}) {
    for (const bool swapped : {false, true}) {
      const Act first = swapped ? acts.second : acts.first, second = swapped ? acts.first : acts.second;
      Buffer b;
      first(b, 1);
      CHECK_THAT(error_of([&] { second(b, 2); }), Catch::Contains("buffer 'scores', byte 28"));
      Buffer same;
      first(same, 1);
      CHECK(error_of([&] { second(same, 1); }).empty());
    }
  }
}

TEST_CASE("storage: what one pass wrote the next may read and write") {
  Buffer b;
  b.storage.store(b.view, 0, 8, fragment(1, 1, 0));
  CHECK(b.storage.load(b.view, 0, fragment(0, 2, 1)) == 8);
  CHECK(b.storage.load(b.view, 0, fragment(0, 3, 1)) == 8);
  CHECK(b.storage.update(b.view, 0, {.value = 2}, fragment(0, 2, 2)) == 8);
  b.storage.store(b.view, 0, 1, fragment(0, 0, 3));  // earlier in its pass than the store of pass 0 was
  CHECK(b.word(0) == 1);
}

TEST_CASE("storage: outside of its view nothing is read or written") {
  Buffer b;
  for (const std::uint32_t offset : {29u, 32u, 36u, 0x80000000u, 0xfffffffcu}) {
    b.storage.store(b.view, offset, 7, fragment(0, 0));
    CHECK(b.storage.load(b.view, offset, fragment(0, 0)) == 0);
    CHECK(b.storage.update(b.view, offset, {.value = 7}, fragment(0, 0)) == 0);
  }
  b.storage.store(b.view, 28, 7, fragment(0, 0));
  CHECK(b.word(28) == 7);
  CHECK(b.memory.load<std::uint32_t>(b.view.address - 16) == 0);
}
