/// The experiments that run on any Vulkan device and on the simulated machine: meshes, and what changes from
/// point to point.
///
/// Each is a curve. Devices differ in clock and width, so curves are compared as shapes, each divided by its
/// own first point: the first point is the one that every device should be best at.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "studies/experiments/triangle_mesh.h"
#include "traces/command_stream.h"

namespace quadrille::lavapipe {

struct Point {
  std::string name;
  double x = 0;  ///< along the axis of the experiment
  /// of an experiment; made when it is its turn: all at once would not fit
  std::function<studies::experiments::TriangleMesh()> mesh{};
  std::function<traces::CommandStream()> stream{};  ///< that draws it, or a scene
};

struct MeasuredExperiment {
  std::string name, axis;
  std::vector<Point> points;
};

/// All experiments for a target of this size, in pixels.
[[nodiscard]] std::vector<MeasuredExperiment> measured_experiments(std::uint32_t width, std::uint32_t height);
/// Those named, in the order of all; no name: all. Throws `UserError` for a name that there is not.
[[nodiscard]] std::vector<MeasuredExperiment> chosen_experiments(const std::vector<std::string>& names,
                                                                 std::uint32_t width, std::uint32_t height);
/// The experiments named, or, where scenes are given instead (builtin:NAME, glTF files, or traces, which have
/// a size of their own), one of them: a point each, loaded when it is its turn. Throws `UserError` also for
/// both.
[[nodiscard]] std::vector<MeasuredExperiment> chosen_points(const std::vector<std::string>& names,
                                                            const std::vector<std::string>& scenes,
                                                            std::uint32_t width, std::uint32_t height);
/// Of a file about a point, without ending: "setup-rate_off_screen".
[[nodiscard]] std::string file_name(const MeasuredExperiment& experiment, const Point& point);
/// The experiments and their points, a line each.
[[nodiscard]] std::string listed(const std::vector<MeasuredExperiment>& experiments);

}  // namespace quadrille::lavapipe
