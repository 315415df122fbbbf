/// How slow this computer is now, so that a bound of processor time means the same on a slow or busy one.
///
/// Processor time leaves out what other programs take, but not that they share caches, memory and the two
/// halves of a core, nor that a computer is simply slower. A fixed piece of work of the kind that reading
/// hostile files is (many small allocations, fresh pages, looking things up) is timed beside what is bounded.
#pragma once

#include <sys/resource.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace quadrille::tests {

/// Seconds of processor time that this process has taken, in the system too.
inline double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Does the work once; what it returns depends on all of it.
inline std::uint64_t fixed_work() {
  constexpr std::uint64_t kObjects = 400'000, kPages = 32'768, kPageBytes = 4096;
  std::unordered_map<std::string, std::unique_ptr<std::uint64_t>> objects;
  for (std::uint64_t i = 0; i < kObjects; ++i)
    objects.emplace("node number " + std::to_string(i * 2654435761U % 1000003U),
                    std::make_unique<std::uint64_t>(i));
  std::uint64_t sum = 0;
  for (std::uint64_t i = 0; i < kObjects; ++i) {
    const auto found = objects.find("node number " + std::to_string(i));
    if (found != objects.end()) sum += *found->second;
  }
  auto* const pages = static_cast<volatile unsigned char*>(std::malloc(kPages * kPageBytes));
  for (std::uint64_t i = 0; pages != nullptr && i < kPages; ++i)
    pages[i * kPageBytes] = static_cast<unsigned char>(i);
  for (std::uint64_t i = 0; pages != nullptr && i < kPages; ++i) sum += pages[i * kPageBytes];
  std::free(const_cast<unsigned char*>(pages));
  return sum;
}

/// Processor time of the work here, over what it is on the computer that the bounds of tests were set on; at
/// least 1.
inline double host_slowness() {
  constexpr double kSecondsThere = 0.60;
  static volatile std::uint64_t sink = 0;
  double most = 0;
  for (int i = 0; i < 3; ++i) {
    const double start = processor_seconds();
    sink = sink + fixed_work();
    most = std::max(most, processor_seconds() - start);
  }
  return std::max(1.0, most / kSecondsThere);
}

}  // namespace quadrille::tests
