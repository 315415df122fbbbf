/// A memory controller of ours with a scheduler of your own: reads that arrive behind many writes are
/// answered sooner than by the schedulers that come with Quadrille.
#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "hw/memory/memory_channel.h"
#include "models/memory/dram/controller.h"

namespace examples {
extern const quadrille::models::DramSchedulerPolicy kReadsFirstScheduler;
}

namespace {

using namespace quadrille;

/// The cycle in which the last of 8 reads is done that come behind 32 writes to other rows.
std::int64_t reads_done(std::string_view scheduler) {
  hw::MemoryChannel::Params params;  // as of the default machine
  params.find("scheduler")->parse(scheduler);
  params.find("write_drain")->parse("off");
  models::DramController controller(params.controller());
  constexpr std::uint64_t kNextRow = 1 << 16;
  for (std::uint32_t i = 0; i < 32; ++i) controller.take({kNextRow * (i + 1), 0xf, true, i}, 0);
  for (std::uint32_t i = 0; i < 8; ++i) controller.take({i, 0xf, false, 100 + i}, 0);
  std::vector<models::DramDone> done;
  while (controller.next() != models::DramController::kNever) controller.step(controller.next(), done);
  std::int64_t last = 0;
  for (const models::DramDone& each : done)
    if (!each.write) last = std::max(last, each.done);
  return last;
}

}  // namespace

int sc_main(int /*count*/, char** /*arguments*/) {
  models::dram_schedulers().add(examples::kReadsFirstScheduler);  // the one line of registration
  for (const models::DramSchedulerPolicy* policy : models::dram_schedulers().all())
    fmt::print("{}: the reads are done in cycle {} ({})\n", policy->name, reads_done(policy->name),
               policy->reason);
  const bool right = reads_done("reads_first") < reads_done("first_ready") &&
                     reads_done("first_ready") <= reads_done("in_order");
  return right ? 0 : 1;
}
