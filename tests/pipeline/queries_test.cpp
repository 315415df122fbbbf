/// Queries: what they count is what the functional run counts, on every machine, and adds up to what the
/// units counted.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstring>

#include "pipeline/render.h"
#include "pipeline/report/report.h"
#include "scenes/material/glsl.h"
#include "tests/hw/contract.h"
#include "tests/pipeline/passes_stream.h"
#include "tests/pipeline/random_machine.h"
#include "tests/pipeline/random_stream.h"
#include "tests/pipeline/states_stream.h"
#include "traces/trace_file.h"

using namespace quadrille;
using namespace quadrille::pipeline;
using namespace quadrille::pipeline::test;

namespace {

traces::CommandStream queried(traces::CommandStream stream) {
  traces::query_everything(stream);
  traces::validate(stream);
  return stream;
}

/// Values of the occlusion queries, in their order.
std::string samples_of(const Figures& figures) {
  std::string text;
  for (const QueryFigures& q : figures.queries)
    if (q.range.type == traces::QueryType::kOcclusion)
      text += fmt::format("{} ", q.values.at(0).value.value());
  return text;
}

std::string functional_samples(const traces::CommandStream& stream) {
  return samples_of(render_functional_frame(stream, {}).figures);
}

/// The same of a random machine (0: the default one), with the laws that do not hold.
std::string machine_samples(const traces::CommandStream& stream, std::uint64_t seed) {
  return hw::contract::in_child([&] {
    MachineConfig config;
    if (seed != 0) randomize(config, seed);
    const Figures figures = render_exact(stream, config).figures;
    return samples_of(figures) + failed_checks(figures);
  });
}

std::uint64_t counted(const Figures& figures, std::string_view kind, std::string_view counter) {
  std::uint64_t sum = 0;
  for (const UnitFigures& unit : figures.units)
    if (without_number(unit.path) == kind)
      for (const CounterFigure& c : unit.counters) sum += c.name == counter ? c.value : 0;
  return sum;
}

/// Sum of the values of that name over all queries.
std::uint64_t asked(const Figures& figures, std::string_view name) {
  std::uint64_t sum = 0;
  for (const QueryFigures& q : figures.queries)
    for (const QueryValue& v : q.values) sum += v.name == name ? v.value.value() : 0;
  return sum;
}

traces::CommandStream stream_of(std::uint64_t seed) {
  switch (seed % 4) {
    case 0: return states_stream(seed, 56, 40, {.samples = 4});
    case 1: return states_stream(seed, 56, 40);
    case 2: return passes_stream(seed, 56, 40);
    default: return random_stream(seed, {.width = 56, .height = 40});
  }
}

constexpr const char* kVertex = R"(#version 450
layout(push_constant) uniform Push { float depth; };
void main() {
  gl_Position = vec4(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0, depth, 1.0);
})";
/// Waits for its shading to be tested.
constexpr const char* kLate = R"(#version 450
layout(location = 0) out vec4 o;
void main() { if ((int(gl_FragCoord.x) & 1) == 0) discard; o = vec4(1); })";
/// Is tested before, and then discards every second row: of what has passed, and of what has not.
constexpr const char* kEarly = R"(#version 450
layout(early_fragment_tests) in;
layout(location = 0) out vec4 o;
void main() { if ((int(gl_FragCoord.y) & 1) == 0) discard; o = vec4(1); })";
constexpr const char* kOnlyDepth = R"(#version 450
void main() {})";

/// Triangles over a screen of 32x24, each in a query of its own.
class Layers {
 public:
  explicit Layers(std::uint32_t samples = 1) {
    stream_.name = "layers";
    shader(kVertex, traces::ShaderStage::kVertex);
    for (const char* text : {kLate, kEarly, kOnlyDepth}) shader(text, traces::ShaderStage::kFragment);
    stream_.commands.push_back(traces::make_pass(stream_, {32, 24}));
    if (samples > 1) traces::use_samples(stream_, samples);
    stream_.commands.push_back(traces::SetViewport{0, 0, 32, 24, 0, 1});
    stream_.commands.push_back(traces::SetScissor{0, 0, 32, 24});
    stream_.query_pools.push_back({"layers", traces::QueryType::kOcclusion, 0, 100});
  }
  traces::Pipeline& pipeline(traces::Index fragment) {
    traces::Pipeline p;
    p.vertex_shader = 0;
    p.fragment_shader = fragment;
    p.depth = {true, false, traces::CompareOp::kLess};
    stream_.pipelines.push_back(p);
    return stream_.pipelines.back();
  }
  void draw(float depth) {
    traces::Draw triangle;
    triangle.count = 3;
    std::vector<std::byte> push(4);
    std::memcpy(push.data(), &depth, 4);
    add(traces::BindPipeline{static_cast<traces::Index>(stream_.pipelines.size() - 1)});
    add(traces::PushConstants{0, push});
    add(traces::BeginQuery{0, query_, precise_});
    add(triangle);
    add(traces::EndQuery{0, query_++});
  }
  void boolean() { precise_ = false; }
  void add(traces::Command command) { stream_.commands.push_back(std::move(command)); }
  traces::CommandStream done() {
    add(traces::EndPass{});
    traces::validate(stream_);
    return stream_;
  }

 private:
  void shader(const char* text, traces::ShaderStage stage) {
    stream_.shaders.push_back({"layers", stage, scenes::compile_glsl(text, stage, "layers")});
  }
  traces::CommandStream stream_;
  std::uint32_t query_ = 0;
  bool precise_ = true;
};

}  // namespace

