/// The queue inside units, held to std::deque.
#include "hw/base/queue.h"

#include <catch2/catch.hpp>

#include <deque>
#include <random>

using quadrille::hw::Queue;

TEST_CASE("queue: holds what std::deque holds, whatever is pushed and popped") {
  std::mt19937 random(7);
  for (int round = 0; round < 20; ++round) {
    Queue<int> queue;
    std::deque<int> held;
    for (int i = 0; i < 500; ++i) {
      if (random() % 100 < 40u + 3u * static_cast<unsigned>(round % 10)) {
        queue.push_back(i);
        held.push_back(i);
      } else if (!held.empty()) {
        queue.pop_front();
        held.pop_front();
      }
      REQUIRE(queue.size() == held.size());
      REQUIRE(queue.empty() == held.empty());
      if (held.empty()) continue;
      REQUIRE(queue.front() == held.front());
      REQUIRE(queue.back() == held.back());
      const std::size_t at = random() % held.size();
      queue[at] = held[at] = -i;
      for (std::size_t k = 0; k < held.size(); ++k) REQUIRE(queue[k] == held[k]);
    }
  }
}

TEST_CASE("queue: an entry of its own may be pushed again while it grows") {
  Queue<int> queue;
  queue.push_back(1);
  for (int i = 0; i < 40; ++i) queue.push_back(queue.front());
  for (std::size_t k = 0; k < queue.size(); ++k) REQUIRE(queue[k] == 1);
}
