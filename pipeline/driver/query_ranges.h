/// Which draws each query of a stream counts.
#pragma once

#include "models/base/id.h"
#include "traces/queries.h"

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace quadrille::pipeline {

/// A query that was begun, with its draws, which follow each other.
struct QueryRange {
  std::string pool;  ///< its name
  std::uint32_t pool_number = 0, query = 0;
  traces::QueryType type = traces::QueryType::kOcclusion;
  bool precise = false;
  std::uint32_t statistics = 0;  ///< of `traces::PipelineStatistic`
  std::uint32_t first_draw = 0, draws = 0;
  [[nodiscard]] bool counts(std::uint32_t draw) const { return draw - first_draw < draws; }
};

/// Takes the commands of queries, of a validated stream, and gives the ranges in the order of their begins.
/// `draws`: how many the stream has had so far.
class QueryRanges {
 public:
  explicit QueryRanges(const std::vector<traces::QueryPool>& pools) : pools_(pools) {}
  void begin(const traces::BeginQuery& c, std::size_t draws);
  void end(const traces::EndQuery& c, std::size_t draws);
  /// An occlusion query is active.
  [[nodiscard]] bool counts_samples() const { return counts_samples_; }
  [[nodiscard]] const std::vector<QueryRange>& ranges() const { return ranges_; }

 private:
  const std::vector<traces::QueryPool>& pools_;
  std::vector<QueryRange> ranges_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> active_;  ///< places in `ranges_`
  bool counts_samples_ = false;
};

}  // namespace quadrille::pipeline
