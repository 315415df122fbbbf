#include "models/rop/depth.h"

#include "tests/models/random_source.h"

#include <catch2/catch.hpp>

#include <limits>

using namespace quadrille::models;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

bool holds(CompareOp op, float incoming, float stored) {
  switch (op) {
    case CompareOp::kNever: return false;
    case CompareOp::kLess: return incoming < stored;
    case CompareOp::kEqual: return incoming == stored;
    case CompareOp::kLessOrEqual: return incoming <= stored;
    case CompareOp::kGreater: return incoming > stored;
    case CompareOp::kNotEqual: return incoming != stored;
    case CompareOp::kGreaterOrEqual: return incoming >= stored;
    case CompareOp::kAlways: return true;
  }
  return false;
}

}  // namespace

TEST_CASE("depth: tests and writes each pixel of the mask by the operation") {
  RandomSource random(71);
  for (int round = 0; round < 2000; ++round) {
    const auto op = static_cast<CompareOp>(round % 8);
    float stored[64], incoming[64];
    for (int i = 0; i < 64; ++i) {
      stored[i] = static_cast<float>(random.integer(0, 4)) * 0.25f;
      incoming[i] = random.integer(0, 20) == 0 ? kNan : static_cast<float>(random.integer(0, 4)) * 0.25f;
    }
    const std::uint64_t mask = static_cast<std::uint64_t>(random.bits()) << 32 | random.bits();
    const std::uint64_t passed = depth_test(op, stored, incoming, mask);
    for (int i = 0; i < 64; ++i) {
      const bool expected = (mask >> i & 1) != 0 && holds(op, incoming[i], stored[i]);
      if (((passed >> i & 1) != 0) != expected) FAIL("operation " << static_cast<int>(op) << " pixel " << i);
    }
    float written[64];
    std::copy(stored, stored + 64, written);
    depth_write(written, incoming, passed);
    for (int i = 0; i < 64; ++i) {
      const float expected = (passed >> i & 1) != 0 ? incoming[i] : stored[i];
      if (!(written[i] == expected || (expected != expected && written[i] != written[i])))
        FAIL("pixel " << i << " was not written as it should be");
    }
  }
  SUCCEED();
}

TEST_CASE("depth: the bound of a tile stays conservative with NaN") {
  float depths[64];
  for (int i = 0; i < 64; ++i) depths[i] = 0.25f + static_cast<float>((i * 37) % 64) / 128.0f;
  CHECK(tile_max(depths) == 0.25f + 63.0f / 128.0f);
  depths[17] = kNan;
  CHECK(tile_max(depths) == kInf);
}
