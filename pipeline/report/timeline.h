/// A frame over time: how much of each resource of each unit was used in each slice of it, what moved
/// (flow.h), and when each draw was in flight. As a trace for Perfetto, in either format that it reads.
///
/// Units note what their resources had come to at the end of each slice (hw/base/resource.h). So a timeline
/// of use costs the simulation nothing that it does not do anyway, and its slices add up to the figures.
#pragma once

#include "pipeline/report/report.h"

#include <string>
#include <string_view>
#include <vector>

namespace quadrille::pipeline {

/// What a unit took of a resource, slice by slice.
struct ResourceCurve {
  std::string_view resource;
  hw::Resource::Kind kind = hw::Resource::Kind::kRate;
  /// by slice: part of its time, 0..1, that the work takes at the peak rate, was lost, or saw all places
  /// taken
  std::vector<double> share;
};
struct UnitCurves {
  std::string_view unit;
  std::vector<ResourceCurve> resources;
};
/// A draw from its issue to its retirement, in cycles of the GPU clock.
struct DrawSpan {
  std::size_t draw = 0;  ///< in API order
  std::int64_t begin = 0, end = 0;
};
/// A rate of bytes of a client, or how many tokens a link of a class held in the mean.
struct FlowCurve {
  std::string name;
  std::vector<double> value;  ///< by slice
};
struct FlowCurves {
  std::string_view what, unit;  ///< "L2 cache", "B/cycle"
  std::vector<FlowCurve> curves;
};
struct Timeline {
  double slice_cycles = 0;  ///< of the GPU clock; the last slice ends with the frame
  std::int64_t cycles = 0;
  std::size_t slices = 0;
  std::vector<UnitCurves> units;
  std::vector<FlowCurves> flow;  ///< what was not 0 throughout; nothing unless it was kept
  /// draws in flight at the same time lie in different rows; none unless the detail of draws was kept
  std::vector<std::vector<DrawSpan>> draw_rows;
  [[nodiscard]] double begin_of(std::size_t slice) const { return static_cast<double>(slice) * slice_cycles; }
  [[nodiscard]] double length_of(std::size_t slice) const;
};
/// Refers to the figures.
[[nodiscard]] Timeline timeline_of(const Figures& figures);

/// Perfetto's TrackEvent protobuf (perfetto.proto): a track for each unit with a counter for each resource in
/// percent, tracks for the bytes of each client and the tokens of each class of links, and draws as slices
/// with their counts. Its nanoseconds are cycles of the GPU clock.
[[nodiscard]] std::string timeline_protobuf(const ReportSubject& subject);
/// The same as the JSON of Chrome's trace viewer, which Perfetto reads too; larger. Its microseconds are
/// thousands of cycles.
[[nodiscard]] std::string timeline_trace_json(const ReportSubject& subject);

}  // namespace quadrille::pipeline
