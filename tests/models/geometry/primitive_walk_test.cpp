/// Walking a draw: primitives in order, and strips that a special index ends.
#include "models/geometry/primitive_walk.h"

#include <catch2/catch.hpp>

#include <vector>

using namespace quadrille::models;

namespace {

using Primitive = std::array<std::uint32_t, 3>;

struct Walked {
  std::vector<Primitive> primitives;
  std::vector<std::uint32_t> passed;
};

Walked walk(Topology topology, const std::vector<std::uint32_t>& indices, bool restarts) {
  Walked out;
  PrimitiveWalk walk;
  walk.start(topology, static_cast<std::uint32_t>(indices.size()), restarts);
  const auto ends = [&](std::uint32_t position) { return indices.at(position) == restart_index(2); };
  const auto passed = [&](std::uint32_t position) { out.passed.push_back(position); };
  for (; walk.look(ends, passed); walk.advance()) {
    CHECK(walk.primitive() == out.primitives.size());
    CHECK(walk.look(ends, passed));  // looking twice changes nothing
    out.primitives.push_back(walk.positions());
  }
  return out;
}

constexpr std::uint32_t kEnd = 0xffff;

}  // namespace

TEST_CASE("primitive_walk: the index of all ones") {
  CHECK(restart_index(1) == 0xffu);
  CHECK(restart_index(2) == 0xffffu);
  CHECK(restart_index(4) == 0xffffffffu);
}

TEST_CASE("primitive_walk: a strip is cut where the special index is, and keeps its winding after it") {
  const Walked walked = walk(Topology::kTriangleStrip, {0, 1, 2, 3, kEnd, 4, 5, 6, 7}, true);
  CHECK(walked.primitives == std::vector<Primitive>{{0, 1, 2}, {1, 3, 2}, {5, 6, 7}, {6, 8, 7}});
  CHECK(walked.passed == std::vector<std::uint32_t>{4});
}

TEST_CASE("primitive_walk: a fan turns around the first vertex after the special index") {
  const Walked walked = walk(Topology::kTriangleFan, {kEnd, 0, 1, 2, kEnd, kEnd, 3, 4, 5, 6, kEnd}, true);
  CHECK(walked.primitives == std::vector<Primitive>{{2, 3, 1}, {7, 8, 6}, {8, 9, 6}});
  CHECK(walked.passed == std::vector<std::uint32_t>{0, 4, 5, 10});
}

TEST_CASE("primitive_walk: what is too short between two special indices draws nothing") {
  CHECK(walk(Topology::kLineStrip, {0, kEnd, 1, 2, kEnd, 3}, true).primitives ==
        std::vector<Primitive>{{2, 3, 3}});
  CHECK(walk(Topology::kTriangleStrip, {kEnd, kEnd}, true).primitives.empty());
  CHECK(walk(Topology::kTriangleStrip, {}, true).primitives.empty());
}

TEST_CASE("primitive_walk: without restart the index is one like any other") {
  const Walked walked = walk(Topology::kLineStrip, {0, kEnd, 1}, false);
  CHECK(walked.primitives == std::vector<Primitive>{{0, 1, 1}, {1, 2, 2}});
  CHECK(walked.passed.empty());
}
