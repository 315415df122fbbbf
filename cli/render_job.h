/// A frame to render: what `render` and `trace replay` do with their arguments.
#pragma once

#include <optional>
#include <string>

#include "cli/machine_arguments.h"
#include "cli/scene_arguments.h"

namespace quadrille::cli {

struct RenderJob {
  SceneArguments scene;
  MachineArguments machine;
  std::optional<std::string> out, depth, stats, max_cycles, window;
  std::string fidelity = "exact", leave_out = "auto", driver = "dispatcher", units = "folded";
  bool alpha = false, quiet = false;

  /// Adds every option but those of the scene.
  void add_to(CLI::App& command);
  /// Checks all arguments, loads, renders, writes the files and prints the table. Returns the exit code; throws `UserError`.
  int run();

 private:
  void check_outputs() const;
  /// The window in cycles; 0 for an exact run. Throws `UserError` when it does not go with the other arguments.
  [[nodiscard]] std::int64_t window_cycles() const;
};

}  // namespace quadrille::cli
