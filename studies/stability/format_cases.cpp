/// Cases of attachments at the limits of their formats: floats near overflow and below the least one, alpha
/// outside 0..1, depths between two codes.
#include "studies/stability/stability.h"
#include "studies/stability/stream_builder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace quadrille::studies::stability {

namespace {

constexpr std::uint32_t kCell = 16;

Area cell_area(std::size_t row, std::size_t column) {
  return {static_cast<std::int32_t>(kCell * column), static_cast<std::int32_t>(kCell * row), kCell, kCell};
}
/// The pixel in the middle of a cell.
std::size_t pixel_of(const Observed& o, std::size_t row, std::size_t column) {
  return (kCell * row + kCell / 2) * o.image().width + kCell * column + kCell / 2;
}
Corners filled(const glm::vec4& color, float z = 0.5F) { return quad({-1, -1}, {1, 1}, z, color); }

// floats
// --------------------------------------------------------------------------------------------------

/// A float of a few bits: distance of neighbours 2^(exponent - mantissa), exponents from -14 to 15.
struct SmallFloat {
  int mantissa;
  bool negative;      ///< it has a sign; else what is below 0 becomes 0
  bool has_overflow;  ///< what is beyond the largest becomes infinity; else the largest
};
constexpr SmallFloat kHalf{10, true, true}, k11{6, false, false}, k10{5, false, false};

/// The nearest number of a format, ties to even, in double arithmetic.
double nearest(double value, const SmallFloat& format) {
  if (!format.negative && value < 0) return 0;
  const int exponent = value == 0 ? -14 : std::max(std::ilogb(value), -14);
  const double step = std::ldexp(1.0, exponent - format.mantissa);
  const double rounded = std::nearbyint(value / step) * step;
  const double largest = (2 - std::ldexp(1.0, -format.mantissa)) * 32768;
  if (std::abs(rounded) <= largest) return rounded;
  return std::copysign(format.has_overflow ? std::numeric_limits<double>::infinity() : largest, value);
}

/// Around the largest half (65504; from 65520 on the nearest is infinity), the least normal and the least.
constexpr std::array<float, 15> kValues{1,        65504,    65519,      65520,           70000,
                                        1e30F,    -65504,   -65519,     -65520,          -1e30F,
                                        0x1p-14F, 0x1p-24F, 0x1.8p-24F, 0x1.000002p-25F, 0x1p-25F};

/// Each value as it is, and added twice to what is there.
traces::CommandStream float_values(traces::Format format, const char* name) {
  StreamBuilder stream(name, static_cast<std::uint32_t>(kCell * kValues.size()), kCell * 2, format,
                       traces::Format::kUndefined);
  for (const bool adds : {false, true}) {
    stream.state({.mix = adds ? Mix::kAdd : Mix::kReplace});
    for (std::size_t i = 0; i < kValues.size(); ++i) {
      stream.area(cell_area(adds ? 1 : 0, i));
      const Corners corners = filled(glm::vec4(kValues[i]));
      stream.draw(corners);
      if (adds) stream.draw(corners);
    }
  }
  return stream.finish();
}

void check_float_values(const Observed& o, Findings& f, const std::array<SmallFloat, 3>& channels) {
  std::uint64_t replaced = 0, added = 0, infinite = 0;
  for (std::size_t i = 0; i < kValues.size(); ++i) {
    for (std::size_t c = 0; c < channels.size(); ++c) {
      const double once = nearest(kValues[i], channels[c]);
      const auto twice = nearest(static_cast<double>(static_cast<float>(once) + kValues[i]), channels[c]);
      const auto at = [&](std::size_t row) {
        return static_cast<double>(o.image().linear.at(pixel_of(o, row, i))[c]);
      };
      replaced += at(0) != once ? 1 : 0;
      added += at(1) != twice ? 1 : 0;
      infinite += std::isinf(at(0)) ? 1 : 0;
    }
  }
  std::uint64_t wanted_infinite = 0;
  for (const SmallFloat& channel : channels)
    for (const float value : kValues) wanted_infinite += std::isinf(nearest(value, channel)) ? 1 : 0;
  f.equal("values that are not the nearest of the format", replaced, 0);
  f.equal("sums that are not the nearest of the format", added, 0);
  f.equal("values that became infinite", infinite, wanted_infinite);
}

// alpha
// --------------------------------------------------------------------------------------------------

constexpr std::array<float, 8> kAlphas{-1e4F, -1, -0.25F, 0, 0.5F, 1, 1.5F, 1e4F};
constexpr glm::vec4 kOver(0.75F, 0.5F, 0.25F, 0);
/// In both formats exactly.
constexpr std::array<float, 4> kBehind{0, 1, 1, 1};

traces::CommandStream alphas(traces::Format format, const char* name) {
  StreamBuilder stream(name, static_cast<std::uint32_t>(kCell * kAlphas.size()), kCell, format,
                       traces::Format::kUndefined);
  stream.clear(kBehind).state({.mix = Mix::kOver});
  for (std::size_t i = 0; i < kAlphas.size(); ++i) {
    glm::vec4 color = kOver;
    color.a = kAlphas[i];
    stream.area(cell_area(0, i)).draw(filled(color));
  }
  return stream.finish();
}

double mixed(std::size_t channel, double alpha) {
  const auto c = static_cast<glm::length_t>(channel);
  return static_cast<double>(kOver[c]) * alpha + static_cast<double>(kBehind[channel]) * (1 - alpha);
}

void check_float_alphas(const Observed& o, Findings& f) {
  double worst = 0;  // of the format's rounding and four of fp32, at the largest term
  for (std::size_t i = 0; i < kAlphas.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double wanted = mixed(c, static_cast<double>(kAlphas[i]));
      const double stored = static_cast<double>(o.image().linear.at(pixel_of(o, 0, i))[c]);
      const double step = std::ldexp(1.0, std::max(std::ilogb(wanted), -14) - kHalf.mantissa);
      worst = std::max(worst, std::abs(stored - wanted) / step);
    }
  }
  f.at_most("largest distance from the closed form, alpha as it is", worst, 0.51, "ULP of the half");
}

