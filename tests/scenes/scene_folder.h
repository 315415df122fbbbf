/// Where the scenes lie that this project did not write: $QUADRILLE_SCENES, or ../shared/scenes beside the
/// source tree. Tests skip without them.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace quadrille::scenes {

inline std::optional<std::filesystem::path> scene_folder() {
  const char* chosen = std::getenv("QUADRILLE_SCENES");
  const std::filesystem::path folder = chosen != nullptr ? chosen : QUADRILLE_SOURCE_DIR "/../shared/scenes";
  if (!std::filesystem::is_directory(folder)) return std::nullopt;
  return folder;
}

}  // namespace quadrille::scenes
