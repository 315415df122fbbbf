/// A point: what its process does, and what that hands back.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "pipeline/prepared_frame.h"
#include "studies/explore/results.h"

namespace quadrille::studies::explore {

/// What the process of a point found.
struct PointOutput {
  std::string figures;         ///< lines, as `PointRow::figures`
  std::string picture;         ///< hash of the pixels
  std::vector<std::byte> png;  ///< empty where the picture is known
  double simulate_s = 0;
};

/// The numbers of a document of figures (docs/figures.md), by path: "units.l2_0.counters.read_misses".
/// Definitions, parameters, checks and lists are left out.
[[nodiscard]] std::string figure_lines(std::string_view figures_json);

/// Draws the frame, on `prepared` unless that is null, and checks the laws. Once a process.
/// `picture_known` says whether the picture of a hash need not be sent. Throws as `render_exact`, and
/// `std::logic_error` when the figures contradict each other.
[[nodiscard]] PointOutput draw_point(const traces::CommandStream& stream,
                                     const pipeline::MachineConfig& machine, std::int64_t window,
                                     pipeline::PreparedFrame* prepared,
                                     const std::function<bool(const std::string&)>& picture_known);

/// To bytes and back, for the way from one process to another.
[[nodiscard]] std::string encode(const PointOutput& output);
/// Throws `std::runtime_error` for bytes that `encode` did not write.
[[nodiscard]] PointOutput decode_output(std::string_view bytes);

}  // namespace quadrille::studies::explore
