/// Runs independent tasks on a few threads. Internal to the reference.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace quadrille::models::reference {

/// Calls `make_worker()` once a thread, and the function it returns with every number of 0 .. tasks - 1, each
/// once, in no fixed order. Tasks must not share what they write. If tasks throw, the exception of the
/// lowest-numbered one is rethrown.
template <class MakeWorker>
void run_tasks(std::size_t tasks, int threads, const MakeWorker& make_worker) {
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> failures(tasks);
  const auto run = [&] {
    auto worker = make_worker();
    for (std::size_t task = next++; task < tasks; task = next++) {
      try {
        worker(task);
      } catch (...) { failures[task] = std::current_exception(); }
    }
  };
  std::vector<std::jthread> helpers;
  const std::size_t wanted = std::min(tasks, static_cast<std::size_t>(std::max(threads, 1)));
  for (std::size_t i = 1; i < wanted; ++i) helpers.emplace_back(run);
  run();
  helpers.clear();  // joins
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace quadrille::models::reference
