/// The DRAM controller against arithmetic: what one access costs, what a bank and a rank allow at most, how
/// much of its peak each standard reaches, and in which each policy differs from the others.
#include "models/memory/dram/controller.h"

#include "tests/models/memory/dram_traffic.h"

#include <catch2/catch.hpp>
#include <functional>

using namespace quadrille::models;

namespace {

using Cycle = DramController::Cycle;
constexpr std::uint8_t kLine = 0xf, kSector = 0x1;

struct Timed {
  Cycle at = 0;
  DramRequest request;
};

struct Outcome {
  std::vector<DramDone> done;  ///< in the order in which the last commands went out
  std::vector<DramCommand> commands;
  Cycle end = 0;  ///< last data moved
  BusAccount::Cycles bus{};
  [[nodiscard]] Cycle of(BusUse use) const { return bus[static_cast<std::size_t>(use)]; }
  [[nodiscard]] std::int64_t hits() const {
    return std::ranges::count(done, DramRowOutcome::kHit, &DramDone::row);
  }
  [[nodiscard]] double mean_spacing(DramCommandKind kind) const {
    Cycle first = 0, last = 0;
    std::int64_t count = 0;
    for (const DramCommand& c : commands) {
      if (c.kind != kind) continue;
      if (count++ == 0) first = c.cycle;
      last = c.cycle;
    }
    return static_cast<double>(last - first) / static_cast<double>(count - 1);
  }
};

Outcome serve(const DramControllerParams& params, const std::vector<Timed>& requests) {
  DramController controller(params);
  Outcome out;
  controller.set_trace([&](const DramCommand& c) { out.commands.push_back(c); });
  std::size_t next = 0;
  Cycle now = 0;
  while (true) {
    while (next < requests.size() && requests[next].at <= now &&
           controller.room(requests[next].request.write)) {
      DramRequest request = requests[next].request;
      request.id = static_cast<std::uint32_t>(next++);
      controller.take(request, now);
    }
    if (controller.next() <= now) controller.step(now, out.done);
    Cycle soonest = controller.next();
    if (next < requests.size() && controller.room(requests[next].request.write))
      soonest = std::min(soonest, std::max(now + 1, requests[next].at));
    if (soonest == DramController::kNever) break;
    now = std::max(now + 1, soonest);
  }
  for (const DramDone& d : out.done) out.end = std::max(out.end, d.done);
  out.bus = controller.bus_cycles(out.end);
  return out;
}

DramControllerParams of(const std::string& standard) {
  DramControllerParams p;
  p.timing = dram_timing(dram_data_file(standard));
  return p;
}

/// Without refresh and with rows in plain order, so that a line's bank can be told from its number.
DramControllerParams plain(const std::string& standard) {
  DramControllerParams p = of(standard);
  p.timing.refresh = DramRefresh::kNone;
  p.hash = false;
  p.mapping = &kRowMapping;
  return p;
}

std::uint64_t row_lines(const DramTiming& t) {
  return static_cast<std::uint64_t>(t.row_bytes) / 128 * static_cast<std::uint64_t>(t.pseudo_channels);
}
/// Lines from a row to the next row of the same bank.
std::uint64_t bank_lines(const DramTiming& t) {
  return row_lines(t) * static_cast<std::uint64_t>(t.all_banks());
}

std::vector<Timed> stream(std::size_t count, const std::function<DramRequest(std::uint64_t)>& request) {
  std::vector<Timed> all;
  for (std::uint64_t i = 0; i < count; ++i) all.push_back({0, request(i)});
  return all;
}

const auto kStandards = {"ddr4", "lpddr5", "gddr6", "hbm2"};

bool near(double value, double expected, double share) {
  return std::abs(value - expected) <= share * expected;
}

}  // namespace

TEST_CASE(
    "dram_controller: an idle access takes the row's activation, the command's latency and its bursts") {
  for (const char* standard : kStandards) {
    INFO(standard);
    const DramControllerParams p = plain(standard);
    const DramTiming& t = p.timing;
    const Cycle spacing = std::max(t.t_ccd_l, t.t_burst);
    const Cycle bursts = 128 / t.burst_bytes;
    const Outcome read = serve(
        p, {{100, {0, kLine, false}}, {1000, {0, kSector, false}}, {2000, {bank_lines(t), kSector, false}}});
    REQUIRE(read.done.size() == 3);
    CHECK(read.done[0].done == 100 + t.t_rcd + t.t_cas + (bursts - 1) * spacing + t.t_burst);
    CHECK(read.done[1].done == 1000 + t.t_cas + t.t_burst);
    CHECK(read.done[2].done == 2000 + t.t_rp + t.t_rcd + t.t_cas + t.t_burst);
    CHECK(read.done[0].row == DramRowOutcome::kMiss);
    CHECK(read.done[1].row == DramRowOutcome::kHit);
    CHECK(read.done[2].row == DramRowOutcome::kConflict);
    const Outcome write = serve(p, {{100, {0, kSector, true}}});
    CHECK(write.done[0].done == 100 + t.t_rcd_wr + t.t_cwl + t.t_burst);
  }
}