void check_unorm_alphas(const Observed& o, Findings& f) {
  std::uint64_t wrong = 0;
  for (std::size_t i = 0; i < kAlphas.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double alpha = std::clamp(static_cast<double>(kAlphas[i]), 0.0, 1.0);
      const auto stored = static_cast<double>(o.image().color[pixel_of(o, 0, i)] >> (8 * c) & 0xffu);
      wrong += std::abs(stored - 255 * mixed(c, alpha)) > 0.51 ? 1 : 0;
    }
  }
  f.equal("channels that are not the closed form with alpha limited to 0..1", wrong, 0);
}

// depths
// --------------------------------------------------------------------------------------------------

/// Pairs of depths: the second is drawn over the first where it is less, as the format stores both.
struct DepthPair {
  double first, second;  ///< in codes of the format, from either end of its range
  bool from_far;
};
constexpr std::array<DepthPair, 10> kPairs{{{0, 0, false},
                                            {0.6, 0.4, false},
                                            {0.4, 0.2, false},
                                            {1, 0.6, false},
                                            {1.4, 0.6, false},
                                            {2.6, 1.4, false},
                                            {0, 0.4, true},
                                            {0, 0.6, true},
                                            {1.4, 1.6, true},
                                            {2, 2.4, true}}};

double depth_of(const DepthPair& pair, bool second, double most) {
  const double codes = second ? pair.second : pair.first;
  return (pair.from_far ? most - codes : codes) / most;
}

traces::CommandStream depth_pairs(traces::Format format, double most, const char* name) {
  StreamBuilder stream(name, static_cast<std::uint32_t>(kCell * kPairs.size()), kCell,
                       traces::Format::kR8G8B8A8Unorm, format);
  stream.state({.depth = {true, true, traces::CompareOp::kLessOrEqual}});
  for (std::size_t i = 0; i < kPairs.size(); ++i)
    stream.area(cell_area(0, i))
        .draw(filled({0, 1, 0, 1}, static_cast<float>(depth_of(kPairs[i], false, most))));
  stream.state({.depth = {true, true, traces::CompareOp::kLess}});
  for (std::size_t i = 0; i < kPairs.size(); ++i)
    stream.area(cell_area(0, i))
        .draw(filled({1, 0, 0, 1}, static_cast<float>(depth_of(kPairs[i], true, most))));
  return stream.finish();
}

