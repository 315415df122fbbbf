#include <catch2/catch.hpp>

#include "tests/traces/sample_stream.h"
#include "traces/trace_file.h"

using namespace quadrille::traces;

TEST_CASE("totals: triangles, lines and points by topology") {
  CommandStream stream = small_stream();
  const auto totals = [&](Topology topology) {
    for (Pipeline& pipeline : stream.pipelines) pipeline.topology = topology;
    return stream_totals(stream);
  };
  REQUIRE(totals(Topology::kTriangleList).triangles == 2);
  REQUIRE(totals(Topology::kTriangleStrip).triangles == 2);
  REQUIRE(totals(Topology::kPointList).points == 6);
  REQUIRE(totals(Topology::kLineList).lines == 2);
  REQUIRE(totals(Topology::kLineStrip).lines == 4);
  REQUIRE(totals(Topology::kLineStrip).triangles == 0);
  REQUIRE(trace_info(stream).find("lines           4") != std::string::npos);
}

TEST_CASE("totals: draws, instances and bytes are counted") {
  CommandStream stream = small_stream();
  std::get<Draw>(stream.commands[9]).instances = 5;
  const StreamTotals totals = stream_totals(stream);
  REQUIRE(totals.draws == 2);
  REQUIRE(totals.passes == 1);
  REQUIRE(totals.triangles == 6);
  REQUIRE(totals.vertices == 18);
  REQUIRE(totals.buffer_bytes == 36 + 3 + 64);
  REQUIRE(totals.image_bytes == 12);
  REQUIRE(trace_info(stream).find("triangles       6") != std::string::npos);
}

TEST_CASE("totals: queries are counted where a stream has some") {
  CommandStream stream = small_stream();
  REQUIRE(trace_info(stream).find("queries") == std::string::npos);
  query_everything(stream);
  REQUIRE(stream_totals(stream).queries == 3);
  REQUIRE(trace_info(stream).find("queries         3") != std::string::npos);
}

TEST_CASE("formats: bytes are components times component size") {
  REQUIRE(format_bytes(Format::kR16G16B16A16Unorm) == 8);
  REQUIRE(format_bytes(Format::kR8G8Unorm) == 2);
  REQUIRE(format_bytes(Format::kR32G32B32Float) == 12);
  REQUIRE(format_components(Format::kR32G32B32Float) == 3);
  REQUIRE(format_components(Format::kR8G8B8A8Snorm) == 4);
}
