/// What an action of a unit costs in whole machines, the narrow and the wide: builtin:cubes on the default
/// machine and with 64 of all that can be had many times (30,000 links). The small frame on the wide machine
/// is mostly its start and its end, which must stay a small multiple of the number of links. One simulation a
/// process: each measurement runs in a forked child. Times are processor time: of the simulation an action
/// (elaboration by SystemC and the closing of the accounts included), and of building, running and destroying
/// the machine together.
#include "pipeline/render.h"
#include "scenes/scene.h"
#include "studies/child_run.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

/// SystemC's library asks for this symbol.
extern "C" int sc_main(int, char**) { return 0; }

namespace {

using namespace quadrille;

struct Timing {
  double simulation_s = 0, machine_s = 0, actions = 0;
};

Timing render(const traces::CommandStream& stream, int of_everything) {
  const auto body = [&] {
    pipeline::MachineConfig config;
    for (const char* key : {"gpu.cores", "gpu.partitions", "gpu.channels"}) {
      if (of_everything > 0) config.set(key, fmt::format("{}", of_everything), "machine_bench");
    }
    const std::clock_t start = std::clock();
    const pipeline::HostFigures host = pipeline::render_exact(stream, config, {}).figures.host;
    return fmt::format("{} {} {}", host.simulate_cpu_s,
                       static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, host.actions);
  };
  const std::string text = studies::output_of(studies::run_in_child(body), "machine_bench");
  Timing t;
  if (std::sscanf(text.c_str(), "%lf %lf %lf", &t.simulation_s, &t.machine_s, &t.actions) != 3) std::abort();
  return t;
}

/// `of_everything`: cores, partitions and channels; 0 for those of the default machine.
void measure(benchmark::State& state, std::uint32_t width, std::uint32_t height, int of_everything) {
  scenes::SceneOptions options;
  options.width = width;
  options.height = height;
  const traces::CommandStream stream = scenes::load_scene("builtin:cubes", options);
  double best = 1e9, machine = 1e9, actions = 0;
  for (auto _ : state) {
    const Timing t = render(stream, of_everything);
    state.SetIterationTime(t.simulation_s);
    best = std::min(best, t.simulation_s / t.actions);
    machine = std::min(machine, t.machine_s);
    actions += t.actions;
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(actions));
  state.counters["best_ns_per_action"] = best * 1e9;
  state.counters["best_machine_ms"] = machine * 1e3;
}

}  // namespace

int main(int argc, char** argv) {
  setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 1);
  const auto add = [](const char* name, std::uint32_t width, std::uint32_t height, int of_everything) {
    benchmark::RegisterBenchmark(
        name, [=](benchmark::State& state) { measure(state, width, height, of_everything); })
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond)
        ->Iterations(5);
  };
  add("default/cubes_160x120", 160, 120, 0);
  add("default/cubes_1280x720", 1280, 720, 0);
  add("wide_64/cubes_160x120", 160, 120, 64);
  add("wide_64/cubes_1280x720", 1280, 720, 64);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
