/// `quadrille scenes` and `quadrille machines`: what comes with the program.
#include <fmt/format.h>

#include "cli/command.h"
#include "pipeline/machine_config.h"
#include "scenes/scene.h"

namespace quadrille::cli {
namespace {

int list_scenes() {
  for (const scenes::BuiltinScene& scene : scenes::builtin_scenes()) fmt::print("builtin:{:<10} {}\n", scene.name, scene.description);
  return kDone;
}

/// The size of a machine in one line.
int list_machines() {
  for (const std::string& name : pipeline::machine_names()) {
    pipeline::MachineConfig config;
    pipeline::load_machine(config, name);
    const pipeline::GpuParams& gpu = config.gpu;
    fmt::print("{:<10} cores {} (of {} SIMDs x {} lanes), partitions {}, memory channels {}, {:g} MHz, memory {:g} MHz\n", name,
               gpu.cores.value(), config.core.simds.value(), config.core.simd_lanes.value(), gpu.partitions.value(), gpu.channels.value(),
               gpu.clock_mhz.value(), gpu.memory_mhz.value());
  }
  return kDone;
}

}  // namespace

void add_lists(CLI::App& app, Command& chosen) {
  app.add_subcommand("scenes", "Lists the built-in scenes.")->callback([&chosen] { chosen = list_scenes; });
  app.add_subcommand("machines", "Lists the machines that come with the program.")->callback([&chosen] { chosen = list_machines; });
}

}  // namespace quadrille::cli
