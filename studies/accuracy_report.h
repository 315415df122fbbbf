/// The measured accuracy as tables for people and as JSON for programs. docs/accuracy.md explains both.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "studies/accuracy.h"

namespace quadrille::studies {

inline constexpr std::string_view kAccuracySchema = "quadrille-accuracy-1";

/// The tables of one scene, lines of at most about 160 columns.
[[nodiscard]] std::string accuracy_table(const SceneAccuracy& scene, const pipeline::MachineConfig& machine);
/// All scenes, schema `kAccuracySchema`. What is infinite or does not exist is null.
[[nodiscard]] std::string accuracy_json(std::span<const SceneAccuracy> scenes,
                                        const pipeline::MachineConfig& machine);

/// gnuplot's commands for a picture of error in frame cycles against run time, a line a scene (`draw_plot`).
[[nodiscard]] std::string accuracy_plot(std::span<const SceneAccuracy> scenes);
/// The same for the error of the picture against the bits of each precision; scenes that varied none are left
/// out of it.
[[nodiscard]] std::string precision_plot(std::span<const SceneAccuracy> scenes);

}  // namespace quadrille::studies
