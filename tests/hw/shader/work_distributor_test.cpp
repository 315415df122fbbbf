/// Work distributor: who gets the next warp.
#include "hw/shader/work_distributor.h"
#include "tests/hw/bench_stub.h"

#include <catch2/catch.hpp>

#include <set>

using namespace quadrille::hw;
using namespace quadrille::hw::bench;

namespace {

struct DistributorBench final : Bench {
  struct Setup {
    std::vector<Timed<VertexWarpToken>> vertex{};
    std::vector<Timed<FragmentWarpToken>> fragment_0{}, fragment_1{};
    std::vector<Pace> cores;
    LinkSpec out{.depth = 4};
    const DistributionPolicy* policy = &kLeastLoadedDistribution;
    int block_tiles = 4;
    std::vector<Timed<ReleaseToken>> done{};  ///< `slot` is the core
  };
  DistributorBench(Driver& driver, const contract::Variation& v, const Setup& s) : Bench(driver, v) {
    params.policy.set(*s.policy);
    params.block_tiles.set(s.block_tiles);
    unit = std::make_unique<WorkDistributor>(
        "unit", context({.cores = static_cast<int>(s.cores.size()), .partitions = 2}), params);
    add(*unit);
    feed(unit->vertex_in[0], s.vertex);
    feed(unit->fragment_in[0], s.fragment_0);
    feed(unit->fragment_in[1], s.fragment_1);
    feed(unit->load_in[0], s.done);
    feed(unit->load_in[1], {});
    feed(unit->load_in[2], {});
    for (std::size_t c = 0; c < s.cores.size(); ++c) {
      vertex.push_back(&drain<VertexWarpToken>(
          *unit->vertex_out[c], [](const VertexWarpToken& t) { return t.slot; }, s.cores[c], s.out));
      fragment.push_back(&drain<FragmentWarpToken>(
          *unit->fragment_out[c], [](const FragmentWarpToken& t) { return t.slot.index(); }, s.cores[c],
          s.out));
    }
  }
  WorkDistributor::Params params;
  std::unique_ptr<WorkDistributor> unit;
  std::vector<StubSink<VertexWarpToken>*> vertex;
  std::vector<StubSink<FragmentWarpToken>*> fragment;
};

std::vector<Timed<VertexWarpToken>> vertices(int first, int count, std::int64_t apart = 0) {
  std::vector<Timed<VertexWarpToken>> all;
  all.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i)
    all.push_back({i * apart, {DrawId(0), static_cast<std::uint32_t>(first + i)}});
  return all;
}
/// The fragment warp in this slot, whose first quad is in this tile.
FragmentWarpToken warp(int slot, std::uint16_t tile_x = 0, std::uint16_t tile_y = 0) {
  return {DrawId(0), WarpSlotId(slot), PartitionId(0), tile_x, tile_y};
}
std::vector<Timed<FragmentWarpToken>> warps(int first, int count, std::int64_t apart = 0) {
  std::vector<Timed<FragmentWarpToken>> all;
  all.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) all.push_back({i * apart, warp(first + i)});
  return all;
}

std::string vertex_text(const DistributorBench& b) {
  std::string all;
  for (const auto* sink : b.vertex) all += (all.empty() ? "" : " | ") + sink->text();
  return all;
}

std::string fragment_text(const DistributorBench& b) {
  std::string all;
  for (const auto* sink : b.fragment) all += (sink == b.fragment[0] ? "" : " | ") + sink->text();
  return all;
}

}  // namespace

TEST_CASE("work_distributor: cores that are equally loaded take turns, one warp a cycle") {
  for (const DistributionPolicy* policy : distribution_policies().all())
    CHECK(run<DistributorBench>({.vertex = vertices(0, 6), .cores = {{}, {}, {}}, .policy = policy},
                                vertex_text) == "2:0 5:3 | 3:1 6:4 | 4:2 7:5");
}

TEST_CASE(
    "work_distributor: a core that is not done with its warps gets no more while others have fewer, though "
    "it has room, in turn it does") {
  // Cores 1 and 2 are done with each warp seven cycles after it was sent, core 0 never.
  DistributorBench::Setup s{.vertex = vertices(0, 7, 10), .cores = {{}, {}, {}}};
  for (const auto& [cycle, core] : {std::pair{18, 1u}, {28, 2u}, {38, 1u}, {48, 2u}, {58, 1u}, {68, 2u}})
    s.done.push_back({cycle, {core, 0}});
  CHECK(run<DistributorBench>(s, vertex_text) == "2:0 | 12:1 32:3 52:5 | 22:2 42:4 62:6");
  s.policy = &kRoundRobinDistribution;
  s.done.clear();
  CHECK(run<DistributorBench>(s, vertex_text) == "2:0 32:3 62:6 | 12:1 42:4 | 22:2 52:5");
}

