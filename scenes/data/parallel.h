/// Independent work on the cores of the host, for what a scene load can split (image decoding, mip chains).
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace quadrille::scenes {

/// Calls `work(i)` for i in 0..count-1, each once, in any order, on up to one thread a core. If calls throw,
/// the exception of the smallest i is rethrown.
template <class Work>
void parallel_for(std::size_t count, const Work& work) {
  std::vector<std::exception_ptr> failures(count);
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) { failures[i] = std::current_exception(); }
    }
  };
  {
    std::vector<std::jthread> threads;
    const std::size_t helpers = std::min<std::size_t>(std::max(1U, std::thread::hardware_concurrency()),
                                                      std::max<std::size_t>(count, 1)) -
                                1;
    for (std::size_t i = 0; i < helpers; ++i) threads.emplace_back(run);
    run();
  }
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace quadrille::scenes
