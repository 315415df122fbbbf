/// A controller that idles for long leaves rounds of refresh out: nothing may tell that it did. One that is
/// traced sends each of them.
#include "models/memory/dram/controller.h"

#include "tests/models/memory/dram_traffic.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>

using namespace quadrille::models;

namespace {

using Cycle = DramController::Cycle;

struct Timed {
  Cycle at = 0;
  DramRequest request;
};

/// Everything that can be seen of a run, as numbers.
std::vector<Cycle> seen(const DramControllerParams& params, const std::vector<Timed>& requests, bool traced) {
  DramController controller(params);
  if (traced) controller.set_trace([](const DramCommand&) {});
  std::vector<DramDone> done;
  Cycle now = 0;
  for (std::size_t next = 0; next < requests.size() || controller.next() != DramController::kNever;) {
    const bool room = next < requests.size() && controller.room(requests[next].request.write);
    const Cycle arrival = room ? std::max(now, requests[next].at) : DramController::kNever;
    const Cycle command = std::max(now, controller.next());
    now = std::min(arrival, command);
    if (arrival <= command) controller.take(requests[next++].request, now);
    else controller.step(now, done);
  }
  std::vector<Cycle> all;
  Cycle end = 0;
  for (const DramDone& d : done) {
    all.insert(all.end(), {d.id, d.write, static_cast<Cycle>(d.row), d.arrived, d.done});
    end = std::max(end, d.done);
  }
  const DramCommandCounts& counts = controller.counts();
  for (const std::uint64_t count :
       {counts.activates, counts.precharges, counts.reads, counts.writes, counts.refreshes})
    all.push_back(static_cast<Cycle>(count));
  for (const Cycle cycles : controller.bus_cycles(end)) all.push_back(cycles);
  return all;
}

/// Bursts of requests with pauses of a few cycles to a few hundred intervals of refresh between them.
std::vector<Timed> with_pauses(std::mt19937& random, const DramTiming& timing) {
  std::vector<Timed> requests;
  Cycle at = 0;
  for (std::uint32_t i = 0; i < 60; ++i) {
    if (random() % 4 == 0) {
      const double intervals = std::uniform_real_distribution(-2.0, 2.5)(random);
      at += static_cast<Cycle>(timing.t_refi * std::pow(10.0, intervals));
    }
    requests.push_back({at, {random() % 100'000, std::uint8_t{0xf}, random() % 3 == 0, i}});
  }
  return requests;
}

}  // namespace

TEST_CASE("dram_controller: rounds of refresh that are left out change nothing that can be seen") {
  std::mt19937 random(5);
  for (const char* standard : {"ddr4", "lpddr5", "gddr6", "hbm2"})
    for (const DramRefresh refresh : {DramRefresh::kNone, DramRefresh::kAllBank, DramRefresh::kPerBank})
      for (const DramPolicy& policy : dram_policies()) {
        DramControllerParams params;
        params.timing = dram_timing(dram_data_file(standard));
        params.timing.refresh = refresh;
        params.timing.refresh_postpone = static_cast<int>(random() % 9);
        if (random() % 3 == 0) params.timing.t_rc *= 50;
        if (random() % 3 == 0) params.timing.t_wtr_l *= 200;
        params.scheduler = policy.scheduler;
        params.page = policy.page;
        params.write_drain = policy.write_drain;
        params.mapping = policy.mapping;
        params.hash = policy.hash;
        INFO(standard << ", " << policy.name << ", refresh " << static_cast<int>(refresh));
        const std::vector<Timed> requests = with_pauses(random, params.timing);
        CHECK(seen(params, requests, false) == seen(params, requests, true));
      }
}

TEST_CASE("dram_controller: an hour without a request costs no time, and has its refreshes") {
  for (const DramRefresh refresh : {DramRefresh::kAllBank, DramRefresh::kPerBank}) {
    DramControllerParams params;
    params.timing = dram_timing(dram_data_file("ddr4"));
    params.timing.refresh = refresh;
    const Cycle hour = Cycle{3600} * 1'600'000'000;
    const std::vector<Cycle> all = seen(params, {{0, {0, 0xf, false, 0}}, {hour, {1, 0xf, false, 1}}}, false);
    const Cycle refreshes = all.at(10 + 4);
    const DramTiming& t = params.timing;
    const Cycle each =
        refresh == DramRefresh::kAllBank ? hour / t.t_refi * t.ranks : hour / (t.t_refi / t.banks) * t.ranks;
    CHECK(std::abs(refreshes - each) <= 4 * t.banks * t.ranks);
  }
}
