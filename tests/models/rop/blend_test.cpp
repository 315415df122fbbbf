#include "models/rop/blend.h"

#include "models/rop/srgb.h"
#include "tests/models/random_source.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace quadrille::models;

namespace {

double decode(Format format, std::uint32_t pixel, int c) {
  const std::uint32_t code = pixel >> (8 * c) & 0xff;
  return format == Format::kR8G8B8A8Srgb && c < 3
             ? static_cast<double>(decode_srgb8(static_cast<std::uint8_t>(code)))
             : code / 255.0;
}

/// Encoded value before rounding, in codes.
double encode(Format format, double v, int c) {
  v = std::clamp(v, 0.0, 1.0);
  if (format != Format::kR8G8B8A8Srgb || c == 3) return v * 255.0;
  return 255.0 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055);
}

double factor(BlendFactor f, const double* src, const double* dst, int c) {
  switch (f) {
    case BlendFactor::kZero: return 0;
    case BlendFactor::kOne: return 1;
    case BlendFactor::kSrcColor: return src[c];
    case BlendFactor::kOneMinusSrcColor: return 1 - src[c];
    case BlendFactor::kDstColor: return dst[c];
    case BlendFactor::kOneMinusDstColor: return 1 - dst[c];
    case BlendFactor::kSrcAlpha: return src[3];
    case BlendFactor::kOneMinusSrcAlpha: return 1 - src[3];
    case BlendFactor::kDstAlpha: return dst[3];
    case BlendFactor::kOneMinusDstAlpha: return 1 - dst[3];
  }
  return 0;
}

double combine(BlendOp op, double s, double fs, double d, double fd) {
  switch (op) {
    case BlendOp::kAdd: return s * fs + d * fd;
    case BlendOp::kSubtract: return s * fs - d * fd;
    case BlendOp::kReverseSubtract: return d * fd - s * fs;
    case BlendOp::kMin: return std::min(s, d);
    case BlendOp::kMax: return std::max(s, d);
  }
  return 0;
}

double blended(const BlendState& state, const double* src, const double* dst, int c) {
  if (!state.enable) return src[c];
  if (c == 3)
    return combine(state.alpha, src[3], factor(state.src_alpha, src, dst, 3), dst[3],
                   factor(state.dst_alpha, src, dst, 3));
  return combine(state.color, src[c], factor(state.src_color, src, dst, c), dst[c],
                 factor(state.dst_color, src, dst, c));
}

BlendState random_state(RandomSource& random) {
  const auto any_factor = [&] { return static_cast<BlendFactor>(random.integer(0, 9)); };
  BlendState s;
  s.enable = random.integer(0, 3) != 0;
  s.src_color = any_factor();
  s.dst_color = any_factor();
  s.src_alpha = any_factor();
  s.dst_alpha = any_factor();
  s.color = static_cast<BlendOp>(random.integer(0, 4));
  s.alpha = static_cast<BlendOp>(random.integer(0, 4));
  s.write_mask = static_cast<std::uint8_t>(random.integer(0, 3) == 0 ? random.integer(0, 15) : 15);
  return s;
}

}  // namespace

TEST_CASE("blend: every factor and operation rounds the exact result once") {
  RandomSource random(61);
  int changed = 0;
  for (int round = 0; round < 60000; ++round) {
    const BlendState state = random_state(random);
    const Format format = random.integer(0, 1) != 0 ? Format::kR8G8B8A8Srgb : Format::kR8G8B8A8Unorm;
    float rgba[4][4];
    for (auto& component : rgba) {
      for (float& v : component) v = random.real(-0.2f, 1.2f);
    }
    std::uint32_t pixels[4], before[4];
    for (int i = 0; i < 4; ++i) pixels[i] = before[i] = random.bits();
    const auto mask = static_cast<std::uint32_t>(random.integer(0, 15));
    blend_quad(state, format, rgba, pixels, mask);
    for (int i = 0; i < 4; ++i) {
      double src[4], dst[4];
      for (int c = 0; c < 4; ++c) {
        src[c] = std::clamp(static_cast<double>(rgba[c][i]), 0.0, 1.0);
        dst[c] = decode(format, before[i], c);
      }
      for (int c = 0; c < 4; ++c) {
        const auto code = static_cast<int>(pixels[i] >> (8 * c) & 0xff),
                   old = static_cast<int>(before[i] >> (8 * c) & 0xff);
        if ((mask >> i & 1) == 0 || (state.write_mask >> c & 1) == 0) {
          if (code != old) FAIL("round " << round << ": a masked byte changed");
          continue;
        }
        const double exact = encode(format, blended(state, src, dst, c), c);
        if (std::abs(code - exact) > 0.5 + 2e-3)
          FAIL("round " << round << " pixel " << i << " component " << c << ": " << code << " for " << exact);
        changed += code != old ? 1 : 0;
      }
    }
  }
  CHECK(changed > 100000);
}

TEST_CASE("blend: NaN and infinities become codes") {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const float rgba[4][4] = {{nan, inf, -inf, 0}, {inf, nan, 1, 0}, {0, 0, nan, 0}, {nan, 1, inf, nan}};
  for (const Format format : {Format::kR8G8B8A8Unorm, Format::kR8G8B8A8Srgb}) {
    std::uint32_t pixels[4] = {0x11111111, 0x22222222, 0x33333333, 0x44444444};
    blend_quad(BlendState{}, format, rgba, pixels, 0xf);
    CHECK(pixels[0] == 0x0000ff00);
    CHECK(pixels[1] == 0xff0000ff);
    CHECK(pixels[2] == 0xff00ff00);
    CHECK(pixels[3] == 0);
  }
}

TEST_CASE(
    "blend: an opaque write of a decoded colour gives its code back and agrees with the scalar encoder") {
  RandomSource random(62);
  for (int round = 0; round < 50000; ++round) {
    float rgba[4][4];
    for (auto& component : rgba) {
      for (float& v : component)
        v = random.integer(0, 1) != 0 ? decode_srgb8(static_cast<std::uint8_t>(random.bits()))
                                      : random.real(-0.01f, 1.01f);
    }
    std::uint32_t pixels[4] = {};
    blend_quad(BlendState{}, Format::kR8G8B8A8Srgb, rgba, pixels, 0xf);
    for (int i = 0; i < 4; ++i) {
      for (int c = 0; c < 3; ++c) {
        if ((pixels[i] >> (8 * c) & 0xff) != encode_srgb8(rgba[c][i])) FAIL("value " << rgba[c][i]);
      }
    }
  }
  // 127.5 rounds to even: 128
  CHECK(encode_color(Format::kR8G8B8A8Unorm, {1.0f, 0.5f, 0.0f, 1.0f}) == 0xff0080ff);
  CHECK(encode_color(Format::kR8G8B8A8Srgb, {1.0f, 0.5f, 0.0f, 0.25f}) == 0x4000bcff);
}

TEST_CASE("blend: only blending and partial masks read the destination") {
  BlendState s;
  CHECK_FALSE(reads_destination(s));
  s.write_mask = 0x7;
  CHECK(reads_destination(s));
  s.write_mask = 0xf;
  s.enable = true;
  CHECK(reads_destination(s));
}
