/// Work distributor: who gets the next warp.
#include "hw/shader/work_distributor.h"
#include "tests/hw/bench_stub.h"

#include <catch2/catch.hpp>

using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

struct DistributorBench final : Bench {
  struct Setup {
    std::vector<Timed<WarpToken>> vertex{}, fragment_0{}, fragment_1{};
    std::vector<Pace> cores;
    LinkSpec out{.depth = 4};
  };
  DistributorBench(Driver& driver, const contract::Variation& v, const Setup& s) : Bench(driver, v) {
    unit = std::make_unique<WorkDistributor>("unit", clock, 2, static_cast<int>(s.cores.size()));
    add(*unit);
    feed(unit->vertex_in, s.vertex);
    feed(unit->fragment_in[0], s.fragment_0);
    feed(unit->fragment_in[1], s.fragment_1);
    const auto key = [](const WarpToken& t) { return t.slot; };
    for (std::size_t c = 0; c < s.cores.size(); ++c) {
      vertex.push_back(&drain<WarpToken>(*unit->vertex_out[c], key, s.cores[c], s.out));
      fragment.push_back(&drain<WarpToken>(*unit->fragment_out[c], key, s.cores[c], s.out));
    }
  }
  std::unique_ptr<WorkDistributor> unit;
  std::vector<StubSink<WarpToken>*> vertex, fragment;
};

std::vector<Timed<WarpToken>> warps(std::uint32_t first, int count, std::int64_t apart = 0) {
  std::vector<Timed<WarpToken>> all;
  for (int i = 0; i < count; ++i) all.push_back({i * apart, {0, first + static_cast<std::uint32_t>(i), 0}});
  return all;
}

std::string vertex_text(const DistributorBench& b) {
  std::string all;
  for (const auto* sink : b.vertex) all += (all.empty() ? "" : " | ") + sink->text();
  return all;
}

}  // namespace

TEST_CASE("work_distributor: cores that are equally free take turns, one warp a cycle") {
  CHECK(run<DistributorBench>({.vertex = warps(0, 6), .cores = {{}, {}, {}}}, vertex_text) == "2:0 5:3 | 3:1 6:4 | 4:2 7:5");
}

TEST_CASE("work_distributor: a core that does not take its warps gets no more while others are less loaded") {
  CHECK(run<DistributorBench>({.vertex = warps(0, 7, 10), .cores = {{.from = 200}, {}, {}}}, vertex_text) ==
        "200:0 | 12:1 32:3 52:5 | 22:2 42:4 62:6");
}

TEST_CASE("work_distributor: partitions take turns, and vertex work does not slow fragments") {
  const DistributorBench::Setup s{
      .vertex = warps(0, 3), .fragment_0 = warps(10, 3), .fragment_1 = warps(20, 3), .cores = {{}}, .out = {.depth = 16}};
  const auto text = run<DistributorBench>(s, [](const DistributorBench& b) {
    return fmt::format("{} | {} | {} {}", b.vertex[0]->text(), b.fragment[0]->text(), counter(*b.unit, "vertex_warps"),
                       counter(*b.unit, "fragment_warps"));
  });
  CHECK(text == "2:0 3:1 4:2 | 2:10 3:20 4:11 5:21 6:12 7:22 | 3 6");
}

TEST_CASE("work_distributor: waits while every core is full, and gives the next warp to the first with room") {
  const DistributorBench::Setup s{.vertex = warps(0, 5), .cores = {{.from = 60}, {.from = 50, .period = 100}}, .out = {.depth = 1}};
  CHECK(run<DistributorBench>(s, vertex_text) == "60:0 62:3 64:4 | 50:1 150:2");
}

TEST_CASE("work_distributor: keeps the contract, one-deep links included") {
  const DistributorBench::Setup s{.vertex = warps(0, 9),
                                  .fragment_0 = warps(10, 7),
                                  .fragment_1 = warps(20, 5, 3),
                                  .cores = {{.from = 0, .period = 4}, {.from = 9, .period = 3}}};
  CHECK(contract_text<DistributorBench>(s, false) == "");
}