TEST_CASE("queries: forty random machines count the samples of the functional run, draw by draw", "[slow]") {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const traces::CommandStream stream = queried(stream_of(seed));
    INFO("machine " << seed);
    CHECK(machine_samples(stream, seed) == functional_samples(stream));
  }
}

TEST_CASE("queries: over all draws and passes they add up to the counters of the units") {
  for (const std::uint64_t seed : {3U, 6U, 7U, 11U}) {  // without programs that force early tests
    const traces::CommandStream stream = queried(stream_of(seed));
    const std::string wrong = hw::contract::in_child([&] {
      const Figures f = render_exact(stream, MachineConfig()).figures;
      std::string text = failed_checks(f);
      const auto compare = [&](std::string_view name, std::uint64_t units) {
        if (asked(f, name) != units || units == 0)
          text += fmt::format("{}: {}, units {}\n", name, asked(f, name), units);
      };
      compare("samples_passed", counted(f, "rop", "samples_written"));
      compare("input_assembly_vertices", counted(f, "vertex_fetch", "indices"));
      compare("input_assembly_primitives", counted(f, "vertex_fetch", "triangles"));
      compare("vertex_shader_invocations", counted(f, "core", "vertices"));
      compare("clipping_invocations", counted(f, "clipper", "triangles"));
      compare("clipping_primitives", counted(f, "clipper", "passed") + counted(f, "clipper", "pieces"));
      compare("fragment_shader_invocations", counted(f, "core", "fragments"));
      return text;
    });
    INFO("stream " << seed);
    CHECK(wrong.empty());
  }
}

TEST_CASE("queries: they change neither the picture nor the cycles") {
  const auto outcome = [](const traces::CommandStream& stream) {
    return hw::contract::in_child([&] {
      const RenderedFrame frame = render_exact(stream, MachineConfig());
      std::string text = fmt::format("{} ", frame.figures.frame.cycles);
      for (const std::uint32_t pixel : frame.image.color) text += fmt::format("{:x} ", pixel);
      return text;
    });
  };
  for (const std::uint64_t seed : {3U, 6U})
    CHECK(outcome(stream_of(seed)) == outcome(queried(stream_of(seed))));
}

TEST_CASE("queries: draws of depth alone count, hidden and discarded samples do not") {
  for (const std::uint32_t samples : {1U, 4U}) {
    Layers layers(samples);
    const std::uint32_t all = 32 * 24 * samples;
    layers.pipeline(3).depth.write = true;
    layers.draw(0.5f);   // all of it
    layers.draw(0.75f);  // hidden
    layers.pipeline(1);
    layers.draw(0.25f);  // every second column is discarded
    layers.pipeline(3).blend[0].write_mask = 0;
    layers.draw(0.25f);  // a mask of colours takes nothing away
    layers.pipeline(3).sample_mask = 1;
    layers.draw(0.25f);  // a mask of samples does
    const traces::CommandStream stream = layers.done();
    const std::string expected =
        fmt::format("{} 0 {} {} {} ", all, all / 2, all, samples == 1 ? all : all / 4);
    CHECK(functional_samples(stream) == expected);
    CHECK(machine_samples(stream, 0) == expected);
  }
}

TEST_CASE("queries: a program that forces early tests is counted before it discards, behind late draws too") {
  for (const std::uint32_t samples : {1U, 4U}) {
    Layers layers(samples);
    const std::uint32_t all = 32 * 24 * samples;
    layers.pipeline(1).depth.write = true;
    layers.draw(0.5f);  // tested late: what follows in its tiles would be too
    layers.pipeline(2);
    layers.draw(0.75f);  // hidden in every second column, discarded in every second row
    layers.draw(0.25f);
    layers.pipeline(2).depth.test = false;
    layers.draw(0.75f);
    const traces::CommandStream stream = layers.done();
    const std::string expected = fmt::format("{} {} {} {} ", all / 2, all / 2, all, all);
    CHECK(functional_samples(stream) == expected);
    for (std::uint64_t seed = 0; seed <= 12; ++seed) {
      INFO("machine " << seed);
      CHECK(machine_samples(stream, seed) == expected);
    }
  }
}

TEST_CASE("queries: around nothing they are 0, and those that are not precise say whether a sample passed") {
  Layers layers;
  layers.add(traces::BeginQuery{0, 50, true});
  layers.add(traces::EndQuery{0, 50});
  layers.pipeline(3).depth.write = true;
  layers.boolean();
  layers.draw(0.5f);
  layers.draw(0.5f);
  const traces::CommandStream stream = layers.done();
  CHECK(functional_samples(stream) == "0 1 0 ");
  CHECK(machine_samples(stream, 0) == "0 1 0 ");
  CHECK(traces::decode_trace(traces::encode_trace(stream), "t") == stream);
}

TEST_CASE("queries: JSON and table show them, statistics of a functional run are null") {
  const traces::CommandStream stream = queried(stream_of(3));
  const RenderedFrame frame = render_functional_frame(stream, {});
  const std::string json = report_json({frame.figures, MachineConfig(), 56, 40});
  CHECK(json.find("\"queries\": [") != std::string::npos);
  CHECK(json.find("\"samples_passed\": ") != std::string::npos);
  CHECK(json.find("\"clipping_primitives\": null") != std::string::npos);
  const std::string table = report_table({frame.figures, MachineConfig(), 56, 40});
  CHECK(table.find("QUERIES") != std::string::npos);
  const RenderedFrame without = render_functional_frame(stream_of(3), {});
  CHECK(report_json({without.figures, MachineConfig(), 56, 40}).find("queries") == std::string::npos);
}
