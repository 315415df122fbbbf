/// Vertex fetch: what a batch holds, what it costs, and when it leaves.
#include "hw/geometry/vertex_fetch.h"
#include "tests/hw/bench_stub.h"

#include <catch2/catch.hpp>

#include <bit>

using namespace quadrille::hw;
using namespace quadrille::hw::bench;
namespace models = quadrille::models;

namespace {

constexpr int kLatency = 20;  ///< of the memory behind the vertex cache, cycles

/// One draw of triangles whose vertices are three floats each: vertex v is at (v, v + 0.25, v + 0.5).
struct FetchBench final : Bench {
  struct Setup {
    std::uint32_t triangles = 2;
    std::vector<std::uint16_t> indices{};  ///< empty: a draw without an index buffer
    models::Topology topology = models::Topology::kTriangleList;
    bool restarts = false;
    int indices_per_clk = 4, attributes_per_clk = 8;
    std::uint32_t slots = 8;
    std::vector<Timed<ReleaseToken>> releases{};
    std::vector<Timed<ReleaseToken>> second_engine{};  ///< its releases; empty: there is one engine
    int front_ends = 1, front_end = 0, range_primitives = 128;
    std::uint32_t instances = 1;
    Pace pace{};
  };
  FetchBench(Driver& driver, const contract::Variation& v, const Setup& s)
      : Bench(driver, v), batches(s.slots) {
    program.vertex_inputs.resize(3);
    const std::uint32_t vertices = 3 * s.triangles;
    DrawState draw;
    draw.vertex.program = &program;
    draw.count = s.indices.empty() ? 3 * s.triangles : static_cast<std::uint32_t>(s.indices.size());
    draw.topology = s.topology;
    draw.restarts = s.restarts;
    draw.primitives.assembled = models::assembled_kind(s.topology);
    AttributeFetch position;
    position.stride = 12;
    position.input_row = {0, 1, 2, -1};
    position.address = device.allocate(std::uint64_t{12} * vertices);
    for (std::uint32_t i = 0; i < vertices; ++i) {
      for (std::uint32_t c = 0; c < 3; ++c)
        device.store(position.address + 12 * i + 4 * c,
                     static_cast<float>(i) + 0.25F * static_cast<float>(c));
    }
    draw.attributes = {position};
    if (!s.indices.empty()) {
      draw.indexed = true;
      draw.index_address = device.allocate(2 * s.indices.size());
      for (std::size_t i = 0; i < s.indices.size(); ++i)
        device.store(draw.index_address + 2 * i, s.indices[i]);
    }
    draw.instances = s.instances;
    frame.draws = {draw};
    params.range_primitives.set(s.range_primitives);
    params.indices_per_clk.set(s.indices_per_clk);
    params.attributes_per_clk.set(s.attributes_per_clk);
    unit = std::make_unique<VertexFetch>(
        "unit",
        context({.partitions = 2, .engines = s.second_engine.empty() ? 1 : 2, .front_ends = s.front_ends},
                s.front_end),
        params, batches);
    add(*unit);
    feed(unit->draw_in, {{0, {TokenKind::kPassBegin, PassId(0)}},
                         {0, {TokenKind::kWork, DrawId(0)}},
                         {0, {TokenKind::kDrawEnd, DrawId(0)}}});
    feed(unit->release_in[0], s.releases);
    if (!s.second_engine.empty()) feed(unit->release_in[1], s.second_engine);
    memory = &serve(unit->memory_port(), kLatency);
    warps = &drain<VertexWarpToken>(unit->warp_out, [](const VertexWarpToken& t) { return t.slot; });
    sink = &drain<BatchToken>(
        unit->batch_out,
        [](const BatchToken& t) {
          return t.kind == TokenKind::kWork ? t.slot : 900u + static_cast<unsigned>(t.kind);
        },
        s.pace);
  }
  /// Cycles from the first batch that left to the last.
  [[nodiscard]] std::int64_t batch_cycles() const {
    std::int64_t first = -1, last = 0;
    for (const auto& [cycle, token] : sink->got) {
      if (token.kind != TokenKind::kWork) continue;
      if (first < 0) first = cycle;
      last = cycle;
    }
    return last - first;
  }
  models::Program program;
  Store<BatchSlot> batches;
  VertexFetch::Params params;
  std::unique_ptr<VertexFetch> unit;
  StubMemory* memory = nullptr;
  StubSink<VertexWarpToken>* warps = nullptr;
  StubSink<BatchToken>* sink = nullptr;
};

float input(const FetchBench& b, std::size_t slot, std::size_t row, std::size_t lane) {
  return std::bit_cast<float>(b.batches[slot].attributes[row][lane]);
}

}  // namespace

