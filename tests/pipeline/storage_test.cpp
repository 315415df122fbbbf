/// Storage buffers in whole frames: buffers and pictures are those of the functional run on any machine,
/// early and late tests decide who writes, and races are named.
#include "models/base/error.h"
#include "pipeline/render.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/storage_stream.h"
#include "traces/trace_file.h"

#include <catch2/catch.hpp>

#include <cstring>
#include <numeric>

using namespace quadrille;
using namespace quadrille::pipeline;
using namespace quadrille::pipeline::test;

namespace {

std::vector<std::uint32_t> words_after(const traces::CommandStream& stream) {
  const RenderedFrame frame = render_functional_frame(stream, {});
  if (frame.buffers.empty()) return {};
  std::vector<std::uint32_t> words(frame.buffers[0].data.size() / 4);
  std::memcpy(words.data(), frame.buffers[0].data.data(), frame.buffers[0].data.size());
  return words;
}

std::uint64_t sum(const std::vector<std::uint32_t>& words) {
  return std::accumulate(words.begin(), words.end(), std::uint64_t{0});
}

/// Every fragment that is shaded adds one.
StorageShape counting(const std::string& qualifier) {
  StorageShape shape;
  shape.fragment_declarations =
      qualifier + " layout(std430, set = 0, binding = 0) buffer B { uint shaded[]; } b;";
  shape.fragment_body = "atomicAdd(b.shaded[uint(gl_FragCoord.y) * 88u + uint(gl_FragCoord.x)], 1u);";
  return shape;
}

/// The first draw stores where it is seen. The second one is the same again, so it is hidden everywhere; its
/// program reads what the first one stored: `early` after its test, else before it.
traces::CommandStream hidden_reads(bool early) {
  const std::string word = "b.shaded[uint(gl_FragCoord.y) * 88u + uint(gl_FragCoord.x)]";
  StorageShape storing = counting("layout(early_fragment_tests) in;");
  storing.fragment_body = word + " = 1u;";
  StorageShape reading = counting(early ? "layout(early_fragment_tests) in;" : "");
  reading.fragment_body = "o.r += float(" + word + ");" + (early ? "" : " if (o.r > 5.0) discard;");
  traces::CommandStream stream = storage_stream(5, storing);
  stream.pipelines.push_back(stream.pipelines[0]);
  stream.pipelines[1].fragment_shader = static_cast<traces::Index>(stream.shaders.size());
  stream.shaders.push_back(storage_stream(5, reading).shaders[1]);
  const traces::Command again = stream.commands[stream.commands.size() - 2];
  stream.commands.insert(stream.commands.end() - 1, {traces::BindPipeline{1}, again});
  traces::validate(stream);
  return stream;
}

void check_machines(const StorageShape& shape, std::uint64_t machines) {
  for (std::uint64_t seed = 1; seed <= machines; ++seed) {
    const traces::CommandStream stream = storage_stream(1 + seed / 3, shape);
    INFO("machine " << seed);
    CHECK(machine_faults(stream, seed) == "");
  }
}

}  // namespace

TEST_CASE("storage: thirty random machines leave the buffers and pictures of the functional rendering") {
  check_machines(kept_by_pixel(), 30);
}

TEST_CASE("storage: a vertex counts once, however often a machine runs it") {
  StorageShape shape;
  shape.vertex_declarations = "layout(std430, set = 0, binding = 0) buffer B { uint seen[]; } b;";
  shape.vertex_body = "atomicAdd(b.seen[vertex], 1u);";
  const std::vector<std::uint32_t> words = words_after(storage_stream(1, shape));
  for (std::size_t v = 0; v < 72; ++v) CHECK(words[v] == 1);
  CHECK(sum(words) == 72);
  check_machines(shape, 6);
}

TEST_CASE("storage: without forced early tests a hidden fragment writes memory, with them it does not") {
  StorageShape late = counting(""), early = counting("layout(early_fragment_tests) in;"),
               untested = counting("");
  untested.depth_test = false;
  const std::uint64_t covered = sum(words_after(storage_stream(2, untested)));
  CHECK(sum(words_after(storage_stream(2, late))) == covered);
  CHECK(sum(words_after(storage_stream(2, early))) < covered);
  check_machines(late, 9);
  check_machines(early, 9);
}

