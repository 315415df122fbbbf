/// What `--environment` names: a file or a sky.
#pragma once

#include <memory>
#include <string>

#include "scenes/data/environment_map.h"

namespace quadrille::scenes {

/// Throws `UserError` unless `text` is the path of a .hdr or .exr file, or `sky`, `sky:ELEVATION` or
/// `sky:ELEVATION,AZIMUTH`. No file is opened.
void check_environment(const std::string& text);
/// The map, to be shown as background. Throws `UserError`, also for what the file holds.
[[nodiscard]] std::shared_ptr<const EnvironmentMap> load_environment(const std::string& text);

}  // namespace quadrille::scenes
