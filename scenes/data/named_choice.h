/// Choosing one of a list of named things by number or name, as `--scene`, `--camera` and `--animation` do.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace quadrille::scenes {

/// The entry that `choice` means: a whole number counts from 0, anything else is a name, of which the first
/// counts. None: there is no such entry.
[[nodiscard]] std::optional<std::size_t> find_choice(const std::vector<std::string>& names,
                                                     const std::string& choice);

/// "0 'walk', 1 'run', 2" for an error; long lists are cut.
[[nodiscard]] std::string list_of_choices(const std::vector<std::string>& names);

}  // namespace quadrille::scenes
