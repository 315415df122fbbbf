#include "models/memory/device_memory.h"

#include "models/base/error.h"
#include "tests/models/aborts.h"

#include <catch2/catch.hpp>

using namespace quadrille::models;

TEST_CASE("device_memory: objects are aligned and share no line") {
  DeviceMemory memory;
  const auto a = memory.allocate(1), b = memory.allocate(300, 16), c = memory.allocate(4, 4096);
  CHECK(a == 0);
  CHECK(b == 128);
  CHECK(c == 4096);
  CHECK(memory.size() == 4096 + 128);
  memory.store<std::uint32_t>(b + 7, 0xdeadbeef);
  CHECK(memory.load<std::uint32_t>(b + 7) == 0xdeadbeef);
  CHECK(memory.load<std::uint8_t>(b + 7) == 0xef);
  CHECK(memory.load<std::uint8_t>(b + 11) == 0);
}

TEST_CASE("device_memory: asking for more than the device has is the user's error") {
  DeviceMemory memory(1024);
  CHECK_NOTHROW(memory.allocate(900));
  CHECK_THROWS_AS(memory.allocate(200), quadrille::UserError);
  CHECK_THROWS_AS(memory.allocate(~std::uint64_t{0}), quadrille::UserError);
  CHECK_NOTHROW(memory.allocate(0));
}

TEST_CASE("device_memory: access outside of what was allocated aborts") {
  DeviceMemory memory;
  const auto a = memory.allocate(256);
  CHECK_FALSE(aborts([&] { (void)memory.read(a, 256); }));
  CHECK(aborts([&] { (void)memory.read(a + 1, 256); }));
  CHECK(aborts([&] { (void)memory.write(a, 257); }));
  CHECK(aborts([&] { (void)memory.read(~std::uint64_t{0}, 2); }));
}

TEST_CASE("device_memory: reading below a cache that holds a line dirty aborts") {
  DeviceMemory memory;
  (void)memory.allocate(1024);
  memory.mark_dirty(2, 5);
  memory.mark_dirty(2, 5);
  CHECK(memory.dirty_lines() == 1);
  CHECK(memory.dirty_owner(2) == 5);
  CHECK_FALSE(aborts([&] { memory.check_readable(0, 256, 9); }));
  CHECK_FALSE(aborts([&] { memory.check_readable(256, 128, 5); }));
  CHECK(aborts([&] { memory.check_readable(200, 57, 9); }));
  CHECK(aborts([&] { memory.check_readable(383, 1, 9); }));
  CHECK(aborts([&] { memory.mark_dirty(2, 6); }));
  memory.mark_clean(2);
  memory.mark_clean(2);
  CHECK(memory.dirty_lines() == 0);
  CHECK_FALSE(aborts([&] { memory.check_readable(0, 1024, 9); }));
}