TEST_CASE(
    "vertex_fetch: a batch leaves when its last line is there, between the marks of its pass and its draw") {
  // Six vertices of 12 bytes: three sectors of one line. Two cycles of links, one each way of the memory,
  // come to its latency.
  const auto text = run<FetchBench>({}, [](const FetchBench& b) {
    std::string order;
    for (const auto& [cycle, token] : b.sink->got)
      order += fmt::format("{} ", token.kind == TokenKind::kWork ? "batch" : "mark");
    const std::int64_t waited = b.sink->got.at(1).cycle - b.memory->got.at(0).cycle;
    return fmt::format("{}after {} cycles, {} line with sectors {:x}", order, waited, b.memory->got.size(),
                       b.memory->got[0].token.sectors);
  });
  CHECK(text == fmt::format("mark batch mark after {} cycles, 1 line with sectors 7", kLatency + 2));
}

TEST_CASE("vertex_fetch: lanes hold the decoded attributes of their vertices, in the order of first use") {
  const FetchBench::Setup s{.triangles = 2, .indices = {5, 1, 3, 3, 1, 0}};
  const auto text = run<FetchBench>(s, [](const FetchBench& b) {
    std::string all = fmt::format("{} lanes:", b.batches[0].lanes);
    for (std::size_t lane = 0; lane < 4; ++lane)
      all += fmt::format(" {}/{}/{}", input(b, 0, 0, lane), input(b, 0, 1, lane), input(b, 0, 2, lane));
    for (const BatchSlot::Triangle& t : b.batches[0].triangles)
      all += fmt::format(" [{} {} {}]", t.corner[0].lane, t.corner[1].lane, t.corner[2].lane);
    return all;
  });
  CHECK(text == "4 lanes: 5/5.25/5.5 1/1.25/1.5 3/3.25/3.5 0/0.25/0.5 [0 1 2] [2 1 3]");
}

TEST_CASE("vertex_fetch: counters of a draw that shares corners") {
  const FetchBench::Setup s{.triangles = 2, .indices = {5, 1, 3, 3, 1, 0}};
  const auto text = run<FetchBench>(s, [](const FetchBench& b) {
    std::string all;
    for (const char* name : {"indices", "vertices", "attribute_fetches", "batches", "triangles"})
      all += fmt::format("{} {} ", name, counter(*b.unit, name));
    return all;
  });
  CHECK(text == "indices 6 vertices 4 attribute_fetches 4 batches 1 triangles 2 ");
}

TEST_CASE("vertex_fetch: points and lines fill a batch with 32 vertices of their own") {
  // 3000 vertices: of points and of lines that share none, 32 vertices a batch, but no more than 32
  // primitives.
  for (const auto& [topology, each, batches] :
       {std::tuple{models::Topology::kPointList, 1u, 94}, {models::Topology::kLineList, 2u, 94}}) {
    for (const auto& [indices, attributes, cycles] : {std::tuple{4, 8, 8}, {32, 8, 4}, {2, 64, 16}}) {
      const FetchBench::Setup s{.triangles = 1000,
                                .topology = topology,
                                .indices_per_clk = indices,
                                .attributes_per_clk = attributes,
                                .slots = 128,
                                .pace = {.period = 0}};
      const auto text = run<FetchBench>(s, [](const FetchBench& b) {
        return fmt::format("{} {} batches {} primitives {} indices {} vertices", b.batch_cycles(),
                           counter(*b.unit, "batches"), counter(*b.unit, "triangles"),
                           counter(*b.unit, "indices"), counter(*b.unit, "vertices"));
      });
      CHECK(std::stod(text) == Approx((batches - 1) * cycles).epsilon(0.02));
      CHECK(text.ends_with(
          fmt::format(" {} batches {} primitives 3000 indices 3000 vertices", batches, 3000 / each)));
    }
  }
}

TEST_CASE("vertex_fetch: a line strip names each inner vertex twice and shades it once") {
  const FetchBench::Setup s{
      .triangles = 4, .indices = {5, 1, 3, 0}, .topology = models::Topology::kLineStrip};
  const auto text = run<FetchBench>(s, [](const FetchBench& b) {
    std::string all = fmt::format("{} lanes, {} indices:", b.batches[0].lanes, counter(*b.unit, "indices"));
    for (const BatchSlot::Triangle& t : b.batches[0].triangles)
      all += fmt::format(" [{} {} {}]", t.corner[0].lane, t.corner[1].lane, t.corner[2].lane);
    return all;
  });
  CHECK(text == "4 lanes, 6 indices: [0 1 1] [1 2 2] [2 3 3]");
}

TEST_CASE("vertex_fetch: a special index ends a strip and costs a look-up") {
  const FetchBench::Setup s{.triangles = 4,
                            .indices = {0xffff, 0, 1, 2, 0xffff, 3, 4, 5, 6, 0xffff},
                            .topology = models::Topology::kTriangleStrip,
                            .restarts = true};
  const auto text = run<FetchBench>(s, [](const FetchBench& b) {
    std::string all = fmt::format("{} lanes, {} indices:", b.batches[0].lanes, counter(*b.unit, "indices"));
    for (const BatchSlot::Triangle& t : b.batches[0].triangles)
      all += fmt::format(" {}[{} {} {}]", t.primitive, t.corner[0].lane, t.corner[1].lane, t.corner[2].lane);
    return all;
  });
  CHECK(text == "7 lanes, 12 indices: 0[0 1 2] 1[3 4 5] 2[4 6 5]");
}

