/// Image metrics: plain loops over two images.
#include "models/reference/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "models/base/error.h"

namespace quadrille::models::reference {
namespace {

int channel(std::uint32_t rgba, std::size_t c) { return static_cast<int>((rgba >> (8 * c)) & 0xffu); }

int channel_difference(std::uint32_t a, std::uint32_t b, std::size_t c) {
  return std::abs(channel(a, c) - channel(b, c));
}

int largest_difference(std::uint32_t a, std::uint32_t b, std::size_t channels) {
  if (a == b) return 0;
  int largest = 0;
  for (std::size_t c = 0; c < channels; ++c) largest = std::max(largest, channel_difference(a, b, c));
  return largest;
}

void check_sizes(ImageView a, ImageView b, std::size_t excluded) {
  const std::size_t pixels = std::size_t{a.width} * a.height;
  if (a.width != b.width || a.height != b.height)
    throw user_error("images differ in size: {}x{} and {}x{}", a.width, a.height, b.width, b.height);
  if (a.rgba.size() != pixels || b.rgba.size() != pixels || (excluded != 0 && excluded != pixels)) {
    throw user_error("image: {}x{} pixels announced, another number given", a.width, a.height);
  }
}

/// Counts the pixels that are off in each 8x8 block.
void count_blocks(ImageView a, ImageView b, std::span<const std::uint8_t> excluded, std::size_t channels,
                  ImageDifference& out) {
  std::uint64_t worst = 0;
  for (std::uint32_t top = 0; top < a.height; top += kBlockSide) {
    for (std::uint32_t left = 0; left < a.width; left += kBlockSide) {
      std::uint64_t off = 0, pixels = 0;
      for (std::uint32_t y = top; y < std::min(a.height, top + kBlockSide); ++y) {
        for (std::uint32_t x = left; x < std::min(a.width, left + kBlockSide); ++x) {
          const std::size_t at = std::size_t{y} * a.width + x;
          if (!excluded.empty() && excluded[at] != 0) continue;
          ++pixels;
          off += largest_difference(a.rgba[at], b.rgba[at], channels) > kBlockLimit ? 1u : 0u;
        }
      }
      ++out.blocks;
      if (4 * off > pixels) ++out.bad_blocks;
      if (off > worst) worst = off, out.worst_block = {left / kBlockSide, top / kBlockSide};
    }
  }
}

double ratio(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

/// Blue, green, yellow, red: piecewise linear in the logarithm of the difference.
std::uint32_t heat(int lsb) {
  struct Stop {
    double at;
    std::array<double, 3> rgb;
  };
  constexpr std::array<Stop, 4> kStops{
      {{0, {40, 80, 255}}, {3, {0, 200, 60}}, {4.5, {255, 230, 0}}, {6, {255, 0, 0}}}};
  const double position = std::min(std::log2(static_cast<double>(lsb)), 6.0);
  std::size_t next = 1;
  while (kStops[next].at < position) ++next;
  const double t = (position - kStops[next - 1].at) / (kStops[next].at - kStops[next - 1].at);
  std::uint32_t rgba = 0xff000000u;
  for (std::size_t c = 0; c < 3; ++c)
    rgba |=
        static_cast<std::uint32_t>(std::lround(kStops[next - 1].rgb[c] * (1 - t) + kStops[next].rgb[c] * t))
        << (8 * c);
  return rgba;
}

}  // namespace

double ImageDifference::fraction_within(int lsb) const {
  std::uint64_t within = 0;
  for (int d = 0; d <= std::clamp(lsb, -1, 255); ++d) within += max_histogram[static_cast<std::size_t>(d)];
  return pixels == 0 ? 1.0 : ratio(within, pixels);
}

ImageDifference compare_images(ImageView a, ImageView b, std::span<const std::uint8_t> excluded,
                               bool with_alpha) {
  check_sizes(a, b, excluded.size());
  ImageDifference out;
  const std::size_t channels = with_alpha ? 4 : 3;
  double squares = 0;
  std::uint64_t equal = 0;  // most pixels are, as a rule
  for (std::size_t at = 0; at < a.rgba.size(); ++at) {
    if (!excluded.empty() && excluded[at] != 0) continue;
    ++out.pixels;
    if (a.rgba[at] == b.rgba[at]) {
      ++equal;
      continue;
    }
    for (std::size_t c = 0; c < channels; ++c) {
      const int d = channel_difference(a.rgba[at], b.rgba[at], c);
      ++out.histogram[c][static_cast<std::size_t>(d)];
      if (c < 3) squares += static_cast<double>(d) * d;
    }
    const int largest = largest_difference(a.rgba[at], b.rgba[at], channels);
    ++out.max_histogram[static_cast<std::size_t>(largest)];
    out.max_lsb = std::max(out.max_lsb, largest);
  }
  for (std::size_t c = 0; c < channels; ++c) out.histogram[c][0] += equal;
  out.max_histogram[0] += equal;
  out.psnr_db = squares == 0
                    ? std::numeric_limits<double>::infinity()
                    : 10.0 * std::log10(255.0 * 255.0 * 3.0 * static_cast<double>(out.pixels) / squares);
  count_blocks(a, b, excluded, channels, out);
  return out;
}

double CoverageDifference::coverage_fraction() const { return ratio(only_a + only_b, pixels); }
double CoverageDifference::triangle_fraction() const { return ratio(other_triangle, pixels); }

CoverageDifference compare_triangles(std::span<const std::uint64_t> a, std::span<const std::uint64_t> b,
                                     std::uint64_t background, std::span<const std::uint8_t> excluded) {
  if (a.size() != b.size() || (!excluded.empty() && excluded.size() != a.size()))
    throw user_error("images differ in size: {} and {} pixels", a.size(), b.size());
  CoverageDifference out;
  for (std::size_t at = 0; at < a.size(); ++at) {
    if (!excluded.empty() && excluded[at] != 0) continue;
    ++out.pixels;
    const bool in_a = a[at] != background, in_b = b[at] != background;
    if (in_a && in_b) {
      ++out.both;
      out.other_triangle += a[at] != b[at] ? 1u : 0u;
    } else {
      out.only_a += in_a ? 1u : 0u;
      out.only_b += in_b ? 1u : 0u;
    }
  }
  return out;
}

std::vector<std::uint32_t> difference_heat_map(ImageView a, ImageView b) {
  check_sizes(a, b, 0);
  std::vector<std::uint32_t> out(a.rgba.size());
  for (std::size_t at = 0; at < out.size(); ++at) {
    const int lsb = largest_difference(a.rgba[at], b.rgba[at], 4);
    if (lsb != 0) {
      out[at] = heat(lsb);
    } else {
      const int grey =
          (channel(a.rgba[at], 0) * 2 + channel(a.rgba[at], 1) * 5 + channel(a.rgba[at], 2)) / 8 / 3;
      out[at] = 0xff000000u | static_cast<std::uint32_t>(grey) * 0x010101u;
    }
  }
  return out;
}

}  // namespace quadrille::models::reference
