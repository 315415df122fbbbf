#include "cli/machine_arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "models/base/error.h"
#include "pipeline/machine/machine_plan.h"

namespace quadrille::cli {

void MachineArguments::add_to(CLI::App& command) {
  command
      .add_option("--machine", machine, "a machine by name (quadrille machines lists them) or a .toml file")
      ->type_name("NAME|FILE.toml")
      ->capture_default_str();
  command
      .add_option(
          "--set", settings,
          "sets a parameter after the machine is loaded; may be given again (quadrille describe lists all)")
      ->type_name("KEY=VALUE")
      ->expected(1)
      ->take_all();
}

void MachineArguments::apply(pipeline::MachineConfig& config) const {
  pipeline::load_machine(config, machine);
  config.begin_layer();
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos)
      throw user_error("--set: '{}' is not KEY=VALUE, as in gpu.cores=8", setting);
    config.set(setting.substr(0, equals), setting.substr(equals + 1), "--set");
  }
  config.check();
}

void check_unit_kind(std::string_view flag, std::string_view kind) {
  constexpr auto kKinds = pipeline::unit_kind_names();
  if (std::ranges::find(kKinds, kind) == kKinds.end())
    throw user_error("{}: no unit is called '{}'; there are {}", flag, kind, fmt::join(kKinds, ", "));
}

}  // namespace quadrille::cli