TEST_CASE("vertex_fetch: a batch of 30 vertices takes the slower of its indices and its attributes") {
  // Ten triangles that share nothing fill a batch of 32 lanes: 30 indices and 30 attributes. The triangle
  // that does not fit costs the next batch alone.
  for (const auto& [indices, attributes, cycles] :
       {std::tuple{4, 8, 8}, {32, 8, 4}, {32, 2, 15}, {1, 64, 30}}) {
    const FetchBench::Setup s{.triangles = 1000,
                              .indices_per_clk = indices,
                              .attributes_per_clk = attributes,
                              .slots = 128,
                              .pace = {.period = 0}};
    CAPTURE(indices, attributes);
    const auto text = run<FetchBench>(s, [](const FetchBench& b) {
      return fmt::format("{} {}", b.batch_cycles(), counter(*b.unit, "indices"));
    });
    CHECK(std::stod(text) == Approx(99 * cycles).epsilon(0.02));
    CHECK(text.ends_with(" 3000"));
  }
}

TEST_CASE("vertex_fetch: the rate of attributes moves nothing while the indices are slower") {
  const auto cycles = [](int attributes) {
    return run<FetchBench>(
        {.triangles = 100, .indices_per_clk = 1, .attributes_per_clk = attributes, .slots = 16},
        [](const FetchBench& b) { return fmt::format("{}", b.batch_cycles()); });
  };
  CHECK(cycles(2) == cycles(256));
}

TEST_CASE("vertex_fetch: a slot is free when every raster engine has given it back") {
  const FetchBench::Setup s{
      .triangles = 30, .slots = 2, .releases = {{500, {0}}}, .second_engine = {{800, {0}}}};
  const auto text = run<FetchBench>(s, [](const FetchBench& b) {
    std::string late;
    for (const auto& [cycle, token] : b.sink->got)
      late += token.kind == TokenKind::kWork ? (cycle < 800 ? "before " : "after ") : "";
    return late;
  });
  CHECK(text == "before before after ");
}

TEST_CASE("vertex_fetch: without a free slot the next batch waits for a release") {
  // Three batches of ten triangles and two slots: the third is formed when the first is given back.
  const FetchBench::Setup s{.triangles = 30, .slots = 2, .releases = {{500, {0}}}};
  const auto text = run<FetchBench>(s, [](const FetchBench& b) {
    std::string late;
    for (const auto& [cycle, token] : b.sink->got)
      late += token.kind == TokenKind::kWork ? (cycle < 500 ? "before " : "after ") : "";
    return late;
  });
  CHECK(text == "before before after ");
}

namespace {

/// Batches of a front end: its slot, and of each primitive the number; the marks that it sends.
std::string batches_of(int front_end, std::uint32_t triangles, std::uint32_t instances) {
  return run<FetchBench>({.triangles = triangles,
                          .slots = 16,
                          .front_ends = 2,
                          .front_end = front_end,
                          .range_primitives = 3,
                          .instances = instances},
                         [](const FetchBench& b) {
                           std::string text;
                           for (const auto& [cycle, token] : b.sink->got) {
                             if (token.kind != TokenKind::kWork) {
                               text += token.kind == TokenKind::kDrawEnd ? "end " : "begin ";
                               continue;
                             }
                             const BatchSlot& batch = b.batches[token.slot];
                             text += fmt::format("{}@{}[", batch.inputs.instance_index[0], token.slot / 8);
                             for (const BatchSlot::Triangle& t : batch.triangles)
                               text += fmt::format("{}", t.primitive);
                             text += batch.ends_range ? "> " : "] ";
                           }
                           return text;
                         });
}

}  // namespace

TEST_CASE("vertex_fetch: two front ends share each instance by ranges, and slots by halves") {
  CHECK(batches_of(0, 8, 1) == "begin 0@0[012> 0@0[67] end ");
  CHECK(batches_of(1, 8, 1) == "0@1[345> ");
  CHECK(batches_of(0, 4, 2) == "begin 0@0[012> 1@0[012> ");
  CHECK(batches_of(1, 4, 2) == "0@1[3> 1@1[3] end ");
}

TEST_CASE("vertex_fetch: the contract") {
  CHECK(contract_text<FetchBench>({.triangles = 100, .slots = 16, .pace = {.period = 3}}) == "");
  CHECK(contract_text<FetchBench>({.triangles = 2, .indices = {5, 1, 3, 3, 1, 0}}) == "");
}