TEST_CASE("dram_controller: a chain of rows in one bank opens one each t_rc") {
  for (const char* standard : kStandards) {
    INFO(standard);
    const DramControllerParams p = plain(standard);
    const Outcome out = serve(p, stream(400, [&](std::uint64_t i) {
                                return DramRequest{i * bank_lines(p.timing), kSector, false};
                              }));
    CHECK(out.hits() == 0);
    CHECK(near(out.mean_spacing(DramCommandKind::kActivate),
               std::max(p.timing.t_rc, p.timing.t_ras + p.timing.t_rp), 0.02));
  }
}

TEST_CASE("dram_controller: all banks in turn open a row each t_rrd, four each t_faw") {
  for (const char* standard : kStandards) {
    INFO(standard);
    DramControllerParams p = plain(standard);
    p.timing.ranks = 1;
    const DramTiming& t = p.timing;
    // One sector of a new row each time, bank after bank of one pseudo-channel.
    const auto line = [&](std::uint64_t i) {
      const auto banks = static_cast<std::uint64_t>(t.banks);
      // Neighbours in other bank groups.
      const std::uint64_t bank = i % banks, groups = static_cast<std::uint64_t>(t.bank_groups);
      const std::uint64_t place = bank % groups + bank / groups * groups;
      return (i / banks * banks + place) * row_lines(t);
    };
    const Outcome out = serve(p, stream(1600, [&](std::uint64_t i) {
                                return DramRequest{line(i), kSector, false};
                              }));
    const double least =
        std::max({static_cast<double>(t.t_rrd_s), t.t_faw / 4.0, static_cast<double>(t.t_burst),
                  static_cast<double>(t.t_rc) / t.banks,
                  static_cast<double>(t.act_slots + t.column_slots + 1) * (t.separate_buses ? 0 : 1)});
    INFO(out.mean_spacing(DramCommandKind::kActivate) << " of " << least);
    CHECK(near(out.mean_spacing(DramCommandKind::kActivate), least, 0.02));
  }
}

