#include "pipeline/driver/query_ranges.h"

namespace quadrille::pipeline {

void QueryRanges::begin(const traces::BeginQuery& c, std::size_t draws) {
  const traces::QueryPool& pool = pools_[c.pool];
  active_[{c.pool, c.query}] = ranges_.size();
  ranges_.push_back({pool.name, c.pool, c.query, pool.type, c.precise, pool.statistics,
                     static_cast<std::uint32_t>(draws), 0});
  if (pool.type == traces::QueryType::kOcclusion) counts_samples_ = true;
}

void QueryRanges::end(const traces::EndQuery& c, std::size_t draws) {
  const auto begun = active_.find({c.pool, c.query});
  QueryRange& range = ranges_[begun->second];
  range.draws = static_cast<std::uint32_t>(draws) - range.first_draw;
  active_.erase(begun);
  if (range.type == traces::QueryType::kOcclusion) counts_samples_ = false;
}

}  // namespace quadrille::pipeline
