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

/// What blend factors are made of; all components of four.
struct Inputs {
  double src[4] = {}, dst[4] = {}, second[4] = {}, constant[4] = {};
};

double factor(BlendFactor f, const Inputs& in, int c) {
  switch (f) {
    case BlendFactor::kZero: return 0;
    case BlendFactor::kOne: return 1;
    case BlendFactor::kSrcColor: return in.src[c];
    case BlendFactor::kOneMinusSrcColor: return 1 - in.src[c];
    case BlendFactor::kDstColor: return in.dst[c];
    case BlendFactor::kOneMinusDstColor: return 1 - in.dst[c];
    case BlendFactor::kSrcAlpha: return in.src[3];
    case BlendFactor::kOneMinusSrcAlpha: return 1 - in.src[3];
    case BlendFactor::kDstAlpha: return in.dst[3];
    case BlendFactor::kOneMinusDstAlpha: return 1 - in.dst[3];
    case BlendFactor::kConstantColor: return in.constant[c];
    case BlendFactor::kOneMinusConstantColor: return 1 - in.constant[c];
    case BlendFactor::kConstantAlpha: return in.constant[3];
    case BlendFactor::kOneMinusConstantAlpha: return 1 - in.constant[3];
    case BlendFactor::kSrcAlphaSaturate: return c == 3 ? 1 : std::min(in.src[3], 1 - in.dst[3]);
    case BlendFactor::kSrc1Color: return in.second[c];
    case BlendFactor::kOneMinusSrc1Color: return 1 - in.second[c];
    case BlendFactor::kSrc1Alpha: return in.second[3];
    case BlendFactor::kOneMinusSrc1Alpha: return 1 - in.second[3];
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

double blended(const BlendState& state, const Inputs& in, int c) {
  if (!state.enable) return in.src[c];
  const bool alpha = c == 3;
  return combine(alpha ? state.alpha : state.color, in.src[c],
                 factor(alpha ? state.src_alpha : state.src_color, in, c), in.dst[c],
                 factor(alpha ? state.dst_alpha : state.dst_color, in, c));
}

/// Of factors up to this one.
BlendState random_state(RandomSource& random, int last_factor) {
  const auto any_factor = [&] { return static_cast<BlendFactor>(random.integer(0, last_factor)); };
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
    const BlendState state = random_state(random, static_cast<int>(BlendFactor::kOneMinusDstAlpha));
    const Format format = random.integer(0, 1) != 0 ? Format::kR8G8B8A8Srgb : Format::kR8G8B8A8Unorm;
    float rgba[4][4];
    for (auto& component : rgba) {
      for (float& v : component) v = random.real(-0.2f, 1.2f);
    }
    std::uint32_t pixels[4], before[4];
    for (int i = 0; i < 4; ++i) pixels[i] = before[i] = random.bits();
    const auto mask = static_cast<std::uint32_t>(random.integer(0, 15));
    blend_quad(state, {}, format, rgba, nullptr, reinterpret_cast<std::byte*>(pixels), mask);
    for (int i = 0; i < 4; ++i) {
      Inputs in;
      for (int c = 0; c < 4; ++c) {
        in.src[c] = std::clamp(static_cast<double>(rgba[c][i]), 0.0, 1.0);
        in.dst[c] = decode(format, before[i], c);
      }
      for (int c = 0; c < 4; ++c) {
        const auto code = static_cast<int>(pixels[i] >> (8 * c) & 0xff),
                   old = static_cast<int>(before[i] >> (8 * c) & 0xff);
        if ((mask >> i & 1) == 0 || (state.write_mask >> c & 1) == 0) {
          if (code != old) FAIL("round " << round << ": a masked byte changed");
          continue;
        }
        const double exact = encode(format, blended(state, in, c), c);
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
    if (!info.may(kBlendUse)) continue;
    const bool floats = is_float_format(format);
    const BlendState state = random_state(random, static_cast<int>(kLastBlendFactor));
    const BlendShared shared{
        {random.real(0, 1), random.real(0, 1), random.real(0, 1), random.real(0, 1)}, false, LogicOp::kCopy};
    float rgba[4][4], second[4][4];
    for (auto& component : second) {
      for (float& v : component) v = random.real(-0.2f, 1.2f);
    }
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
    blend_quad(state, shared, format, rgba, second, pixels.data(), mask);
    for (std::size_t i = 0; i < 4; ++i) {
      Inputs in;
      for (std::size_t c = 0; c < 4; ++c) {
        const auto held = [floats](float v) {
          return floats ? static_cast<double>(v) : std::clamp(static_cast<double>(v), 0.0, 1.0);
        };
        in.second[c] = held(second[c][i]);
        in.constant[c] = static_cast<double>(shared.constants[c]);
        in.src[c] = held(rgba[c][i]);
        in.dst[c] = static_cast<double>(before[i][c]);
      }
      const std::array<float, 4> after = decode_color(format, code_at(i));
      for (std::size_t c = 0; c < info.channels; ++c) {
        INFO(info.name << ", round " << round << ", pixel " << i << ", component " << c);
        if ((mask >> i & 1) == 0 || (state.write_mask >> c & 1) == 0) {
          if (after[c] != before[i][c]) FAIL("a masked component changed");
          continue;
        }
        double exact = blended(state, in, static_cast<int>(c));
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

TEST_CASE(
    "blend: the sixteen logic operations work on bits of integers, and floats and sRGB are not touched") {
  RandomSource random(64);
  const auto bit_of = [](LogicOp op, unsigned s, unsigned d) -> unsigned {
    switch (op) {
      case LogicOp::kClear: return 0;
      case LogicOp::kAnd: return s & d;
      case LogicOp::kAndReverse: return s & (d ^ 1u);
      case LogicOp::kCopy: return s;
      case LogicOp::kAndInverted: return (s ^ 1u) & d;
      case LogicOp::kNoOp: return d;
      case LogicOp::kXor: return s ^ d;
      case LogicOp::kOr: return s | d;
      case LogicOp::kNor: return (s | d) ^ 1u;
      case LogicOp::kEquivalent: return s ^ d ^ 1u;
      case LogicOp::kInvert: return d ^ 1u;
      case LogicOp::kOrReverse: return s | (d ^ 1u);
      case LogicOp::kCopyInverted: return s ^ 1u;
      case LogicOp::kOrInverted: return (s ^ 1u) | d;
      case LogicOp::kNand: return (s & d) ^ 1u;
      case LogicOp::kSet: return 1;
    }
    return 0;
  };
  for (int op = 0; op < 16; ++op) {
    const BlendShared shared{{}, true, static_cast<LogicOp>(op)};
    const float half[4][4] = {{0.2f, 0.2f, 0.2f, 0.2f}, {1, 1, 1, 1}, {0, 0, 0, 0}, {0.7f, 0.7f, 0.7f, 0.7f}};
    for (const Format format : {Format::kR8G8B8A8Unorm, Format::kR8G8B8A8Srgb, Format::kR16G16Float}) {
      const std::uint32_t old = random.bits() & 0x3bff3bffu;  // no NaN
      std::uint32_t pixels[4] = {old, old, old, old};
      blend_quad(BlendState{}, shared, format, half, nullptr, reinterpret_cast<std::byte*>(pixels), 0x5);
      const std::uint32_t source = encode_color(format, {0.2f, 1, 0, 0.7f}).word[0];
      std::uint32_t wanted = source;
      for (unsigned bit = 0; format == Format::kR8G8B8A8Unorm && bit < 32; ++bit) {
        const unsigned value = bit_of(shared.logic_op, source >> bit & 1u, old >> bit & 1u);
        wanted = (wanted & ~(1u << bit)) | value << bit;
      }
      INFO("operation " << op);
      CHECK(pixels[0] == wanted);
      CHECK(pixels[1] == old);
      CHECK(pixels[2] == wanted);
    }
  }
}

TEST_CASE("blend: NaN and infinities become codes") {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const float rgba[4][4] = {{nan, inf, -inf, 0}, {inf, nan, 1, 0}, {0, 0, nan, 0}, {nan, 1, inf, nan}};
  for (const Format format : {Format::kR8G8B8A8Unorm, Format::kR8G8B8A8Srgb}) {
    std::uint32_t pixels[4] = {0x11111111, 0x22222222, 0x33333333, 0x44444444};
    blend_quad(BlendState{}, {}, format, rgba, nullptr, reinterpret_cast<std::byte*>(pixels), 0xf);
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
    blend_quad(BlendState{}, {}, Format::kR8G8B8A8Srgb, rgba, nullptr, reinterpret_cast<std::byte*>(pixels),
               0xf);
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
