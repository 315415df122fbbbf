/// Depth, stencil and depth bounds of a tile against their definitions, pixel by pixel; depths that formats
/// of integers can hold.
#include "models/rop/depth_stencil.h"

#include "models/memory/surface.h"
#include "tests/models/random_source.h"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

using namespace quadrille::models;

namespace {

constexpr Format kDepthFormats[] = {Format::kD16Unorm, Format::kD24UnormS8Uint, Format::kD32Float,
                                    Format::kD32FloatS8Uint};

bool holds(CompareOp op, double a, double b) {
  switch (op) {
    case CompareOp::kNever: return false;
    case CompareOp::kLess: return a < b;
    case CompareOp::kEqual: return a == b;
    case CompareOp::kLessOrEqual: return a <= b;
    case CompareOp::kGreater: return a > b;
    case CompareOp::kNotEqual: return a != b;
    case CompareOp::kGreaterOrEqual: return a >= b;
    case CompareOp::kAlways: return true;
  }
  return false;
}

StencilFace random_face(RandomSource& random) {
  const auto op = [&] { return static_cast<StencilOp>(random.integer(0, 7)); };
  const auto byte = [&] { return static_cast<std::uint8_t>(random.bits()); };
  return {static_cast<CompareOp>(random.integer(0, 7)),
          op(),
          op(),
          op(),
          static_cast<std::uint8_t>(random.integer(0, 1) != 0 ? 0xff : byte()),
          static_cast<std::uint8_t>(random.integer(0, 1) != 0 ? 0xff : byte()),
          static_cast<std::uint8_t>(random.integer(0, 7))};
}

/// By the tables of the specification. [VK1.3 #fragops-stencil]
int operated(StencilOp op, int stored, int reference) {
  switch (op) {
    case StencilOp::kKeep: return stored;
    case StencilOp::kZero: return 0;
    case StencilOp::kReplace: return reference;
    case StencilOp::kIncrementClamp: return std::min(stored + 1, 255);
    case StencilOp::kDecrementClamp: return std::max(stored - 1, 0);
    case StencilOp::kInvert: return ~stored & 255;
    case StencilOp::kIncrementWrap: return (stored + 1) & 255;
    case StencilOp::kDecrementWrap: return (stored - 1) & 255;
  }
  return 0;
}

}  // namespace

TEST_CASE("depth_stencil: every state gives each pixel what the order of the tests says") {
  RandomSource random(11);
  for (int round = 0; round < 4000; ++round) {
    const Format format = kDepthFormats[round % 4];
    DepthStencilState state;
    state.depth_test = random.integer(0, 3) != 0;
    state.depth_write = random.integer(0, 2) != 0;
    state.depth_compare = static_cast<CompareOp>(random.integer(0, 7));
    state.bounds = {random.integer(0, 2) == 0, 0.25f, 0.75f};
    state.stencil = {has_stencil(format) && random.integer(0, 3) != 0, random_face(random),
                     random_face(random)};
    const bool front = random.integer(0, 1) != 0;
    std::vector<std::byte> memory(std::size_t{64} * format_bytes(format));
    std::array<float, 64> before{}, incoming{};
    std::array<std::uint8_t, 64> stencil_before{};
    for (std::size_t i = 0; i < 64; ++i) {
      before[i] = round_depth(format, static_cast<float>(random.integer(0, 5)) * 0.2f);
      incoming[i] = round_depth(format, static_cast<float>(random.integer(0, 5)) * 0.2f);
      stencil_before[i] = static_cast<std::uint8_t>(has_stencil(format) ? random.integer(0, 7) : 0);
      const PixelCode code = encode_depth(format, before[i], stencil_before[i]);
      std::memcpy(memory.data() + i * format_bytes(format), code.word.data(), format_bytes(format));
    }
    const std::uint64_t mask = static_cast<std::uint64_t>(random.bits()) << 32 | random.bits();
    DepthPlane plane(format, memory.data());
    const DepthStencilOutcome outcome = test_depth_stencil(state, front, plane, incoming.data(), mask);
    write_depth_stencil(outcome, incoming.data(), plane);
    const DepthPlane after(format, memory.data());
    for (std::size_t i = 0; i < 64; ++i) {
      const StencilFace& face = state.face(front);
      bool alive = (mask >> i & 1) != 0;
      if (state.bounds.test) alive = alive && before[i] >= 0.25f && before[i] <= 0.75f;
      const bool within = alive;
      if (state.stencil.test)
        alive = alive && holds(face.compare, face.reference & face.compare_mask,
                               stencil_before[i] & face.compare_mask);
      const bool stencil_passed = alive;
      if (state.depth_test)
        alive = alive &&
                holds(state.depth_compare, static_cast<double>(incoming[i]), static_cast<double>(before[i]));
      int stencil = stencil_before[i];
      if (within && state.stencil.test) {
        const StencilOp op = !stencil_passed ? face.fail : alive ? face.pass : face.depth_fail;
        stencil = (stencil & ~face.write_mask) | (operated(op, stencil, face.reference) & face.write_mask);
      }
      const float depth = alive && state.depth_test && state.depth_write ? incoming[i] : before[i];
      INFO("round " << round << ", pixel " << i);
      REQUIRE((outcome.passed >> i & 1) == (alive ? 1u : 0u));
      REQUIRE(after.depths()[i] == depth);
      REQUIRE(after.stencil()[i] == stencil);
      if (!state.writes()) REQUIRE(outcome.written() == 0);
      if (!alive && within && state.keeps_when_hidden()) REQUIRE((outcome.written() >> i & 1) == 0);
    }
  }
}

TEST_CASE("depth_stencil: depths are the nearest that their format holds, and codes come back as they were") {
  RandomSource random(12);
  for (const Format format : {Format::kD16Unorm, Format::kD24UnormS8Uint}) {
    const double most = format == Format::kD16Unorm ? 65535 : 16777215;
    for (int round = 0; round < 200000; ++round) {
      const float z = random.real(0, 1);
      const double held = static_cast<double>(round_depth(format, z));
      if (std::abs(held - static_cast<double>(z)) > 0.5 / most * (1 + 1e-6)) FAIL("depth " << z);
      if (round_depth(format, static_cast<float>(held)) != static_cast<float>(held)) FAIL("code of " << z);
    }
    CHECK(round_depth(format, -1) == 0);
    CHECK(round_depth(format, 2) == 1);
    CHECK(round_depth(format, std::numeric_limits<float>::quiet_NaN()) == 0);
  }
  for (std::uint32_t code = 0xffff00; code <= 0xffffff; ++code) {  // the greatest are the nearest in floats
    const float z = decode_depth(Format::kD24UnormS8Uint, {{code}});
    CHECK((encode_depth(Format::kD24UnormS8Uint, z, 0).word[0] & 0xffffffu) == code);
  }
  CHECK(encode_depth(Format::kD24UnormS8Uint, 1, 0xab).word[0] == 0xabffffffu);
  CHECK(encode_depth(Format::kD32FloatS8Uint, 0.5f, 7) == PixelCode{{0x3f000000u, 7u, 0, 0}});
}
