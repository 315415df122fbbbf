/// The arguments that say which machine draws.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <string_view>
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

/// Throws `UserError` naming `flag` unless units of that kind exist ("texture").
void check_unit_kind(std::string_view flag, std::string_view kind);

}  // namespace quadrille::cli
