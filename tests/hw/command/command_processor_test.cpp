/// Command processor: the time of a draw, the bound on draws in flight, barriers, quiet intervals.
#include "hw/command/command_processor.h"
#include "tests/hw/bench_stub.h"

#include <catch2/catch.hpp>

using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

struct CommandBench final : Bench {
  struct Setup {
    std::vector<std::uint32_t> draws_of_pass;
    std::vector<Timed<RetireToken>> retire_0{}, retire_1{};
    std::vector<Timed<ReleaseToken>> scan_done{};
    int draw_clk = 16, in_flight = 32;
    Pace pace{};
    LinkSpec out{.depth = 64};
    std::vector<std::size_t> outside{};  ///< draws out of view
    bool culls = true;
  };
  CommandBench(Driver& driver, const contract::Variation& v, const Setup& s) : Bench(driver, v) {
    for (const std::uint32_t draws : s.draws_of_pass) {
      PassState pass;
      pass.first_draw = DrawId(frame.draws.size());
      pass.draws = draws;
      frame.passes.push_back(pass);
      frame.draws.resize(frame.draws.size() + draws);
    }
    for (const std::size_t draw : s.outside) frame.draws[draw].outside_view = true;
    params.cull_draws.set(s.culls);
    params.draw_clk.set(s.draw_clk);
    params.draws_in_flight.set(s.in_flight);
    unit = std::make_unique<CommandProcessor>("unit", context({.partitions = 2}), params, quiet);
    add(*unit);
    feed(unit->retire_in[0], s.retire_0);
    feed(unit->retire_in[1], s.retire_1);
    feed(unit->scan_done_in, s.scan_done);
    issued = &drain<DrawToken>(
        *unit->draw_out[0],
        [](const DrawToken& t) {
          const bool pass = t.kind == TokenKind::kPassBegin || t.kind == TokenKind::kPassEnd;
          return 100 * static_cast<unsigned>(t.kind) + (pass ? t.part.pass().index() : t.part.draw().index());
        },
        s.pace, s.out);
    scans = &drain<ScanToken>(unit->scan_out, [](const ScanToken& t) { return t.pass.index(); });
  }
  [[nodiscard]] bool finished() const override { return Bench::finished() && unit->finished(); }
  QuietLog quiet;
  CommandProcessor::Params params;
  std::unique_ptr<CommandProcessor> unit;
  StubSink<DrawToken>* issued = nullptr;
  StubSink<ScanToken>* scans = nullptr;
};

// Keys: 3xx pass begin, 0xx draw, 2xx draw end, 4xx pass end.
const RetireToken kRetired{TokenKind::kDrawEnd, DrawId(0)}, kFlushed{TokenKind::kPassEnd, PassId(0)};

}  // namespace

TEST_CASE("command_processor: a draw takes draw_clk cycles, its end and the boundaries one each") {
  for (const int clk : {1, 16}) {
    const auto text = run<CommandBench>({.draws_of_pass = {2}, .draw_clk = clk},
                                        [](const CommandBench& b) { return b.issued->text(); });
    CHECK(text ==
          fmt::format("1:300 2:0 {}:200 {}:1 {}:201 {}:400", 2 + clk, 3 + clk, 3 + 2 * clk, 4 + 2 * clk));
  }
}

TEST_CASE(
    "command_processor: issues no more draws than may be in flight, one counts until every partition has "
    "retired it") {
  const CommandBench::Setup s{.draws_of_pass = {3},
                              .retire_0 = {{40, kRetired}, {41, kRetired}},
                              .retire_1 = {{50, kRetired}, {90, kRetired}},
                              .draw_clk = 1,
                              .in_flight = 1};
  const auto text = run<CommandBench>(s, [](const CommandBench& b) {
    const Resource& places = b.unit->resources().all().back();
    return fmt::format("{} retired {}, {} full for {}", b.issued->text(), counter(*b.unit, "draws_retired"),
                       places.name, places.taken);
  });
  // Full from the end of a draw until the last partition has retired it: 2 to 51, 52 to 91.
  CHECK(text == "1:300 2:0 3:200 52:1 53:201 92:2 93:202 94:400 retired 2, draws_in_flight full for 88");
}

TEST_CASE("command_processor: the next pass begins the cycle the last partition has flushed") {
  const CommandBench::Setup s{
      .draws_of_pass = {0, 0}, .retire_0 = {{30, kFlushed}}, .retire_1 = {{60, kFlushed}}};
  const auto text = run<CommandBench>(
      s, [](const CommandBench& b) { return fmt::format("{} scans {}", b.issued->text(), b.scans->text()); });
  CHECK(text == "1:300 2:400 62:301 63:401 scans ");
}

