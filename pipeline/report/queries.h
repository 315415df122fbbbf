/// What the queries of a frame have counted: sums over their draws of what units counted for each.
#pragma once

#include "hw/frame/frame.h"
#include "pipeline/driver/query_ranges.h"
#include "pipeline/report/detail.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace quadrille::pipeline {

struct QueryValue {
  std::string_view name;
  std::optional<std::uint64_t> value;  ///< none: a functional run has no stages to count in
};
struct QueryFigures {
  QueryRange range;
  std::vector<QueryValue> values;
};

/// Of a machine that has run.
[[nodiscard]] std::vector<QueryFigures> query_figures(const std::vector<QueryRange>& ranges,
                                                      const hw::Frame& frame, const Detail& detail);
/// Of a functional run, from the samples that passed by draw.
[[nodiscard]] std::vector<QueryFigures> query_figures(const std::vector<QueryRange>& ranges,
                                                      std::span<const std::uint64_t> samples_passed);

}  // namespace quadrille::pipeline
