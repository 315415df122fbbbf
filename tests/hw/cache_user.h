/// A unit that uses a first-level cache, or what is built on one, as its script says, and notes what it is
/// told.
#pragma once

#include "tests/hw/bench_stub.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace quadrille::hw::bench {

template <class Cache>
class CacheUser final : public StubUnit {
 public:
  using Use = std::function<void(CacheUser&)>;
  /// `arguments` are those of the cache after its counters.
  template <class... Arguments>
  CacheUser(sc_core::sc_module_name name, const Clock& clock, std::vector<Timed<Use>> script,
            Arguments&&... arguments)
      : StubUnit(name, Kind::kChooser, clock),
        cache(stats_, std::forward<Arguments>(arguments)...),
        port(*this, stats_, 1),
        script_(std::move(script)) {}
  Wake next() const override {
    Wake wake = played_ < script_.size() ? Wake(script_[played_].cycle * kCycle) : Wake(kNever);
    if (!port.queue_empty()) wake = Wake::sooner(wake, port.send_wake());
    return Wake::sooner(wake, port.receive_wake());
  }
  void act(Tick now) override {
    port.receive(now, [&](const MemoryResponse& answer) {
      cache.fill(answer, [&](std::uint32_t waiter) { log += fmt::format("ready {}; ", waiter); });
    });
    while (played_ < script_.size() && script_[played_].cycle * kCycle <= now)
      script_[played_++].token(*this);
    port.send(now);
  }
  bool finished() const override { return played_ == script_.size() && port.queue_empty(); }
  const StatGroup* stats() const override { return &stats_; }

 private:
  StatGroup stats_;

 public:
  Cache cache;
  MemoryPort port;
  std::string log;

 private:
  std::vector<Timed<Use>> script_;
  std::size_t played_ = 0;
};

/// What reached memory, as "kind line/sectors" without times, lines counted from `first`.
[[nodiscard]] inline std::string requests_seen(const StubMemory& memory, std::uint32_t first = 0) {
  std::string text;
  for (const auto& [cycle, r] : memory.got)
    text += fmt::format(" {}{}/{:x}", letter_of(r.kind), r.line - first, r.sectors);
  return text;
}

}  // namespace quadrille::hw::bench
