/// What a token-hop costs in four styles of SystemC, and why hw/base is written as it is: a thread a unit
/// with sc_fifo and wait, a method a unit, the kernel's native driver and its dispatcher. The first two run a
/// chain of 50 units (their best case: no arbiter, no feedback); the drivers run that chain and the machine
/// of 50 units with arbiters, feedback and a shared memory (world_spec.h), with links of 2 cycles forward and
/// 1 back (the least look-ahead that a real machine leaves) and of 4 cycles each way. One simulation a
/// process: each measurement runs in a forked child, which times only `run`, in processor time, and reports
/// through a pipe. Time shown is per action (one token moved by one unit).
#include "hw/base/dispatcher.h"
#include "hw/base/native_driver.h"
#include "tests/hw/base/worlds.h"

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <ctime>

namespace {

using namespace quadrille;
using namespace quadrille::hw;
using namespace quadrille::hw::world;

constexpr int kUnits = 50;
constexpr int kTokens = 20000;

using RawToken = std::uint64_t;  // as large as a synthetic Token, and printable, which sc_fifo asks for

struct Timing {
  double seconds = 0;
  double actions = 0;
};

Timing in_child(const std::function<Timing()>& body) {
  const std::string text = contract::in_child([&] {
    const Timing t = body();
    return fmt::format("{} {}", t.seconds, t.actions);
  });
  Timing t;
  if (std::sscanf(text.c_str(), "%lf %lf", &t.seconds, &t.actions) != 2) {
    std::fprintf(stderr, "%s\n", text.c_str());
    std::exit(1);
  }
  return t;
}

/// Processor time of `body`, which is what a machine shared with others lets us compare.
template <class Body>
double seconds(const Body& body) {
  const std::clock_t start = std::clock();
  body();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// SC_THREAD, sc_fifo and wait: read, wait a cycle, write.
class ThreadStage : public sc_core::sc_module {
 public:
  sc_core::sc_fifo_in<RawToken> in{"in"};
  sc_core::sc_fifo_out<RawToken> out{"out"};
  explicit ThreadStage(sc_core::sc_module_name name) : sc_core::sc_module(name) {
    sc_core::sc_spawn([this] {
      for (;;) {
        const RawToken token = in.read();
        sc_core::wait(1, sc_core::SC_NS);
        out.write(token);
      }
    });
  }
};

/// One SC_METHOD a unit: takes a token when there is one and room, and comes back a cycle later; else waits
/// for the FIFO that stopped it.
class MethodStage : public sc_core::sc_module {
 public:
  sc_core::sc_fifo_in<RawToken> in{"in"};
  sc_core::sc_fifo_out<RawToken> out{"out"};
  explicit MethodStage(sc_core::sc_module_name name) : sc_core::sc_module(name) {
    sc_core::sc_spawn_options options;
    options.spawn_method();
    sc_core::sc_spawn([this] { step(); }, "step", &options);
  }

 private:
  void step() {
    RawToken token = 0;
    if (out.num_free() == 0) return sc_core::next_trigger(out.data_read_event());
    if (!in.nb_read(token)) return sc_core::next_trigger(in.data_written_event());
    out.nb_write(token);
    sc_core::next_trigger(1, sc_core::SC_NS);
  }
};

/// A chain of `kUnits` raw stages between a source and a sink thread.
template <class Stage>
Timing raw_chain() {
  std::vector<std::unique_ptr<sc_core::sc_fifo<RawToken>>> fifos;
  for (int i = 0; i <= kUnits; ++i)
    fifos.push_back(std::make_unique<sc_core::sc_fifo<RawToken>>(fmt::format("fifo_{}", i).c_str(), 8));
  std::vector<std::unique_ptr<Stage>> stages;
  for (int i = 0; i < kUnits; ++i) {
    stages.push_back(std::make_unique<Stage>(fmt::format("stage_{}", i).c_str()));
    stages.back()->in(*fifos[static_cast<std::size_t>(i)]);
    stages.back()->out(*fifos[static_cast<std::size_t>(i) + 1]);
  }
  int received = 0;
  sc_core::sc_spawn([&] {
    for (RawToken i = 0; i < kTokens; ++i) fifos.front()->write(i);
  });
  sc_core::sc_spawn([&] {
    while (received < kTokens) {
      fifos.back()->read();
      ++received;
    }
  });
  const double time = seconds([] { sc_core::sc_start(); });
  QUADRILLE_CHECK(received == kTokens, "{} of {} tokens arrived", received, kTokens);
  return {time, static_cast<double>(kTokens) * kUnits};
}

WorldSpec chain_world() {
  WorldSpec w;
  int last = w.add({.role = Role::kSource, .count = kTokens});
  for (int i = 0; i < kUnits - 2; ++i) {
    const int stage = w.add({.role = Role::kStage});
    w.wire({last, 0}, {stage, 0}, {.depth = 8});
    last = stage;
  }
  w.wire({last, 0}, {w.add({.role = Role::kSink}), 0}, {.depth = 8});
  return w;
}

template <class DriverType>
Timing kernel_world(const WorldSpec& spec) {
  DriverType driver("driver");
  const World world(spec, driver, {}, false);
  const double time = seconds([&] { driver.run({}); });
  QUADRILLE_CHECK(tokens_in_links(driver.units()) == 0, "{}",
                  deadlock_report(driver.units(), driver.last_action()));
  return {time, static_cast<double>(driver.actions())};
}

void measure(benchmark::State& state, const std::function<Timing()>& body) {
  double best = 1e9, actions = 0;
  for (auto _ : state) {
    const Timing t = in_child(body);
    state.SetIterationTime(t.seconds);
    best = std::min(best, t.seconds / t.actions);
    actions += t.actions;
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(actions));
  state.counters["best_ns_per_action"] = best * 1e9;
}

}  // namespace

int main(int argc, char** argv) {
  setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 1);
  const WorldSpec short_links = benchmark_world(20000),
                  long_links = benchmark_world(20000, {.depth = 16, .latency = 4, .credit = 4});
  const auto add = [](const char* name, const std::function<Timing()>& body) {
    benchmark::RegisterBenchmark(name, [body](benchmark::State& state) { measure(state, body); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond)
        ->Iterations(5);
  };
  add("chain/thread_sc_fifo_wait", raw_chain<ThreadStage>);
  add("chain/method_sc_fifo", raw_chain<MethodStage>);
  add("chain/native", [] { return kernel_world<NativeDriver>(chain_world()); });
  add("chain/dispatcher", [] { return kernel_world<Dispatcher>(chain_world()); });
  add("machine/native/short_links", [&] { return kernel_world<NativeDriver>(short_links); });
  add("machine/dispatcher/short_links", [&] { return kernel_world<Dispatcher>(short_links); });
  add("machine/native/long_links", [&] { return kernel_world<NativeDriver>(long_links); });
  add("machine/dispatcher/long_links", [&] { return kernel_world<Dispatcher>(long_links); });
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