TEST_CASE(
    "command_processor: the image is shown once the last pass is flushed, and the frame ends when it was "
    "read") {
  const CommandBench::Setup s{.draws_of_pass = {0},
                              .retire_0 = {{30, kFlushed}},
                              .retire_1 = {{20, kFlushed}},
                              .scan_done = {{80, {}}}};
  const auto text = run<CommandBench>(s, [](const CommandBench& b) {
    return fmt::format("scan {} rendered {} ended {} finished {}", b.scans->text(),
                       b.unit->render_end() / kCycle, b.unit->end() / kCycle, b.unit->finished());
  });
  CHECK(text == "scan 32:0 rendered 31 ended 81 finished true");
}

TEST_CASE("command_processor: a frame without passes is finished before it begins") {
  CHECK(run<CommandBench>({.draws_of_pass = {}}, [](const CommandBench& b) {
          return fmt::format("{}{}", b.unit->finished(), b.issued->text());
        }) == "true");
}

TEST_CASE("command_processor: the time from a flush to the next pass's begin is logged as quiet") {
  const CommandBench::Setup s{.draws_of_pass = {0, 0},
                              .retire_0 = {{30, kFlushed}},
                              .retire_1 = {{30, kFlushed}},
                              .pace = {.from = 50},
                              .out = {.depth = 2}};
  const auto text = run<CommandBench>(s, [](const CommandBench& b) {
    std::string all;
    for (const auto& q : b.quiet.intervals()) all += fmt::format("[{},{})", q.from / kCycle, q.to / kCycle);
    return b.issued->text() + " quiet " + all;
  });
  CHECK(text == "50:300 51:400 52:301 53:401 quiet [31,51)");
}

TEST_CASE("command_processor: a draw out of view takes draw_clk cycles, and nothing is sent for it") {
  CommandBench::Setup s{.draws_of_pass = {3}, .draw_clk = 10, .outside = {1}};
  const auto told = [](const CommandBench& b) {
    return fmt::format("{} draws {} culled {}", b.issued->text(), counter(*b.unit, "draws"),
                       counter(*b.unit, "draws_culled"));
  };
  // The second draw from 13 to 23.
  CHECK(run<CommandBench>(s, told) == "1:300 2:0 12:200 23:2 33:202 34:400 draws 2 culled 1");
  s.culls = false;
  CHECK(run<CommandBench>(s, told) == "1:300 2:0 12:200 13:1 23:201 24:2 34:202 35:400 draws 3 culled 0");
}

TEST_CASE("command_processor: a draw out of view is dropped while as many are in flight as may be") {
  const CommandBench::Setup s{.draws_of_pass = {3},
                              .retire_0 = {{40, kRetired}, {90, kRetired}},
                              .retire_1 = {{50, kRetired}, {95, kRetired}},
                              .draw_clk = 5,
                              .in_flight = 1,
                              .outside = {1}};
  const auto text = run<CommandBench>(s, [](const CommandBench& b) {
    std::string all = b.issued->text();
    for (const Tick tick : b.unit->issued_at()) all += fmt::format(" {}", tick / kCycle);
    for (const Tick tick : b.unit->retired_at()) all += fmt::format(" {}", tick / kCycle);
    return all;
  });
  // Issued at 1, 7 and 51; done with at 51, 12 and 96.
  CHECK(text == "1:300 2:0 7:200 52:2 57:202 58:400 1 7 51 51 12 96");
}

TEST_CASE("command_processor: keeps the contract, one-deep links included") {
  const CommandBench::Setup s{.draws_of_pass = {2, 0, 1},
                              .retire_0 = {{60, kRetired},
                                           {61, kRetired},
                                           {100, kFlushed},
                                           {200, kFlushed},
                                           {280, kRetired},
                                           {300, kFlushed}},
                              .retire_1 = {{60, kRetired},
                                           {70, kRetired},
                                           {110, kFlushed},
                                           {190, kFlushed},
                                           {290, kRetired},
                                           {310, kFlushed}},
                              .scan_done = {{400, {}}},
                              .in_flight = 1,
                              .pace = {.from = 0, .period = 2}};
  CHECK(contract_text<CommandBench>(s) == "");
}

TEST_CASE("command_processor: keeps the contract where it drops draws") {
  const CommandBench::Setup s{.draws_of_pass = {4, 1},
                              .retire_0 = {{60, kRetired}, {110, kRetired}, {150, kFlushed}, {300, kFlushed}},
                              .retire_1 = {{70, kRetired}, {100, kRetired}, {160, kFlushed}, {310, kFlushed}},
                              .scan_done = {{400, {}}},
                              .in_flight = 1,
                              .pace = {.from = 0, .period = 2},
                              .outside = {0, 2, 4}};
  CHECK(contract_text<CommandBench>(s) == "");
}
