#include "models/rop/blend.h"

#include "models/rop/srgb.h"
#include "tests/models/random_source.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
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
    blend_quad(state, format, rgba, reinterpret_cast<std::byte*>(pixels), mask);
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

TEST_CASE("blend: every format with every factor and operation rounds to a neighbour of the exact result") {
  RandomSource random(63);
  for (int round = 0; round < 60000; ++round) {
    const auto format = static_cast<Format>(random.integer(0, static_cast<int>(kLastFormat)));
    const FormatInfo& info = format_info(format);
    if (!info.may(kColorUse)) continue;
    const bool floats = is_float_format(format);
    const BlendState state = random_state(random);
    float rgba[4][4];
    for (auto& component : rgba) {
      for (float& v : component) v = floats ? random.real(-30.0f, 200.0f) : random.real(-0.2f, 1.2f);
    }
    alignas(16) std::array<std::byte, 64> pixels{};
    std::array<std::array<float, 4>, 4> before{};
    const auto code_at = [&](std::size_t i) {
      PixelCode code;
      std::memcpy(code.word.data(), pixels.data() + i * info.bytes, info.bytes);
      return code;
    };
    for (std::size_t i = 0; i < 4; ++i) {
      const float most = floats ? 100.0f : 1.0f;
      const PixelCode code = encode_color(
          format, {random.real(0, most), random.real(0, most), random.real(0, most), random.real(0, most)});
      std::memcpy(pixels.data() + i * info.bytes, code.word.data(), info.bytes);
      before[i] = decode_color(format, code);
    }
    const auto mask = static_cast<std::uint32_t>(random.integer(0, 15));
    blend_quad(state, format, rgba, pixels.data(), mask);
    for (std::size_t i = 0; i < 4; ++i) {
      double src[4], dst[4];
      for (std::size_t c = 0; c < 4; ++c) {
        src[c] =
            floats ? static_cast<double>(rgba[c][i]) : std::clamp(static_cast<double>(rgba[c][i]), 0.0, 1.0);
        dst[c] = static_cast<double>(before[i][c]);
      }
      const std::array<float, 4> after = decode_color(format, code_at(i));
      for (std::size_t c = 0; c < info.channels; ++c) {
        INFO(info.name << ", round " << round << ", pixel " << i << ", component " << c);
        if ((mask >> i & 1) == 0 || (state.write_mask >> c & 1) == 0) {
          if (after[c] != before[i][c]) FAIL("a masked component changed");
          continue;
        }
        double exact = blended(state, src, dst, static_cast<int>(c));
        if (!floats) exact = std::clamp(exact, 0.0, 1.0);
        if (info.component[c].numeric == Numeric::kUfloat) exact = std::max(exact, 0.0);
        // What the neighbours of a code are apart, and what fp32 arithmetic loses of products this large.
        std::array<float, 4> value{};
        value[c] = static_cast<float>(exact);
        const double stored = static_cast<double>(decode_color(format, encode_color(format, value))[c]);
        const double step =
            info.component[c].numeric == Numeric::kUnorm || info.component[c].numeric == Numeric::kSrgb
                ? 1.0 / 250
                : std::abs(exact) / (info.component[c].bits == 32   ? 4e6
                                     : info.component[c].bits == 16 ? 1000
                                                                    : 30);
        if (std::abs(static_cast<double>(after[c]) - stored) > step + (floats ? 0.03 : 1e-5))
          FAIL(static_cast<double>(after[c]) << " for " << exact);
      }
    }
  }
}

TEST_CASE("blend: small floats round to nearest, keep infinity and NaN, and clamp what is too large") {
  const auto code = [](Format format, float v) {
    return encode_color(format, {v, 0, 0, 0}).word[0] & 0xffffu;
  };
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  CHECK(code(Format::kR16Float, 1.0f) == 0x3c00);
  CHECK(code(Format::kR16Float, -2.0f) == 0xc000);
  CHECK(code(Format::kR16Float, 65520.0f) == 0x7c00);        // halfway above the greatest: infinity
  CHECK(code(Format::kR16Float, 5.9604645e-8f) == 0x0001);   // the least
  CHECK(code(Format::kR16Float, 1.00048828125f) == 0x3c00);  // a tie goes to the even code
  const auto eleven = [&](float v) { return code(Format::kB10G11R11Ufloat, v) & 0x7ffu; };
  CHECK(eleven(1.0f) == 15u << 6);
  CHECK(eleven(-3.0f) == 0);
  CHECK(eleven(65024.0f) == ((30u << 6) | 63u));
  CHECK(eleven(1e6f) == ((30u << 6) | 63u));
  CHECK(eleven(inf) == 31u << 6);
  CHECK(eleven(nan) == ((31u << 6) | 1u));
  CHECK(eleven(1.0f + 1.0f / 128) == 15u << 6);  // a tie goes to the even code
  CHECK(eleven(1.0f + 3.0f / 128) == ((15u << 6) | 2u));
  CHECK(eleven(0x1p-20f) == 1);  // the least
  CHECK(eleven(0x1p-14f) == 1u << 6);
  for (std::uint32_t bits = 0; bits < 31u << 6; ++bits) {
    const float v = decode_color(Format::kB10G11R11Ufloat, {{bits}})[0];
    if (eleven(v) != bits) FAIL("code " << bits);
  }
}

TEST_CASE("blend: NaN and infinities become codes") {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const float rgba[4][4] = {{nan, inf, -inf, 0}, {inf, nan, 1, 0}, {0, 0, nan, 0}, {nan, 1, inf, nan}};
  for (const Format format : {Format::kR8G8B8A8Unorm, Format::kR8G8B8A8Srgb}) {
    std::uint32_t pixels[4] = {0x11111111, 0x22222222, 0x33333333, 0x44444444};
    blend_quad(BlendState{}, format, rgba, reinterpret_cast<std::byte*>(pixels), 0xf);
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
    blend_quad(BlendState{}, Format::kR8G8B8A8Srgb, rgba, reinterpret_cast<std::byte*>(pixels), 0xf);
    for (int i = 0; i < 4; ++i) {
      for (int c = 0; c < 3; ++c) {
        if ((pixels[i] >> (8 * c) & 0xff) != encode_srgb8(rgba[c][i])) FAIL("value " << rgba[c][i]);
      }
    }
  }
  // 127.5 rounds to even: 128
  CHECK(encode_color(Format::kR8G8B8A8Unorm, {1.0f, 0.5f, 0.0f, 1.0f}).word[0] == 0xff0080ff);
  CHECK(encode_color(Format::kR8G8B8A8Srgb, {1.0f, 0.5f, 0.0f, 0.25f}).word[0] == 0x4000bcff);
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
