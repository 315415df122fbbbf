#include "models/geometry/assembly.h"

#include <catch2/catch.hpp>

using namespace quadrille::models;

namespace {

using Triangle = std::array<std::uint32_t, 3>;

}  // namespace

TEST_CASE("assembly: vertices come in the order of the specification") {
  CHECK(primitive_vertices(Topology::kTriangleList, 2) == Triangle{6, 7, 8});
  CHECK(primitive_vertices(Topology::kTriangleStrip, 0) == Triangle{0, 1, 2});
  CHECK(primitive_vertices(Topology::kTriangleStrip, 1) == Triangle{1, 3, 2});
  CHECK(primitive_vertices(Topology::kTriangleStrip, 4) == Triangle{4, 5, 6});
  CHECK(primitive_vertices(Topology::kTriangleFan, 0) == Triangle{1, 2, 0});
  CHECK(primitive_vertices(Topology::kTriangleFan, 3) == Triangle{4, 5, 0});
  CHECK(primitive_vertices(Topology::kPointList, 3) == Triangle{3, 3, 3});
  CHECK(primitive_vertices(Topology::kLineList, 3) == Triangle{6, 7, 7});
  CHECK(primitive_vertices(Topology::kLineStrip, 3) == Triangle{3, 4, 4});
}

TEST_CASE("assembly: left-over vertices form no triangle") {
  for (std::uint32_t n = 0; n < 3; ++n) {
    for (const Topology t : {Topology::kTriangleList, Topology::kTriangleStrip, Topology::kTriangleFan})
      CHECK(primitive_count(t, n) == 0);
  }
  CHECK(primitive_count(Topology::kTriangleList, 8) == 2);
  CHECK(primitive_count(Topology::kTriangleStrip, 8) == 6);
  CHECK(primitive_count(Topology::kTriangleFan, 8) == 6);
  CHECK(primitive_count(Topology::kPointList, 8) == 8);
  CHECK(primitive_count(Topology::kLineList, 7) == 3);
  CHECK(primitive_count(Topology::kLineStrip, 7) == 6);
  CHECK(primitive_count(Topology::kLineStrip, 1) == 0);
  CHECK(primitive_count(Topology::kLineStrip, 0) == 0);
}

TEST_CASE("assembly: a strip keeps its winding and shares each inner edge in opposite directions") {
  for (std::uint32_t i = 0; i + 1 < 20; ++i) {
    const Triangle a = primitive_vertices(Topology::kTriangleStrip, i),
                   b = primitive_vertices(Topology::kTriangleStrip, i + 1);
    int shared = 0;
    for (std::size_t e = 0; e < 3; ++e) {
      for (std::size_t f = 0; f < 3; ++f) {
        if (a[e] == b[(f + 1) % 3] && a[(e + 1) % 3] == b[f]) ++shared;
      }
    }
    CHECK(shared == 1);
    CHECK(a[0] == i);  // provoking vertex
  }
}
