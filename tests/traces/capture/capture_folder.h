/// Where the captures lie that this project did not make: $QUADRILLE_CAPTURES, or ../shared/captures beside
/// the source tree. Tests skip without them.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace quadrille::capture {

inline std::optional<std::filesystem::path> capture_folder() {
  const char* chosen = std::getenv("QUADRILLE_CAPTURES");
  const std::filesystem::path folder =
      chosen != nullptr ? chosen : QUADRILLE_SOURCE_DIR "/../shared/captures";
  if (!std::filesystem::is_directory(folder)) return std::nullopt;
  return folder;
}

}  // namespace quadrille::capture
