/// Pictures of measurements, drawn by gnuplot: a study writes its commands, this runs the program and puts
/// the file in place.
#pragma once

#include <string>

namespace quadrille::studies {

/// Throws `UserError` when gnuplot cannot be run. Call it before anything that takes long. `flag` leads the
/// message.
void require_gnuplot(const std::string& flag);

/// Runs gnuplot with these commands; it draws into `path` (.svg or .png), which appears whole or not at all.
/// Throws `UserError`.
void draw_plot(const std::string& path, const std::string& commands);

/// Text between double quotes for gnuplot: nothing in it is read as a command or as markup.
[[nodiscard]] std::string quoted(const std::string& text);

}  // namespace quadrille::studies
