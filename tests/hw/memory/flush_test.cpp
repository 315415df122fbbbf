/// The flush: writes, fences behind them, and the end when every slice has answered.
#include "hw/memory/flush.h"
#include "tests/hw/bench_stub.h"

#include <catch2/catch.hpp>

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

/// Writes lines at cycle 0, flushes, and notes the cycle in which the flush is done.
class Flusher final : public StubUnit {
 public:
  Flusher(sc_core::sc_module_name name, const Clock& clock, int writes, bool fences)
      : StubUnit(name, Kind::kChooser, clock), port(*this, stats_, 2), writes_(writes), fences_(fences) {}
  Wake next() const override {
    Wake wake = begun_ ? port.receive_wake() : Wake(0);
    if (!port.queue_empty()) wake = Wake::sooner(wake, port.send_wake());
    return wake;
  }
  void act(Tick now) override {
    port.receive(now, [&](const MemoryResponse& answer) {
      if (!flush_.take(answer)) ++others;
    });
    if (!begun_) {
      begun_ = true;
      port.read(0, 0x1, 7);
      for (int line = 0; line < writes_; ++line) port.write(static_cast<std::uint32_t>(line), 0xf);
      flush_.begin();
    }
    port.send(now);
    if (flush_.advance(fences_)) fenced_at = now / kCycle;
    if (flush_.done()) {
      done_at = now / kCycle;
      flush_.end();
    }
  }
  bool finished() const override { return !flush_.running() && port.queue_empty(); }
  const StatGroup* stats() const override { return &stats_; }

 private:
  StatGroup stats_;

 public:
  MemoryPort port;
  int others = 0;  ///< answers that are none of a fence
  std::int64_t fenced_at = -1, done_at = -1;

 private:
  int writes_;
  bool fences_, begun_ = false;
  Flush flush_{port};
};

struct FlushBench final : Bench {
  struct Setup {
    int writes = 4;
    int near = 10, far = 30;  ///< latencies of the two slices
    bool fences = true;
  };
  FlushBench(Driver& driver, const contract::Variation& v, const Setup& s) : Bench(driver, v) {
    unit = std::make_unique<Flusher>("unit", clock, s.writes, s.fences);
    add(*unit);
    for (int i = 0; i < 2; ++i) {
      const auto slice = static_cast<std::size_t>(i);
      memory[slice] =
          &serve(*unit->port.request_out[slice], unit->port.response_in[slice], i == 0 ? s.near : s.far);
    }
  }
  std::unique_ptr<Flusher> unit;
  std::array<StubMemory*, 2> memory{};
};

std::string seen(const FlushBench::Setup& setup) {
  return run<FlushBench>(setup, [](const FlushBench& b) {
    std::string text;
    for (const StubMemory* slice : b.memory) {
      for (const auto& [cycle, r] : slice->got) text += letter_of(r.kind);
      text += ' ';
    }
    return fmt::format("{}| fenced {} done {} others {}", text, b.unit->fenced_at, b.unit->done_at,
                       b.unit->others);
  });
}

}  // namespace

TEST_CASE("flush: a fence follows the writes to every slice, and the slowest answer ends it") {
  // A slice takes one request a cycle from cycle 1 on: the fence of the first is its fourth, that of the
  // other its third. An answer is seen a cycle after its latency.
  CHECK(seen({.near = 10, .far = 30}) == "rwwf wwf | fenced 0 done 34 others 1");
  CHECK(seen({.near = 30, .far = 10}) == "rwwf wwf | fenced 0 done 35 others 1");
}

TEST_CASE("flush: without fences it is done as soon as the queue is empty") {
  CHECK(seen({.fences = false}) == "rww ww | fenced 0 done 0 others 1");
}
