/// Primitives whose last vertex comes first.
#include <catch2/catch.hpp>

#include <cstring>

#include "models/base/error.h"
#include "traces/capture/provoking.h"

namespace quadrille::capture {
namespace {

using traces::Topology;
using Vertices = std::vector<std::optional<std::uint32_t>>;
using Indices = std::vector<std::uint32_t>;

/// Is (d, e, f) a rotation of (a, b, c), so that the winding is the same?
bool same_winding(const Indices& a, std::size_t at, const Indices& b) {
  for (std::size_t turn = 0; turn < 3; ++turn)
    if (a[at] == b[turn] && a[at + 1] == b[(turn + 1) % 3] && a[at + 2] == b[(turn + 2) % 3]) return true;
  return false;
}

}  // namespace

TEST_CASE("provoking: each triangle of a list begins with its last vertex and keeps its winding") {
  const Indices turned = turned_indices(Topology::kTriangleList, Vertices{5, 6, 7, 9, 8, 4, 3});
  CHECK(turned == Indices{7, 5, 6, 4, 9, 8});
}

TEST_CASE("provoking: triangles of a strip keep the winding that Vulkan gives them") {
  const Indices turned = turned_indices(Topology::kTriangleStrip, Vertices{0, 1, 2, 3, 4});
  REQUIRE(turned.size() == 9);
  for (std::uint32_t i = 0; i < 3; ++i) {
    CHECK(turned[3 * i] == i + 2);
    const Indices plain = i % 2 == 0 ? Indices{i, i + 1, i + 2} : Indices{i + 1, i, i + 2};
    CHECK(same_winding(turned, 3 * i, plain));
  }
}

TEST_CASE("provoking: triangles of a fan begin with the newest vertex") {
  const Indices turned = turned_indices(Topology::kTriangleFan, Vertices{0, 1, 2, 3});
  CHECK(turned == Indices{2, 0, 1, 3, 0, 2});
}

TEST_CASE("provoking: the end of a strip begins another, with even triangles first") {
  const Indices turned = turned_indices(Topology::kTriangleStrip, Vertices{0, 1, 2, std::nullopt, 4, 5, 6});
  CHECK(turned == Indices{2, 0, 1, 6, 4, 5});
  CHECK(turned_indices(Topology::kLineStrip, Vertices{0, 1, std::nullopt, 3, 4, 5}) ==
        Indices{1, 0, 4, 3, 5, 4});
}

TEST_CASE("provoking: indices are read at their width, and those of all ones end strips if they may") {
  const std::uint16_t words[] = {9, 8, 0xffff, 7};
  const std::span<const std::byte> bytes = std::as_bytes(std::span(words));
  CHECK(read_indices(bytes, 2, traces::IndexType::kUint16, 0, 3, true) == Vertices{8, std::nullopt, 7});
  CHECK(read_indices(bytes, 0, traces::IndexType::kUint16, 1, 2, false) == Vertices{8, 0xffff});
  CHECK_THROWS_AS(read_indices(bytes, 0, traces::IndexType::kUint16, 1, 4, false), UserError);
}

}  // namespace quadrille::capture