TEST_CASE("storage: early tests wait for earlier fragments that are still to be tested late") {
  // The first draw discards, so its depths are known late; the second counts behind it, tested early.
  StorageShape shape = counting("layout(early_fragment_tests) in;");
  traces::CommandStream stream = storage_stream(3, shape);
  StorageShape holes;
  holes.fragment_body = "if (fract(v_color.r * 5.0) < 0.3) discard;";
  const traces::CommandStream first = storage_stream(4, holes);
  const auto shader = static_cast<traces::Index>(stream.shaders.size());
  stream.shaders.push_back(first.shaders[1]);
  stream.pipelines.push_back(stream.pipelines[0]);
  stream.pipelines[1].fragment_shader = shader;
  traces::Draw draw;
  draw.count = 72;
  stream.commands.insert(stream.commands.end() - 2, {traces::BindPipeline{1}, draw, traces::BindPipeline{0}});
  traces::validate(stream);
  for (std::uint64_t seed = 0; seed <= 12; ++seed) {
    INFO("machine " << seed);
    CHECK(machine_faults(stream, seed) == "");
  }
}

TEST_CASE("storage: whether a hidden fragment's read meets a store does not depend on the machine") {
  for (const bool early : {true, false}) {
    const traces::CommandStream stream = hidden_reads(early);
    CHECK(refusal(stream).empty() == early);
    for (std::uint64_t seed = 0; seed <= 20; ++seed) {
      const hw::contract::Outcome outcome = hw::contract::run_forked(machine_builder(stream, seed), {});
      INFO("machine " << seed << ": " << outcome.failure);
      REQUIRE(outcome.failure.empty() == early);
      if (early) CHECK(outcome.digest == functional_digest(stream));
    }
  }
}

TEST_CASE("storage: a race within a pass is an error, on the machine too") {
  StorageShape shape;
  shape.fragment_declarations = "layout(std430, set = 0, binding = 0) buffer B { uint w[]; } b;";
  shape.fragment_body = "b.w[0] = uint(gl_FragCoord.x); o.r += float(b.w[0]);";
  const traces::CommandStream stream = storage_stream(1, shape);
  CHECK_THAT(refusal(stream),
             Catch::Contains("buffer 'words', byte 0") && Catch::Contains("separate passes"));
  CHECK_THAT(hw::contract::run_forked(machine_builder(stream, 0), {}).failure,
             Catch::Contains("buffer 'words', byte 0"));
}

TEST_CASE("storage: a written buffer is not read in another way, and a binding must be there") {
  traces::CommandStream stream = storage_stream(1, kept_by_pixel());
  for (traces::Command& c : stream.commands)
    if (auto* const bind = std::get_if<traces::BindVertexBuffer>(&c)) bind->buffer = 0;
  CHECK_THAT(refusal(stream), Catch::Contains("buffer 'words'") && Catch::Contains("a vertex buffer"));
  stream = storage_stream(1, kept_by_pixel());
  stream.pipelines[0].polygon_mode = traces::PolygonMode::kLine;
  CHECK_THAT(refusal(stream), Catch::Contains("by their edges or corners"));
  stream = storage_stream(1, kept_by_pixel());
  stream.descriptor_sets[0].buffers[0].binding = 1;
  CHECK_THAT(refusal(stream), Catch::Contains("no storage buffer is bound at set 0, binding 0"));
  stream.descriptor_sets[0].buffers[0].range = 1 << 20;
  CHECK_THROWS_WITH(traces::validate(stream), Catch::Contains("not within buffer 0"));
}

TEST_CASE("storage: programs whose outputs follow atomic operations are named") {
  StorageShape shape;
  shape.fragment_declarations = "layout(std430, set = 0, binding = 0) buffer B { uint n; } b;";
  shape.fragment_body = "o.r = float(atomicAdd(b.n, 1u));";
  CHECK(render_functional_frame(storage_stream(1, shape), {}).figures.order_dependent ==
        std::vector<std::string>{"storage"});
  CHECK(render_functional_frame(storage_stream(1, kept_by_pixel()), {}).figures.order_dependent.empty());
}

TEST_CASE("storage: a stream with storage buffers survives its trace file") {
  const traces::CommandStream stream = storage_stream(1, kept_by_pixel());
  CHECK(traces::decode_trace(traces::encode_trace(stream), "t") == stream);
}
