/// The arguments that say which machine draws.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

#include "pipeline/machine/machine_config.h"

namespace quadrille::cli {

struct MachineArguments {
  std::string machine = "default";
  std::vector<std::string> settings;  ///< KEY=VALUE, in the order given

  void add_to(CLI::App& command);
  /// Loads the machine, then applies the settings. Throws `UserError` naming the file or the setting.
  void apply(pipeline::MachineConfig& config) const;
};

}  // namespace quadrille::cli
