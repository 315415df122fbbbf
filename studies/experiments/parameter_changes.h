/// What the sweep over all parameters changes: which values each gets, on which machines.
#pragma once

#include <string>
#include <vector>

#include "hw/base/param.h"

namespace quadrille::studies::experiments {

/// One parameter with another value, on a machine that is otherwise its ground.
struct Change {
  std::string path, value;
  std::string ground;                 ///< its name
  std::vector<std::string> settings;  ///< that make the ground from the default machine, KEY=VALUE
  hw::Effect effect = hw::Effect::kFaster;
  bool more = false;  ///< of a number; of a switch, on
};

/// Half and twice of each number, and every other word, on the default machine and, but for links, on some
/// that are narrow elsewhere. Changes that give no legal machine are left out, and what changes the picture.
[[nodiscard]] std::vector<Change> near_changes();

/// For parameters that showed nothing so: an eighth and eight times of it there, and all of these on a
/// machine on which it must show (a link of one place, a policy that asks for it, units that wait for nothing
/// else).
[[nodiscard]] std::vector<Change> far_changes(const std::vector<std::string>& paths);

}  // namespace quadrille::studies::experiments