TEST_CASE("work_distributor: vertex and fragment warps of a core count together") {
  const DistributorBench::Setup s{.vertex = vertices(0, 1), .fragment_0 = warps(10, 1, 1), .cores = {{}, {}}};
  auto later = s;
  later.fragment_0[0].cycle = 20;
  CHECK(run<DistributorBench>(later, fragment_text) == " | 22:10");
}

TEST_CASE(
    "work_distributor: by tile, the warps of a square of tiles go to one core, and those of its neighbours "
    "to others") {
  DistributorBench::Setup s{
      .cores = {{}, {}, {}, {}}, .out = {.depth = 64}, .policy = &kTileDistribution, .block_tiles = 2};
  int slot = 0;
  for (std::uint16_t y = 0; y < 4; ++y) {
    for (std::uint16_t x = 0; x < 4; ++x, ++slot)
      (x % 2 == 0 ? s.fragment_0 : s.fragment_1).push_back({0, warp(slot, x, y)});
  }
  const auto cores = run<DistributorBench>(s, [](const DistributorBench& b) {
    std::vector<std::size_t> core_of(16);
    for (std::size_t c = 0; c < 4; ++c) {
      for (const auto& got : b.fragment[c]->got) core_of[got.token.slot.index()] = c;
    }
    bool together = true;
    for (std::size_t i = 0; i < 16; ++i)
      together = together && core_of[i] == core_of[i / 8 * 8 + i % 4 / 2 * 2];
    const std::set<std::size_t> row{core_of[0], core_of[2]}, column{core_of[0], core_of[8]};
    return fmt::format("{} {} {}", together, row.size(), column.size());
  });
  CHECK(cores == "true 2 2");
}

TEST_CASE(
    "work_distributor: by tile, a warp waits for its core while another has room, another partition's goes "
    "past it") {
  DistributorBench::Setup s{.cores = {{.from = 100}, {.from = 100}},
                            .out = {.depth = 2},
                            .policy = &kTileDistribution,
                            .block_tiles = 1};
  for (int i = 0; i < 3; ++i) s.fragment_0.push_back({0, warp(i)});
  s.fragment_1.push_back({50, warp(9, 1)});
  CHECK(run<DistributorBench>(s, fragment_text) == "100:0 101:1 102:2 | 100:9");
  s.policy = &kLeastLoadedDistribution;
  CHECK(run<DistributorBench>(s, fragment_text) == "100:0 101:2 | 100:1 101:9");
}

TEST_CASE("work_distributor: partitions take turns, and vertex work does not slow fragments") {
  const DistributorBench::Setup s{.vertex = vertices(0, 3),
                                  .fragment_0 = warps(10, 3),
                                  .fragment_1 = warps(20, 3),
                                  .cores = {{}},
                                  .out = {.depth = 16}};
  const auto text = run<DistributorBench>(s, [](const DistributorBench& b) {
    return fmt::format("{} | {} | {} {}", b.vertex[0]->text(), b.fragment[0]->text(),
                       counter(*b.unit, "vertex_warps"), counter(*b.unit, "fragment_warps"));
  });
  CHECK(text == "2:0 3:1 4:2 | 2:10 3:20 4:11 5:21 6:12 7:22 | 3 6");
}

TEST_CASE(
    "work_distributor: waits while every core is full, and gives the next warp to the first with room") {
  const DistributorBench::Setup s{
      .vertex = vertices(0, 5), .cores = {{.from = 60}, {.from = 50, .period = 100}}, .out = {.depth = 1}};
  CHECK(run<DistributorBench>(s, vertex_text) == "60:0 62:3 64:4 | 50:1 150:2");
}

TEST_CASE("work_distributor: keeps the contract, one-deep links included") {
  for (const DistributionPolicy* policy : distribution_policies().all()) {
    DistributorBench::Setup s{.vertex = vertices(0, 9),
                              .fragment_0 = warps(10, 7),
                              .fragment_1 = warps(20, 5, 3),
                              .cores = {{.from = 0, .period = 4}, {.from = 9, .period = 3}},
                              .policy = policy,
                              .block_tiles = 1,
                              .done = {{15, {1, 0}}, {30, {0, 0}}}};
    for (std::uint16_t i = 0; i < 7; ++i) s.fragment_0[i].token.tile_x = i;
    CHECK(contract_text<DistributorBench>(s, false) == "");
  }
}
