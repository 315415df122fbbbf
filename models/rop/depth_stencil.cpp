#include "models/rop/depth_stencil.h"

#include "models/rop/depth.h"

#include <bit>

namespace quadrille::models {
namespace {

bool compares(CompareOp op, std::uint8_t a, std::uint8_t b) {
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

/// Calls `visit(i)` for each bit of the mask.
template <class Visit>
void for_each(std::uint64_t mask, const Visit& visit) {
  for (; mask != 0; mask &= mask - 1) visit(static_cast<std::size_t>(std::countr_zero(mask)));
}

std::uint64_t within_bounds(const DepthBoundsTest& bounds, const float stored[64], std::uint64_t mask) {
  std::uint64_t within = 0;
  for_each(mask, [&](std::size_t i) {
    if (stored[i] >= bounds.least && stored[i] <= bounds.most) within |= std::uint64_t{1} << i;
  });
  return within;
}

std::uint64_t stencil_passes(const StencilFace& face, const std::array<std::uint8_t, 64>& stored,
                             std::uint64_t mask) {
  std::uint64_t passed = 0;
  const auto reference = static_cast<std::uint8_t>(face.reference & face.compare_mask);
  for_each(mask, [&](std::size_t i) {
    if (compares(face.compare, reference, static_cast<std::uint8_t>(stored[i] & face.compare_mask)))
      passed |= std::uint64_t{1} << i;
  });
  return passed;
}

/// Notes the new values of these pixels.
void operate(const StencilFace& face, StencilOp op, const std::array<std::uint8_t, 64>& stored,
             std::uint64_t pixels, DepthStencilOutcome& outcome) {
  if (op == StencilOp::kKeep || face.write_mask == 0) return;
  outcome.stencil_written |= pixels;
  for_each(pixels, [&](std::size_t i) {
    const std::uint8_t value = stencil_value(op, stored[i], face.reference);
    outcome.stencil[i] =
        static_cast<std::uint8_t>((stored[i] & ~face.write_mask) | (value & face.write_mask));
  });
}

}  // namespace

std::uint8_t stencil_value(StencilOp op, std::uint8_t stored, std::uint8_t reference) {
  switch (op) {
    case StencilOp::kKeep: return stored;
    case StencilOp::kZero: return 0;
    case StencilOp::kReplace: return reference;
    case StencilOp::kIncrementClamp: return stored == 255 ? stored : static_cast<std::uint8_t>(stored + 1);
    case StencilOp::kDecrementClamp: return stored == 0 ? stored : static_cast<std::uint8_t>(stored - 1);
    case StencilOp::kInvert: return static_cast<std::uint8_t>(~stored);
    case StencilOp::kIncrementWrap: return static_cast<std::uint8_t>(stored + 1);
    case StencilOp::kDecrementWrap: return static_cast<std::uint8_t>(stored - 1);
  }
  return stored;
}

DepthStencilOutcome test_depth_stencil(const DepthStencilState& state, bool front, const DepthPlane& stored,
                                       const float incoming[64], std::uint64_t mask) {
  DepthStencilOutcome outcome;
  if (state.bounds.test) mask = within_bounds(state.bounds, stored.depths(), mask);
  const std::uint64_t stencil_passed =
      state.stencil.test ? stencil_passes(state.face(front), stored.stencil(), mask) : mask;
  outcome.passed = state.depth_test
                       ? depth_test(state.depth_compare, stored.depths(), incoming, stencil_passed)
                       : stencil_passed;
  if (state.depth_test && state.depth_write) outcome.depth_written = outcome.passed;
  if (state.stencil.test) {
    const StencilFace& face = state.face(front);
    operate(face, face.fail, stored.stencil(), mask & ~stencil_passed, outcome);
    operate(face, face.depth_fail, stored.stencil(), stencil_passed & ~outcome.passed, outcome);
    operate(face, face.pass, stored.stencil(), outcome.passed, outcome);
  }
  return outcome;
}

void write_depth_stencil(const DepthStencilOutcome& outcome, const float incoming[64], DepthPlane& stored) {
  if (outcome.depth_written != 0) stored.write_depths(incoming, outcome.depth_written);
  if (outcome.stencil_written != 0) stored.write_stencil(outcome.stencil, outcome.stencil_written);
}

}  // namespace quadrille::models
