/// Depth comparison, blending and conversion against closed forms.
#include "models/reference/output.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace quadrille;
using namespace quadrille::models::reference;
using quadrille::models::PixelCode;

namespace {

constexpr traces::Format kUnorm = traces::Format::kR8G8B8A8Unorm, kSrgb = traces::Format::kR8G8B8A8Srgb;
int channel(const StoredColor& c, int i) { return static_cast<int>((c.code.word[0] >> (8 * i)) & 0xffu); }

}  // namespace

TEST_CASE("output: the eight depth comparisons") {
  using traces::CompareOp;
  const auto outcome = [](CompareOp op) {
    return std::array<bool, 3>{depth_passes(op, 0.25, 0.5), depth_passes(op, 0.5, 0.5),
                               depth_passes(op, 0.75, 0.5)};
  };
  CHECK(outcome(CompareOp::kNever) == std::array<bool, 3>{false, false, false});
  CHECK(outcome(CompareOp::kLess) == std::array<bool, 3>{true, false, false});
  CHECK(outcome(CompareOp::kEqual) == std::array<bool, 3>{false, true, false});
  CHECK(outcome(CompareOp::kLessOrEqual) == std::array<bool, 3>{true, true, false});
  CHECK(outcome(CompareOp::kGreater) == std::array<bool, 3>{false, false, true});
  CHECK(outcome(CompareOp::kNotEqual) == std::array<bool, 3>{true, false, true});
  CHECK(outcome(CompareOp::kGreaterOrEqual) == std::array<bool, 3>{false, true, true});
  CHECK(outcome(CompareOp::kAlways) == std::array<bool, 3>{true, true, true});
  CHECK_FALSE(depth_passes(CompareOp::kLessOrEqual, std::numeric_limits<double>::quiet_NaN(), 0.5));
}

TEST_CASE("output: depth distance is in float units of the last place") {
  CHECK(float_ulps(0.5, 0.5) == 0);
  CHECK(float_ulps(0.75, 0.75 + 0x1p-24) == Approx(1));
  CHECK(float_ulps(0.25, 0.25 - 3 * 0x1p-25) == Approx(3));
}

TEST_CASE("output: a stored colour rounds to nearest, ties to even, and clamps") {
  CHECK(channel(store_color(kUnorm, {0.5 / 255, 1.5 / 255, 2.5 / 255, 0.49999 / 255}), 0) == 0);
  CHECK(channel(store_color(kUnorm, {0.5 / 255, 1.5 / 255, 2.5 / 255, 0.49999 / 255}), 1) == 2);
  CHECK(store_color(kUnorm, {-1, 2, std::numeric_limits<double>::quiet_NaN(), 1}).code.word[0] ==
        0xff00ff00u);
}

TEST_CASE("output: an sRGB target encodes colour and leaves alpha linear") {
  const StoredColor c = store_color(kSrgb, {0.5, 0.001, 1, 0.5});
  CHECK(channel(c, 0) == 188);
  CHECK(channel(c, 1) == std::lround(0.001 * 12.92 * 255));
  CHECK(channel(c, 2) == 255);
  CHECK(channel(c, 3) == 128);
}

TEST_CASE("output: every sRGB value survives being read and written back") {
  for (std::uint32_t v = 0; v < 256; ++v) {
    traces::BlendState keep;
    keep.enable = true, keep.src_color = keep.src_alpha = traces::BlendFactor::kZero,
    keep.dst_color = keep.dst_alpha = traces::BlendFactor::kOne;
    const PixelCode code{{v * 0x01010101u}};
    CHECK(blend(keep, {}, kSrgb, {1, 1, 1, 1}, {}, {code, {}}).code == code);
  }
}

TEST_CASE("output: alpha blending in linear values, then encoded") {
  traces::BlendState over;
  over.enable = true;
  over.src_color = traces::BlendFactor::kSrcAlpha, over.dst_color = traces::BlendFactor::kOneMinusSrcAlpha;
  over.src_alpha = traces::BlendFactor::kOne, over.dst_alpha = traces::BlendFactor::kOneMinusSrcAlpha;
  const StoredColor white = store_color(kSrgb, {1, 1, 1, 1});
  const StoredColor out = blend(over, {}, kSrgb, {0, 0.5, 1, 0.75}, {}, white);
  CHECK(out.linear[0] == Approx(0.25));
  CHECK(out.linear[1] == Approx(0.625));
  CHECK(out.linear[3] == Approx(1));
  CHECK(channel(out, 0) == std::lround((1.055 * std::pow(0.25, 1 / 2.4) - 0.055) * 255));
}

