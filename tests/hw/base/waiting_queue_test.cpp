/// Entries that wait for answers keep their numbers while others leave.
#include "hw/base/waiting_queue.h"

#include <catch2/catch.hpp>

using namespace quadrille::hw;

namespace {

struct Entry {
  int missing = 0;
  Tick ready = 0;
};

}  // namespace

TEST_CASE("waiting queue: answers reach their entries after others have left") {
  WaitingQueue<Entry> queue;
  queue.push_back({0, 0});
  queue.push_back({2, 5});
  const std::uint32_t number = queue.newest();
  queue.push_back({1, 7});
  queue.pop_front();
  CHECK(queue.number(0) == number);
  queue.answer(number, 9);
  queue.answer(queue.newest(), 3);
  CHECK(queue[0].missing == 1);
  CHECK(queue[0].ready == 9);
  CHECK(queue[1].missing == 0);
  CHECK(queue[1].ready == 7);
}

TEST_CASE("waiting queue: numbers never have the caller's bit, and go round") {
  WaitingQueue<Entry> queue;
  queue.push_back({1, 0});
  CHECK(queue.number(0x80000005u) == 5);
  CHECK(queue.number(0x7fffffffu) == 0x7fffffffu);
}