TEST_CASE(
    "dram_controller: streams of reads, of writes and of both reach 95 % of what refresh and turn-around "
    "leave",
    "[slow]") {
  for (const char* standard : kStandards) {
    const DramControllerParams p = of(standard);
    const auto share = [&](const char* what, const std::function<DramRequest(std::uint64_t)>& request) {
      const Outcome out = serve(p, stream(40'000, request));
      const double all = static_cast<double>(out.end) * p.timing.pseudo_channels;
      const double moved = static_cast<double>(out.of(BusUse::kRead) + out.of(BusUse::kWrite)) / all;
      const double lost = static_cast<double>(out.of(BusUse::kRefresh) + out.of(BusUse::kTurnaround)) / all;
      INFO(standard << ", " << what << ": moved " << moved << ", lost to refresh and turn-around " << lost);
      CHECK(moved >= 0.95 * (1 - lost));
      CHECK(lost <= 0.12);
    };
    share("reads", [](std::uint64_t i) { return DramRequest{i, kLine, false}; });
    share("writes", [](std::uint64_t i) { return DramRequest{i, kLine, true}; });
    share("both", [](std::uint64_t i) {
      return DramRequest{i / 2 + (i % 2) * 1'000'003, kLine, i % 2 == 1};
    });
  }
}

TEST_CASE("dram_controller: the bus's cycles add up to the time, whenever the frame ends") {
  const DramControllerParams p = of("gddr6");
  DramController controller(p);
  std::vector<DramDone> done;
  for (std::uint32_t i = 0; i < 60; ++i) controller.take({i * 7, kLine, i % 3 == 0, i}, 50);
  while (controller.next() != DramController::kNever) controller.step(controller.next(), done);
  for (const Cycle end : {1, 49, 50, 90, 133, 200, 301, 5000}) {
    Cycle sum = 0;
    for (const Cycle cycles : controller.bus_cycles(end)) sum += cycles;
    CHECK(sum == end * p.timing.pseudo_channels);
  }
  CHECK(controller.bus_cycles(50)[static_cast<std::size_t>(BusUse::kIdle)] == 50 * p.timing.pseudo_channels);
}

TEST_CASE("dram_controller: first-ready serves the open row first, and the age cap ends it") {
  DramControllerParams p = plain("gddr6");
  std::vector<Timed> requests;
  for (std::uint64_t i = 0; i < 40; ++i)
    requests.push_back({0, {(i % 2) * bank_lines(p.timing), kSector, false}});
  const auto rows_opened = [&] {
    const Outcome out = serve(p, requests);
    return std::ranges::count(out.commands, DramCommandKind::kActivate, &DramCommand::kind);
  };
  CHECK(rows_opened() == 2);
  p.age_cap = 0;
  CHECK(rows_opened() > 2);
  p.scheduler = &kInOrderScheduler;
  CHECK(rows_opened() == 40);
}

TEST_CASE("dram_controller: with watermarks reads go before waiting writes, until these are many") {
  DramControllerParams p = plain("gddr6");
  std::vector<Timed> requests;
  const auto mean_read = [&] {
    double sum = 0;
    int count = 0;
    for (const DramDone& d : serve(p, requests).done) {
      if (d.write) continue;
      sum += static_cast<double>(d.done - d.arrived);
      ++count;
    }
    return sum / count;
  };
  // Two writes for each read, to the same rows.
  for (std::uint64_t i = 0; i < 600; ++i)
    requests.push_back({static_cast<Cycle>(4 * i), {i, kSector, i % 3 != 0}});
  const double with = mean_read();
  p.write_drain = &kNoWriteDrain;
  CHECK(mean_read() > 1.2 * with);
}

TEST_CASE(
    "dram_controller: an open page stays, a closed one closes with its last burst, an adaptive one after its "
    "time") {
  DramControllerParams p = plain("gddr6");
  p.page_idle = 300;
  // The same row again after 100 cycles, and after 500 more.
  const std::vector<Timed> requests{
      {0, {0, kSector, false}}, {100, {0, kSector, false}}, {600, {0, kSector, false}}};
  const auto rows = [&](const DramPagePolicyEntry& page) {
    p.page = &page;
    std::string text;
    for (const DramDone& d : serve(p, requests).done)
      text += d.row == DramRowOutcome::kHit ? "hit " : d.row == DramRowOutcome::kMiss ? "miss " : "conflict ";
    return text;
  };
  CHECK(rows(kOpenPages) == "miss hit hit ");
  CHECK(rows(kClosedPages) == "miss miss miss ");
  CHECK(rows(kAdaptivePages) == "miss hit miss ");
}

TEST_CASE("dram_controller: refreshes keep their mean interval, postponed while requests wait") {
  DramControllerParams p = of("ddr4");
  const Cycle interval = p.timing.t_refi;
  const auto refreshes = [&](const std::vector<Timed>& requests) {
    std::int64_t count = 0;
    for (const DramCommand& c : serve(p, requests).commands)
      count += c.kind == DramCommandKind::kRefresh && c.rank == 0;
    return count;
  };
  // Idle until the second request: every refresh went out when it was due.
  CHECK(refreshes({{0, {0, kSector, false}}, {20 * interval + 1000, {0, kSector, false}}}) == 20);
  // Always a request waiting: the first goes out when no more may be postponed.
  std::vector<Timed> busy;
  for (Cycle at = 0; at < 12 * interval; at += 20)
    busy.push_back({at, {static_cast<std::uint64_t>(at) / 20, kLine, false}});
  const std::int64_t sent = refreshes(busy);
  CHECK(sent >= 12 - p.timing.refresh_postpone);
  CHECK(sent <= 12);
}

TEST_CASE("dram_controller: requests are served however long an activation or a refresh takes") {
  const auto finishes = [](DramControllerParams p) {
    std::vector<Timed> requests;
    for (std::uint64_t i = 0; i < 600; ++i)
      requests.push_back({static_cast<Cycle>(i), {i * 977, kSector, i % 3 == 0}});
    return serve(p, requests).done.size();
  };
  for (const char* standard : kStandards) {
    INFO(standard);
    DramControllerParams slow_rows = of(standard), long_gap = of(standard), many_banks = of(standard),
                         half_refresh = of(standard);
    slow_rows.timing.t_rcd = slow_rows.timing.t_rcd_wr = 3 * slow_rows.timing.t_refi;
    CHECK(finishes(slow_rows) == 600);
    long_gap.timing.refresh = many_banks.timing.refresh = DramRefresh::kPerBank;
    long_gap.timing.t_rrefd = 500;
    CHECK(finishes(long_gap) == 600);
    many_banks.timing.t_refi = many_banks.timing.banks;
    CHECK(finishes(many_banks) == 600);
    half_refresh.timing.refresh = DramRefresh::kAllBank;
    half_refresh.timing.t_rfc = half_refresh.timing.t_refi / 2;
    half_refresh.timing.refresh_postpone = 0;
    CHECK(finishes(half_refresh) == 600);
  }
}
