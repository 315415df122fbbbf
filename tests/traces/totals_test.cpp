#include <catch2/catch.hpp>

#include "tests/traces/sample_stream.h"
#include "traces/trace_file.h"

using namespace quadrille::traces;

TEST_CASE("totals: triangles by topology") {
  REQUIRE(triangle_count(Topology::kTriangleList, 8) == 2);
  REQUIRE(triangle_count(Topology::kTriangleStrip, 8) == 6);
  REQUIRE(triangle_count(Topology::kTriangleFan, 3) == 1);
  REQUIRE(triangle_count(Topology::kTriangleStrip, 2) == 0);
  REQUIRE(triangle_count(Topology::kTriangleList, 0) == 0);
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

TEST_CASE("formats: bytes are components times component size") {
  REQUIRE(format_bytes(Format::kR16G16B16A16Unorm) == 8);
  REQUIRE(format_bytes(Format::kR8G8Unorm) == 2);
  REQUIRE(format_bytes(Format::kR32G32B32Float) == 12);
  REQUIRE(format_components(Format::kR32G32B32Float) == 3);
  REQUIRE(format_components(Format::kR8G8B8A8Snorm) == 4);
}
