#include "models/texture/block/astc_ends.h"

#include <algorithm>

namespace quadrille::models {
namespace {

constexpr int kOpaque = 255;

AstcColor grey(int level, int alpha) { return {level, level, level, alpha}; }

AstcColor clamped(AstcColor color) {
  for (int& c : color) c = std::clamp(c, 0, 255);
  return color;
}

/// Red and green halfway to blue: finer steps near grey.
AstcColor contracted(const AstcColor& c) { return {(c[0] + c[2]) >> 1, (c[1] + c[2]) >> 1, c[2], c[3]}; }

/// A base of eight bits and a difference of -32..31, whose values lend each other a bit.
struct BaseAndOffset {
  int base, offset;
};
BaseAndOffset base_and_offset(int base, int offset) {
  const int six = offset >> 1 & 63;
  return {base >> 1 | (offset & 128), six >= 32 ? six - 64 : six};
}

AstcEnds luminance_with_offset(std::span<const int> v) {
  const int low = v[0] >> 2 | (v[1] & 0xc0);
  return {grey(low, kOpaque), grey(std::min(low + (v[1] & 63), 255), kOpaque)};
}

AstcEnds luminance_alpha_with_offset(std::span<const int> v) {
  const BaseAndOffset level = base_and_offset(v[0], v[1]), alpha = base_and_offset(v[2], v[3]);
  return {clamped(grey(level.base, alpha.base)),
          clamped(grey(level.base + level.offset, alpha.base + alpha.offset))};
}

AstcEnds scaled(std::span<const int> v, int first_alpha, int second_alpha) {
  return {{v[0] * v[3] >> 8, v[1] * v[3] >> 8, v[2] * v[3] >> 8, first_alpha},
          {v[0], v[1], v[2], second_alpha}};
}

AstcEnds direct(std::span<const int> v, int first_alpha, int second_alpha) {
  const AstcColor even{v[0], v[2], v[4], first_alpha}, odd{v[1], v[3], v[5], second_alpha};
  if (v[1] + v[3] + v[5] >= v[0] + v[2] + v[4]) return {even, odd};
  return {contracted(odd), contracted(even)};
}

AstcEnds with_offset(std::span<const int> v) {
  AstcColor base{0, 0, 0, kOpaque}, moved = base;
  int sum = 0;
  for (std::size_t c = 0; 2 * c < v.size(); ++c) {
    const BaseAndOffset channel = base_and_offset(v[2 * c], v[2 * c + 1]);
    base[c] = channel.base;
    moved[c] = channel.base + channel.offset;
    if (c < 3) sum += channel.offset;
  }
  if (sum >= 0) return {clamped(base), clamped(moved)};
  return {clamped(contracted(moved)), clamped(contracted(base))};
}

}  // namespace

AstcEnds astc_ends(int mode, std::span<const int> v) {
  switch (mode) {
    case 0: return {grey(v[0], kOpaque), grey(v[1], kOpaque)};
    case 1: return luminance_with_offset(v);
    case 4: return {grey(v[0], v[2]), grey(v[1], v[3])};
    case 5: return luminance_alpha_with_offset(v);
    case 6: return scaled(v, kOpaque, kOpaque);
    case 8: return direct(v, kOpaque, kOpaque);
    case 10: return scaled(v, v[4], v[5]);
    case 12: return direct(v, v[6], v[7]);
    case 9:
    case 13: return with_offset(v);
    default: return {kAstcErrorColor, kAstcErrorColor};
  }
}

}  // namespace quadrille::models
