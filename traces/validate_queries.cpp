/// Checks of query pools, and of the commands that begin and end queries.
#include "traces/validate_queries.h"

#include "models/base/error.h"

namespace quadrille::traces {
namespace {

constexpr std::uint32_t kMaxQueries = 1u << 20;  // of a pool

}  // namespace

void check_query_pool(const QueryPool& pool, std::size_t number) {
  if (pool.queries == 0 || pool.queries > kMaxQueries)
    throw user_error("query pool {} '{}': {} queries; 1 to {} are possible", number, pool.name, pool.queries,
                     kMaxQueries);
  const bool counts_stages = pool.type == QueryType::kPipelineStatistics;
  if (counts_stages && (pool.statistics == 0 || (pool.statistics & ~kAllStatistics) != 0))
    throw user_error("query pool {} '{}': statistics {:#x}; a part of {:#x} is possible", number, pool.name,
                     pool.statistics, kAllStatistics);
  if (!counts_stages && pool.statistics != 0)
    throw user_error("query pool {} '{}': statistics {:#x} of occlusion queries, which have none", number,
                     pool.name, pool.statistics);
}

void QueryWalk::check_there(std::uint32_t pool, std::uint32_t query, std::size_t at) const {
  if (pool >= pools_.size()) throw user_error("command {}: query pool {} does not exist", at, pool);
  if (query >= pools_[pool].queries)
    throw user_error("command {}: query {} does not exist; query pool {} '{}' has {}", at, query, pool,
                     pools_[pool].name, pools_[pool].queries);
}

void QueryWalk::begin(const BeginQuery& c, std::size_t at, bool in_pass) {
  check_there(c.pool, c.query, at);
  if (c.precise && pools_[c.pool].type != QueryType::kOcclusion)
    throw user_error("command {}: query {} of pool {} is precise; only occlusion queries are", at, c.query,
                     c.pool);
  if (std::optional<Active>& other = active(c.pool))
    throw user_error(
        "command {}: query {} of pool {} begins inside query {} of pool {}; one of a type may be active at a "
        "time",
        at, c.query, c.pool, other->query, other->pool);
  if (!begun_.emplace(c.pool, c.query).second)
    throw user_error("command {}: query {} of pool {} begins twice", at, c.query, c.pool);
  active(c.pool) = Active{c.pool, c.query, in_pass};
}

void QueryWalk::end(const EndQuery& c, std::size_t at, bool in_pass) {
  check_there(c.pool, c.query, at);
  std::optional<Active>& begun = active(c.pool);
  if (!begun || begun->pool != c.pool || begun->query != c.query)
    throw user_error("command {}: query {} of pool {} ends that is not active", at, c.query, c.pool);
  if (begun->in_pass != in_pass)
    throw user_error("command {}: query {} of pool {} began outside of the render pass in which it ends", at,
                     c.query, c.pool);
  begun.reset();
}

void QueryWalk::end_pass(std::size_t at) const {
  for (const std::optional<Active>& begun : active_)
    if (begun && begun->in_pass)
      throw user_error("command {}: a render pass ends in which query {} of pool {} has begun and not ended",
                       at, begun->query, begun->pool);
}

void QueryWalk::finish() const {
  for (const std::optional<Active>& begun : active_)
    if (begun) throw user_error("commands: query {} of pool {} is not ended", begun->query, begun->pool);
}

}  // namespace quadrille::traces
