/// Documents of figures (schema `kFiguresSchema`) read back, from files that others may have changed.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace quadrille::pipeline {

/// The document of a simulated frame. What a comparison asks for is there and of its kind: the frame's
/// counts, units with their cycles and counters, bytes by client, draws and squares where the file has them.
/// Throws `UserError` with the file and the place: line and column where the text is no JSON, else the key.
[[nodiscard]] nlohmann::ordered_json read_figures(const std::string& file, std::string_view text);

}  // namespace quadrille::pipeline
