/// Puts queries around the draws and passes of a stream that has none.
#include "models/base/error.h"
#include "traces/command_stream.h"

namespace quadrille::traces {

void query_everything(CommandStream& stream) {
  if (!stream.query_pools.empty()) throw user_error("it has queries of its own already");
  QueryPool samples{"draws", QueryType::kOcclusion, 0, 0};
  QueryPool statistics{"passes", QueryType::kPipelineStatistics, kAllStatistics, 0};
  std::vector<Command> commands;
  commands.reserve(3 * stream.commands.size());
  for (Command& command : stream.commands) {
    const bool draws = std::holds_alternative<Draw>(command);
    const bool begins = std::holds_alternative<BeginPass>(command);
    const bool ends = std::holds_alternative<EndPass>(command);
    if (draws) commands.emplace_back(BeginQuery{0, samples.queries, true});
    if (ends) commands.emplace_back(EndQuery{1, statistics.queries++});
    commands.push_back(std::move(command));
    if (begins) commands.emplace_back(BeginQuery{1, statistics.queries, false});
    if (draws) commands.emplace_back(EndQuery{0, samples.queries++});
  }
  stream.commands = std::move(commands);
  // A pool has at least one query.
  samples.queries = samples.queries == 0 ? 1 : samples.queries;
  stream.query_pools = {samples, statistics};
}

}  // namespace quadrille::traces
