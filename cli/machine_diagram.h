/// The block diagram of a machine as a page of documentation, from the machine plan.
#pragma once

#include <string>

#include "pipeline/machine/machine_config.h"

namespace quadrille::cli {

/// Markdown: a Mermaid graph of the kinds of units and the links between them, and tables of both with the
/// values that this machine gives them.
[[nodiscard]] std::string machine_diagram(const pipeline::MachineConfig& machine);

}  // namespace quadrille::cli
