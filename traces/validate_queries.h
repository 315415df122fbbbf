/// The rules of queries: which may be begun and ended where.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "traces/queries.h"

namespace quadrille::traces {

/// Throws `UserError` for a pool that no device has.
void check_query_pool(const QueryPool& pool, std::size_t number);

/// Follows the queries of a stream. One of each type may be active at a time; what begins within a render
/// pass ends in it, and what begins outside of one ends outside. [VK1.3 #queries-operation-active]
/// `at`: number of the command, for messages. All throw `UserError`.
class QueryWalk {
 public:
  explicit QueryWalk(const std::vector<QueryPool>& pools) : pools_(pools) {}
  void begin(const BeginQuery& c, std::size_t at, bool in_pass);
  void end(const EndQuery& c, std::size_t at, bool in_pass);
  void end_pass(std::size_t at) const;
  void finish() const;

 private:
  struct Active {
    std::uint32_t pool = 0, query = 0;
    bool in_pass = false;
  };
  std::optional<Active>& active(std::uint32_t pool) {
    return active_[static_cast<std::size_t>(pools_[pool].type)];
  }
  void check_there(std::uint32_t pool, std::uint32_t query, std::size_t at) const;

  const std::vector<QueryPool>& pools_;
  std::array<std::optional<Active>, 2> active_;  ///< by type
  std::set<std::pair<std::uint32_t, std::uint32_t>> begun_;
};

}  // namespace quadrille::traces