void check_depth_pairs(const Observed& o, Findings& f, double most) {
  std::uint64_t wrong = 0, stored = 0, passed = 0;
  for (std::size_t i = 0; i < kPairs.size(); ++i) {
    // The depth that comes is a float already; what it stands for is exact.
    const auto code = [&](bool second) {
      return std::nearbyint(static_cast<double>(static_cast<float>(depth_of(kPairs[i], second, most))) *
                            most);
    };
    const bool nearer = code(true) < code(false);
    passed += nearer ? 1 : 0;
    wrong += (o.image().color[pixel_of(o, 0, i)] & 0xffu) != (nearer ? 255u : 0u) ? 1 : 0;
    const double kept = static_cast<double>(o.image().depth.at(pixel_of(o, 0, i)));
    stored += std::nearbyint(kept * most) != std::min(code(true), code(false)) ? 1 : 0;
  }
  f.equal("pairs whose second depth passed or failed wrongly", wrong, 0);
  f.equal("depths that are not the nearest code", stored, 0);
  f.at_least("pairs that differ in the format", static_cast<double>(passed), 4);
  f.at_least("pairs that are equal in it", static_cast<double>(kPairs.size() - passed), 4);
}

}  // namespace

void add_format_cases(std::vector<Case>& cases) {
  cases.push_back(
      {.name = "half-target",
       .group = "numbers",
       .purpose = "colours around the largest half, beyond it, and below the least, once and added twice",
       .must = "each is stored as the nearest half, ties to even, and from 65520 on as infinity",
       .build = [] { return float_values(traces::Format::kR16G16B16A16Float, "half-target"); },
       .check =
           [](const Observed& o, Findings& f) {
             check_float_values(o, f, {kHalf, kHalf, kHalf});
           }});
  cases.push_back(
      {.name = "packed-float-target",
       .group = "numbers",
       .purpose = "the same colours in a target of unsigned floats of 11, 11 and 10 bits",
       .must = "each is stored as the nearest, below 0 as 0, and beyond the largest as the largest",
       .build = [] { return float_values(traces::Format::kB10G11R11Ufloat, "packed-float-target"); },
       .check =
           [](const Observed& o, Findings& f) {
             check_float_values(o, f, {k11, k11, k10});
           }});
  cases.push_back({.name = "alpha-half-target",
                   .group = "numbers",
                   .purpose = "alpha from -10,000 to 10,000 blended over a target of halves",
                   .must = "alpha is taken as it is",
                   .build = [] { return alphas(traces::Format::kR16G16B16A16Float, "alpha-half-target"); },
                   .check = check_float_alphas});
  cases.push_back({.name = "alpha-unorm-target",
                   .group = "numbers",
                   .purpose = "the same alpha blended over a target of bytes",
                   .must = "alpha is limited to 0..1 before it is used",
                   .build = [] { return alphas(traces::Format::kR8G8B8A8Unorm, "alpha-unorm-target"); },
                   .check = check_unorm_alphas});
  cases.push_back({.name = "depth-codes-16",
                   .group = "numbers",
                   .purpose = "depths between two codes of D16, at both ends of the range",
                   .must = "they are rounded before they are compared",
                   .build = [] { return depth_pairs(traces::Format::kD16Unorm, 65535, "depth-codes-16"); },
                   .check = [](const Observed& o, Findings& f) { check_depth_pairs(o, f, 65535); }});
  cases.push_back(
      {.name = "depth-codes-24",
       .group = "numbers",
       .purpose = "the same of 24 bits, near 0; near 1 a float has no more places than a code",
       .must = "they are rounded before they are compared",
       .build = [] { return depth_pairs(traces::Format::kD24UnormS8Uint, 16777215, "depth-codes-24"); },
       .check = [](const Observed& o, Findings& f) { check_depth_pairs(o, f, 16777215); }});
}

}  // namespace quadrille::studies::stability
