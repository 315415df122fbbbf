/// Texel addresses of eight lanes in one mip level: wrapping, rounding to the sub-texel grid, tiling. [VK1.3
/// #textures-texel-coordinate-systems, #textures-wrapping-operation]
#pragma once

#include "models/base/sampler.h"
#include "models/texture/lanes.h"
#include "models/texture/layout.h"

namespace quadrille::models {

/// The two texels along an axis and the weight of the second, in 256ths.
struct AxisTexels {
  __m256i first, second, weight;
};

/// Brings a finite coordinate (in texture sizes) to where one multiplication by the size cannot overflow,
/// without changing the texels it selects: repeat to [0, 1], mirror to [0, 2], others to [-1, 2].
inline __m256 fold_coordinate(__m256 c, Wrap wrap) {
  switch (wrap) {
    case Wrap::kRepeat: return _mm256_sub_ps(c, _mm256_floor_ps(c));
    case Wrap::kMirroredRepeat: {
      const __m256 periods = _mm256_floor_ps(_mm256_mul_ps(c, _mm256_set1_ps(0.5f)));
      return _mm256_sub_ps(c, _mm256_add_ps(periods, periods));
    }
    case Wrap::kClampToEdge:
    case Wrap::kClampToBorder:
    case Wrap::kMirrorClampToEdge: break;
  }
  return _mm256_min_ps(_mm256_max_ps(c, _mm256_set1_ps(-1.0f)), _mm256_set1_ps(2.0f));
}

/// Wraps a texel index that is at most one texel outside the range of folded coordinates. One beyond a border
/// becomes the texel at the edge, which is not read (`outside`).
inline __m256i wrap_texel(__m256i i, __m256i size, Wrap wrap) {
  const __m256i zero = _mm256_setzero_si256(), one = _mm256_set1_epi32(1);
  switch (wrap) {
    case Wrap::kRepeat: {
      const __m256i from_below = _mm256_add_epi32(i, _mm256_and_si256(_mm256_cmpgt_epi32(zero, i), size));
      return _mm256_andnot_si256(_mm256_cmpeq_epi32(from_below, size), from_below);
    }
    case Wrap::kMirroredRepeat: {
      const __m256i mirrored = _mm256_sub_epi32(_mm256_add_epi32(size, size), _mm256_add_epi32(i, one));
      return _mm256_max_epi32(_mm256_min_epi32(i, mirrored), zero);
    }
    case Wrap::kMirrorClampToEdge:  // -1 - i where i is negative
      return _mm256_min_epi32(_mm256_xor_si256(i, _mm256_srai_epi32(i, 31)), _mm256_sub_epi32(size, one));
    case Wrap::kClampToEdge:
    case Wrap::kClampToBorder: break;
  }
  return _mm256_max_epi32(_mm256_min_epi32(i, _mm256_sub_epi32(size, one)), zero);
}

/// Lanes whose index is beyond the border.
inline __m256i outside(__m256i i, __m256i size, Wrap wrap) {
  if (wrap != Wrap::kClampToBorder) return _mm256_setzero_si256();
  const __m256i inside =
      _mm256_andnot_si256(_mm256_cmpgt_epi32(_mm256_setzero_si256(), i), _mm256_cmpgt_epi32(size, i));
  return _mm256_xor_si256(inside, _mm256_set1_epi32(-1));
}

/// Texels for linear filtering of a folded coordinate, not yet wrapped.
inline AxisTexels linear_texels(__m256 folded, __m256i size, int subtexel_bits) {
  const __m128i bits = _mm_cvtsi32_si128(subtexel_bits);
  const __m256 scale = _mm256_cvtepi32_ps(_mm256_sll_epi32(size, bits));
  const __m256i half = _mm256_set1_epi32((1 << subtexel_bits) >> 1);
  const __m256i fixed = _mm256_sub_epi32(_mm256_cvtps_epi32(_mm256_mul_ps(folded, scale)), half);
  const __m256i first = _mm256_sra_epi32(fixed, bits);
  const __m256i fraction = _mm256_and_si256(fixed, _mm256_set1_epi32((1 << subtexel_bits) - 1));
  return {first, _mm256_add_epi32(first, _mm256_set1_epi32(1)),
          _mm256_sll_epi32(fraction, _mm_cvtsi32_si128(8 - subtexel_bits))};
}

/// The one texel for nearest filtering, twice, without weight for the second; not yet wrapped.
inline AxisTexels nearest_texels(__m256 folded, __m256i size) {
  const __m256i texel = _mm256_cvttps_epi32(_mm256_floor_ps(_mm256_mul_ps(folded, _mm256_cvtepi32_ps(size))));
  return {texel, texel, _mm256_setzero_si256()};
}

inline AxisTexels wrapped(const AxisTexels& texels, __m256i size, Wrap wrap) {
  return {wrap_texel(texels.first, size, wrap), wrap_texel(texels.second, size, wrap), texels.weight};
}

/// `b` in the lanes of `mask`, else `a`.
inline AxisTexels select(const AxisTexels& a, const AxisTexels& b, __m256i mask) {
  return {_mm256_blendv_epi8(a.first, b.first, mask), _mm256_blendv_epi8(a.second, b.second, mask),
          _mm256_blendv_epi8(a.weight, b.weight, mask)};
}

/// Places divided by the side of a block (1..12), of places below 2^14.
inline __m256i blocks_before(__m256i place, std::uint32_t side) {
  // The quotient is exact: what rounding the factor up adds stays below a step of the quotient.
  const auto factor = static_cast<int>(((1u << 18) + side - 1) / side);
  return _mm256_srli_epi32(_mm256_mullo_epi32(place, _mm256_set1_epi32(factor)), 18);
}

/// A column and a row in the tiling of textures; the row within its tile of 32.
inline __m256i texture_column(__m256i x) {
  const auto field = [x](int mask) { return _mm256_and_si256(x, _mm256_set1_epi32(mask)); };
  const __m256i low = _mm256_or_si256(field(3), _mm256_slli_epi32(field(4), 1));
  return _mm256_or_si256(_mm256_or_si256(low, _mm256_slli_epi32(field(24), 2)),
                         _mm256_slli_epi32(_mm256_srli_epi32(x, 5), 10));
}
inline __m256i texture_row_in_tile(__m256i y) {
  const auto field = [y](int mask) { return _mm256_and_si256(y, _mm256_set1_epi32(mask)); };
  const __m256i low = _mm256_or_si256(_mm256_slli_epi32(field(1), 2), _mm256_slli_epi32(field(2), 3));
  return _mm256_or_si256(low, _mm256_slli_epi32(field(28), 5));
}

/// The part of a column in Morton order, in squares of a side of 2^`bits`. Of a row, which has the odd bits,
/// `shift` is 1.
inline __m256i morton_part(__m256i v, __m256i bits, int shift) {
  const auto spread = [](__m256i u, int by, int mask) {
    return _mm256_and_si256(_mm256_or_si256(u, _mm256_slli_epi32(u, by)), _mm256_set1_epi32(mask));
  };
  const __m256i beyond = _mm256_srlv_epi32(v, bits);
  const __m256i within = _mm256_sub_epi32(v, _mm256_sllv_epi32(beyond, bits));
  const __m256i spread_by_two = spread(spread(spread(within, 8, 0x00ff00ff), 4, 0x0f0f0f0f), 2, 0x33333333);
  const __m256i alternate = _mm256_slli_epi32(spread(spread_by_two, 1, 0x55555555), shift);
  return _mm256_add_epi32(alternate, _mm256_sllv_epi32(beyond, _mm256_add_epi32(bits, bits)));
}

/// The parts of a texel's or a block's index that its column and its row contribute
/// (TextureLayout::unit_index).
inline __m256i column_index(__m256i x, __m256i pitch, const TextureLayout& layout) {
  switch (layout.tiling) {
    case Tiling::kTiled: break;
    case Tiling::kLinear:
    case Tiling::kWilliams: return x;
    case Tiling::kMorton: return morton_part(x, pitch, 0);
    case Tiling::kSurface: {
      const auto field = [x](int mask) { return _mm256_and_si256(x, _mm256_set1_epi32(mask)); };
      const __m256i low = _mm256_or_si256(field(1), _mm256_slli_epi32(field(6), 1));
      return _mm256_or_si256(low, _mm256_slli_epi32(_mm256_srli_epi32(x, 3), layout.tile_shift));
    }
  }
  return texture_column(x);
}
inline __m256i row_index(__m256i y, __m256i pitch, const TextureLayout& layout) {
  switch (layout.tiling) {
    case Tiling::kTiled: break;
    case Tiling::kLinear:
    case Tiling::kWilliams: return _mm256_mullo_epi32(y, pitch);
    case Tiling::kMorton: return morton_part(y, pitch, 1);
    case Tiling::kSurface: {
      const auto field = [y](int mask) { return _mm256_and_si256(y, _mm256_set1_epi32(mask)); };
      const __m256i low = _mm256_or_si256(_mm256_slli_epi32(field(1), 1), _mm256_slli_epi32(field(6), 3));
      return _mm256_add_epi32(low, _mm256_mullo_epi32(_mm256_srli_epi32(y, 3), pitch));
    }
  }
  return _mm256_add_epi32(texture_row_in_tile(y), _mm256_mullo_epi32(_mm256_srli_epi32(y, 5), pitch));
}

/// The parts of a texel's index that x and y contribute (TextureLayout::texel_index).
inline __m256i x_index(__m256i x, __m256i pitch, const TextureLayout& layout) {
  if (!layout.in_blocks()) return column_index(x, pitch, layout);
  const BlockPlaces& blocks = layout.blocks;
  const __m256i column = blocks_before(x, blocks.width);
  const __m256i in_block =
      _mm256_sub_epi32(x, _mm256_mullo_epi32(column, _mm256_set1_epi32(static_cast<int>(blocks.width))));
  return _mm256_add_epi32(in_block,
                          _mm256_slli_epi32(column_index(column, pitch, layout), blocks.place_bits));
}
inline __m256i y_index(__m256i y, __m256i pitch, const TextureLayout& layout) {
  if (!layout.in_blocks()) return row_index(y, pitch, layout);
  const BlockPlaces& blocks = layout.blocks;
  const auto times = [](__m256i v, std::uint32_t factor) {
    return _mm256_mullo_epi32(v, _mm256_set1_epi32(static_cast<int>(factor)));
  };
  const __m256i row = blocks_before(y, blocks.height);
  const __m256i in_block = times(_mm256_sub_epi32(y, times(row, blocks.height)), blocks.width);
  return _mm256_add_epi32(in_block, _mm256_slli_epi32(row_index(row, pitch, layout), blocks.place_bits));
}

/// Of eight texels, where a component lies in Williams' layout (`plane_index`).
inline __m256i plane_indices(__m256i first, int row_shift, int component) {
  if (component == 0) return first;
  if (component == 3) return _mm256_add_epi32(first, _mm256_set1_epi32(1 << 2 * row_shift));
  const __m256i column = _mm256_and_si256(first, _mm256_set1_epi32((1 << row_shift) - 1));
  // The highest bit of a small number is what its exponent says as a float.
  const __m256i exponent = _mm256_sub_epi32(
      _mm256_srli_epi32(_mm256_castps_si256(_mm256_cvtepi32_ps(column)), 23), _mm256_set1_epi32(127));
  const __m256i side = _mm256_sllv_epi32(_mm256_set1_epi32(1), exponent);
  const __m256i below = _mm256_add_epi32(first, _mm256_slli_epi32(side, row_shift));
  return component == 1 ? below : _mm256_sub_epi32(below, side);
}

}  // namespace quadrille::models