TEST_CASE("output: every blend factor and operation") {
  using traces::BlendFactor, traces::BlendOp;
  const std::array<double, 4> source{0.2, 0.4, 0.6, 0.8};
  const std::array<double, 4> second{0.3, 0.1, 0.9, 0.7};
  const traces::BlendShared shared{{0.5F, 0.25F, 0.75F, 0.125F}, false, traces::LogicOp::kCopy};
  const StoredColor before = store_color(kUnorm, {51.0 / 255, 102.0 / 255, 153.0 / 255, 204.0 / 255});
  const auto red = [&](BlendFactor src, BlendFactor dst, BlendOp op) {
    traces::BlendState state;
    state.enable = true, state.src_color = src, state.dst_color = dst, state.color = op;
    return blend(state, shared, kUnorm, source, second, before).linear[0];
  };
  const double s = 0.2, d = 51.0 / 255, sa = 0.8, da = 204.0 / 255;
  CHECK(red(BlendFactor::kOne, BlendFactor::kOne, BlendOp::kAdd) == Approx(s + d));
  CHECK(red(BlendFactor::kSrcAlpha, BlendFactor::kZero, BlendOp::kAdd) == Approx(s * sa));
  CHECK(red(BlendFactor::kOneMinusSrcAlpha, BlendFactor::kZero, BlendOp::kAdd) == Approx(s * (1 - sa)));
  CHECK(red(BlendFactor::kDstAlpha, BlendFactor::kZero, BlendOp::kAdd) == Approx(s * da));
  CHECK(red(BlendFactor::kOneMinusDstAlpha, BlendFactor::kZero, BlendOp::kAdd) == Approx(s * (1 - da)));
  CHECK(red(BlendFactor::kZero, BlendFactor::kSrcColor, BlendOp::kAdd) == Approx(d * s));
  CHECK(red(BlendFactor::kZero, BlendFactor::kOneMinusSrcColor, BlendOp::kAdd) == Approx(d * (1 - s)));
  CHECK(red(BlendFactor::kDstColor, BlendFactor::kZero, BlendOp::kAdd) == Approx(s * d));
  CHECK(red(BlendFactor::kOneMinusDstColor, BlendFactor::kZero, BlendOp::kAdd) == Approx(s * (1 - d)));
  CHECK(red(BlendFactor::kConstantColor, BlendFactor::kZero, BlendOp::kAdd) == Approx(s * 0.5));
  CHECK(red(BlendFactor::kOneMinusConstantColor, BlendFactor::kZero, BlendOp::kAdd) == Approx(s * 0.5));
  CHECK(red(BlendFactor::kConstantAlpha, BlendFactor::kZero, BlendOp::kAdd) == Approx(s * 0.125));
  CHECK(red(BlendFactor::kOneMinusConstantAlpha, BlendFactor::kZero, BlendOp::kAdd) == Approx(s * 0.875));
  CHECK(red(BlendFactor::kSrcAlphaSaturate, BlendFactor::kZero, BlendOp::kAdd) ==
        Approx(s * std::min(sa, 1 - da)));
  CHECK(red(BlendFactor::kSrc1Color, BlendFactor::kZero, BlendOp::kAdd) == Approx(s * 0.3));
  CHECK(red(BlendFactor::kOneMinusSrc1Color, BlendFactor::kZero, BlendOp::kAdd) == Approx(s * 0.7));
  CHECK(red(BlendFactor::kZero, BlendFactor::kSrc1Alpha, BlendOp::kAdd) == Approx(d * 0.7));
  CHECK(red(BlendFactor::kZero, BlendFactor::kOneMinusSrc1Alpha, BlendOp::kAdd) == Approx(d * 0.3));
  CHECK(red(BlendFactor::kOne, BlendFactor::kSrcAlpha, BlendOp::kSubtract) == Approx(s - d * sa));
  CHECK(red(BlendFactor::kSrcAlpha, BlendFactor::kOne, BlendOp::kReverseSubtract) == Approx(d - s * sa));
  CHECK(red(BlendFactor::kZero, BlendFactor::kZero, BlendOp::kMin) == Approx(std::min(s, d)));
  CHECK(red(BlendFactor::kZero, BlendFactor::kZero, BlendOp::kMax) == Approx(std::max(s, d)));
}

TEST_CASE("output: channels outside the write mask keep their bits") {
  traces::BlendState state;
  state.write_mask = 0b0101;
  CHECK(blend(state, {}, kUnorm, {1, 1, 0, 1}, {}, {{{0x12345678u}}, {}}).code == PixelCode{{0x120056ffu}});
}

TEST_CASE("output: halves and small floats against their definitions, and codes come back") {
  using traces::Format;
  const auto code = [](Format format, double v) {
    return store_color(format, {v, 0, 0, 0}).code.word[0] & 0xffffu;
  };
  CHECK(code(Format::kR16Float, 1) == 0x3c00);
  CHECK(code(Format::kR16Float, -0.5) == 0xb800);
  CHECK(code(Format::kR16Float, 65520) == 0x7c00);
  CHECK(code(Format::kR16Float, 65519) == 0x7bff);
  CHECK(code(Format::kR16Float, 0x1p-24) == 1);
  CHECK((code(Format::kB10G11R11Ufloat, 1e9) & 0x7ffu) == ((30u << 6) | 63u));
  for (std::uint32_t bits = 0; bits < 0x7c00; ++bits)
    if (code(Format::kR16Float, load_color(Format::kR16Float, {{bits}})[0]) != bits) FAIL("half " << bits);
}

TEST_CASE("output: stencil operations and depths of integers") {
  traces::StencilFace face;
  face.reference = 5;
  face.write_mask = 0x0f;
  CHECK(stencil_after(face, traces::StencilOp::kReplace, 0xf0) == 0xf5);
  CHECK(stencil_after(face, traces::StencilOp::kInvert, 0xf0) == 0xff);
  face.write_mask = 0xff;
  CHECK(stencil_after(face, traces::StencilOp::kIncrementClamp, 255) == 255);
  CHECK(stencil_after(face, traces::StencilOp::kIncrementWrap, 255) == 0);
  CHECK(stencil_after(face, traces::StencilOp::kDecrementClamp, 0) == 0);
  CHECK(stencil_after(face, traces::StencilOp::kDecrementWrap, 0) == 255);
  face.compare = traces::CompareOp::kLess;
  face.compare_mask = 0x03;  // 1 < stored & 3
  CHECK(stencil_passes(face, 0xfe));
  CHECK_FALSE(stencil_passes(face, 0xfd));
  CHECK(held_depth(traces::Format::kD16Unorm, 0.5 / 65535 + 1e-9) == Approx(1.0 / 65535));
  CHECK(held_depth(traces::Format::kD32Float, 0.3) == 0.3);
}
