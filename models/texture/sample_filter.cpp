/// The filter half of the texture unit: fetches the texels of a plan, decodes, weighs (sample.h).
#include "models/rop/quad_codec.h"
#include "models/rop/srgb.h"
#include "models/texture/block/block_format.h"
#include "models/texture/lanes.h"
#include "models/texture/sample.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace quadrille::models {
namespace {

/// Filtered channels of eight lanes, not yet scaled to 0..1.
struct LaneColor {
  __m256 channel[4];
};

struct Texels {
  __m256i corner[4];  ///< RGBA8, red in the low byte
  __m256i frac_x;     ///< 256ths
  __m256 weight_y;    ///< of the lower row, 256ths
};

/// Where the texels of a plan are, and their format: those of memory, or of decoded blocks.
struct TexelSource {
  const std::byte* base;
  Format format;
  std::size_t channels;  ///< that a border colours
};

/// A border as RGBA8, which is the same with and without sRGB encoding.
int border_code(BorderColor border, std::size_t channels) {
  if (border == BorderColor::kOpaqueWhite) return -1;
  return border == BorderColor::kOpaqueBlack || channels < 4 ? static_cast<int>(0xff000000u) : 0;
}

Texels fetch(const TexturePlan::Footprint& f, const TexelSource& source, BorderColor border) {
  Texels t;
  for (std::size_t i = 0; i < 4; ++i) {
    t.corner[i] =
        _mm256_i32gather_epi32(reinterpret_cast<const int*>(source.base), load_lanes(f.texel[i].data()), 4);
  }
  for (std::size_t i = 0; f.border != 0 && i < 4; ++i)
    t.corner[i] = _mm256_blendv_epi8(t.corner[i], _mm256_set1_epi32(border_code(border, source.channels)),
                                     lanes_of(f.border >> (8 * i)));
  t.frac_x = load_lanes(f.frac_x.data());
  t.weight_y = _mm256_cvtepi32_ps(load_lanes(f.frac_y.data()));
  return t;
}

/// One row of the 2x2 in 256ths: red and blue, or green and alpha, as two 16-bit sums a lane. 255 * 256 fits.
inline __m256i mix_row(__m256i left, __m256i right, __m256i weight_left, __m256i weight_right) {
  return _mm256_add_epi16(_mm256_mullo_epi16(left, weight_left), _mm256_mullo_epi16(right, weight_right));
}

/// Codes times 65536, exact: every step is an integer below 2^24.
LaneColor filter_unorm(const Texels& t) {
  const __m256i low_bytes = _mm256_set1_epi32(0x00ff00ff);
  const __m256i right = _mm256_or_si256(t.frac_x, _mm256_slli_epi32(t.frac_x, 16)),
                left = _mm256_sub_epi16(_mm256_set1_epi16(256), right);
  __m256i red_blue[2], green_alpha[2];
  for (int row = 0; row < 2; ++row) {
    const __m256i a = t.corner[2 * row], b = t.corner[2 * row + 1];
    red_blue[row] = mix_row(_mm256_and_si256(a, low_bytes), _mm256_and_si256(b, low_bytes), left, right);
    green_alpha[row] = mix_row(_mm256_srli_epi16(a, 8), _mm256_srli_epi16(b, 8), left, right);
  }
  const __m256 lower = t.weight_y, upper = _mm256_sub_ps(_mm256_set1_ps(256.0f), lower);
  const auto mix_rows = [&](__m256i top, __m256i bottom) {
    return _mm256_add_ps(_mm256_mul_ps(_mm256_cvtepi32_ps(top), upper),
                         _mm256_mul_ps(_mm256_cvtepi32_ps(bottom), lower));
  };
  const auto low_half = [](__m256i v) { return _mm256_and_si256(v, _mm256_set1_epi32(0xffff)); };
  const auto high_half = [](__m256i v) { return _mm256_srli_epi32(v, 16); };
  return {{mix_rows(low_half(red_blue[0]), low_half(red_blue[1])),
           mix_rows(low_half(green_alpha[0]), low_half(green_alpha[1])),
           mix_rows(high_half(red_blue[0]), high_half(red_blue[1])),
           mix_rows(high_half(green_alpha[0]), high_half(green_alpha[1]))}};
}

/// One 8-bit channel that is already in linear light and scaled to 0..1: decode, then two lerps across and
/// one down.
template <int shift>
__m256 filter_srgb_channel(const Texels& t, __m256 wx, __m256 wy) {
  __m256 value[4];
  for (int i = 0; i < 4; ++i) {
    const __m256i code = _mm256_and_si256(_mm256_srli_epi32(t.corner[i], shift), _mm256_set1_epi32(0xff));
    value[i] = _mm256_i32gather_ps(kSrgbToLinear.data(), code, 4);
  }
  const auto lerp = [](__m256 a, __m256 b, __m256 w) {
    return _mm256_add_ps(a, _mm256_mul_ps(_mm256_sub_ps(b, a), w));
  };
  return lerp(lerp(value[0], value[1], wx), lerp(value[2], value[3], wx), wy);
}

__m256 filter_unorm_alpha(const Texels& t) {
  const auto alpha = [&](int i) { return _mm256_srli_epi32(t.corner[i], 24); };
  const __m256i right = t.frac_x, left = _mm256_sub_epi32(_mm256_set1_epi32(256), right);
  const __m256 lower = t.weight_y, upper = _mm256_sub_ps(_mm256_set1_ps(256.0f), lower);
  const __m256 top = _mm256_cvtepi32_ps(mix_row(alpha(0), alpha(1), left, right));
  const __m256 bottom = _mm256_cvtepi32_ps(mix_row(alpha(2), alpha(3), left, right));
  return _mm256_add_ps(_mm256_mul_ps(top, upper), _mm256_mul_ps(bottom, lower));
}

/// Red, green and blue are linear 0..1, alpha is a code times 65536.
LaneColor filter_srgb(const Texels& t) {
  const __m256 scale = _mm256_set1_ps(1.0f / 256.0f);
  const __m256 wx = _mm256_mul_ps(_mm256_cvtepi32_ps(t.frac_x), scale), wy = _mm256_mul_ps(t.weight_y, scale);
  return {{filter_srgb_channel<0>(t, wx, wy), filter_srgb_channel<8>(t, wx, wy),
           filter_srgb_channel<16>(t, wx, wy), filter_unorm_alpha(t)}};
}

/// Components of eight texels, decoded: those of lanes 0 to 3, and of the others.
struct TexelColors {
  QuadColor half[2];
  [[nodiscard]] __m256 operator[](std::size_t c) const { return _mm256_set_m128(half[1][c], half[0][c]); }
};

/// Texels beyond the border: of the components that the format has.
void put_border(std::uint32_t lanes, BorderColor border, const TexelSource& source, TexelColors& colors) {
  const bool integers = number_kind(source.format) != NumberKind::kFloat;
  const __m128 one = integers ? _mm_castsi128_ps(_mm_set1_epi32(1)) : _mm_set1_ps(1.0f);
  for (std::size_t half = 0; half < 2; ++half) {
    const __m256i mask = lanes_of(lanes);
    const __m128 beyond =
        _mm_castsi128_ps(half == 0 ? _mm256_castsi256_si128(mask) : _mm256_extracti128_si256(mask, 1));
    for (std::size_t c = 0; c < source.channels; ++c) {
      const bool is_one =
          border == BorderColor::kOpaqueWhite || (border == BorderColor::kOpaqueBlack && c == 3);
      colors.half[half][c] = _mm_blendv_ps(colors.half[half][c], is_one ? one : _mm_setzero_ps(), beyond);
    }
  }
}

/// One of a footprint's corners, of any format.
TexelColors fetch_colors(const TexturePlan& plan, const TexturePlan::Footprint& f, std::size_t corner,
                         const TexelSource& source) {
  const FormatInfo& format = format_info(source.format);
  const std::array<std::int32_t, 8>& texel = f.texel[corner];
  TexelColors colors;
  for (std::size_t half = 0; half < 2; ++half) {
    alignas(16) std::array<std::byte, 64> quad{};
    for (std::size_t i = 0; i < 4; ++i)
      std::memcpy(quad.data() + i * format.bytes,
                  source.base + static_cast<std::size_t>(texel[4 * half + i]) * format.bytes, format.bytes);
    colors.half[half] = decode_quad(format, load_quad(quad.data(), format.bytes));
  }
  if (const std::uint32_t beyond = f.border >> (8 * corner) & 0xff; beyond != 0)
    put_border(beyond, plan.border, source, colors);
  return colors;
}

/// Any format, by its row of the table: all channels are numbers. Channels that it lacks are 0, alpha is 1.
LaneColor filter_any(const TexturePlan& plan, const TexturePlan::Footprint& f, const TexelSource& source) {
  // Bits, which arithmetic would change where they look like a NaN; their filter is always nearest.
  if (number_kind(source.format) != NumberKind::kFloat) {
    const TexelColors texel = fetch_colors(plan, f, 0, source);
    return {{texel[0], texel[1], texel[2], texel[3]}};
  }
  const __m256 scale = _mm256_set1_ps(1.0f / 256.0f);
  const auto weight = [scale](const std::array<std::int32_t, 8>& frac) {
    return _mm256_mul_ps(_mm256_cvtepi32_ps(load_lanes(frac.data())), scale);
  };
  const __m256 wx = weight(f.frac_x), wy = weight(f.frac_y);
  // A texel without weight counts for nothing, also where it is infinite.
  const auto lerp = [](__m256 a, __m256 b, __m256 w) {
    const __m256 mixed = _mm256_add_ps(a, _mm256_mul_ps(_mm256_sub_ps(b, a), w));
    return _mm256_blendv_ps(mixed, a, _mm256_cmp_ps(w, _mm256_setzero_ps(), _CMP_EQ_OQ));
  };
  TexelColors corner[4];
  for (std::size_t i = 0; i < 4; ++i) corner[i] = fetch_colors(plan, f, i, source);
  LaneColor color;
  for (std::size_t c = 0; c < 4; ++c)
    color.channel[c] = lerp(lerp(corner[0][c], corner[1][c], wx), lerp(corner[2][c], corner[3][c], wx), wy);
  return color;
}

/// Which of the ways above: the two for RGBA8 are the fast ones. Of BGRA8, red and blue are exchanged.
enum class Way : std::uint8_t { kUnorm, kSrgb, kAny };

bool is_bgra(Format format) { return format == Format::kB8G8R8A8Unorm || format == Format::kB8G8R8A8Srgb; }
Way way_of(Format format) {
  if (format == Format::kR8G8B8A8Unorm || format == Format::kB8G8R8A8Unorm) return Way::kUnorm;
  return format == Format::kR8G8B8A8Srgb || format == Format::kB8G8R8A8Srgb ? Way::kSrgb : Way::kAny;
}

template <Way way>
void filter_group(const TexturePlan& plan, std::size_t group, const TexelSource& source,
                  std::array<LaneFloats, 4>& rgba) {
  const auto filter = [&](std::size_t level) {
    const TexturePlan::Footprint& footprint = plan.footprint[group][level];
    if constexpr (way == Way::kSrgb) {
      return filter_srgb(fetch(footprint, source, plan.border));
    } else if constexpr (way == Way::kUnorm) {
      return filter_unorm(fetch(footprint, source, plan.border));
    } else {
      return filter_any(plan, footprint, source);
    }
  };
  LaneColor color = filter(0);
  if (plan.levels[group] == 2) {
    const LaneColor coarser = filter(1);
    const __m256 weight = _mm256_load_ps(plan.level_weight.data() + 8 * group);
    for (int c = 0; c < 4; ++c) {
      color.channel[c] = _mm256_add_ps(
          color.channel[c], _mm256_mul_ps(_mm256_sub_ps(coarser.channel[c], color.channel[c]), weight));
    }
  }
  if (way != Way::kAny && is_bgra(source.format)) std::swap(color.channel[0], color.channel[2]);
  const __m256 one = _mm256_set1_ps(255.0f * 65536.0f);
  for (std::size_t c = 0; c < 4; ++c) {
    const bool number = way == Way::kAny || (way == Way::kSrgb && c < 3);
    _mm256_storeu_ps(rgba[c].data() + 8 * group,
                     number ? color.channel[c] : _mm256_div_ps(color.channel[c], one));
  }
}

void filter(const TexturePlan& plan, const TexelSource& source, std::array<LaneFloats, 4>& rgba) {
  const Way way = way_of(source.format);
  for (std::size_t group = 0; group < TexturePlan::kGroups; ++group) {
    if (plan.levels[group] == 0) {
      for (LaneFloats& channel : rgba) _mm256_storeu_ps(channel.data() + 8 * group, _mm256_setzero_ps());
    } else if (way == Way::kSrgb) {
      filter_group<Way::kSrgb>(plan, group, source, rgba);
    } else if (way == Way::kUnorm) {
      filter_group<Way::kUnorm>(plan, group, source, rgba);
    } else {
      filter_group<Way::kAny>(plan, group, source, rgba);
    }
  }
}

/// Decodes the blocks of a plan, and filters what they hold.
void filter_blocks(const TexturePlan& plan, const std::byte* base, std::array<LaneFloats, 4>& rgba) {
  alignas(32) std::array<std::byte, TexturePlan::kMaxBlocks * sizeof(BlockTexels)> texels;
  const BlockCode code = block_code(plan.format);
  const BlockCodeInfo& info = block_code_info(code);
  const std::size_t block_texels = std::size_t{kBlockTexels} * info.decoded_bytes;
  BlockTexels block;
  for (std::size_t i = 0; i < static_cast<std::size_t>(plan.block_count); ++i) {
    decode_block(code, {base + std::size_t{plan.blocks[i]} * info.bytes, info.bytes}, block);
    std::memcpy(texels.data() + i * block_texels, block.bytes.data(), block_texels);
  }
  // Lanes that read nothing name the first texel.
  if (plan.block_count == 0) std::fill_n(texels.begin(), block_texels, std::byte{0});
  filter(plan, {texels.data(), decoded_format(plan.format), format_info(plan.format).channels}, rgba);
}

}  // namespace

void filter_texture(const TexturePlan& plan, const DeviceMemory& memory, std::array<LaneFloats, 4>& rgba) {
  const std::byte* const base = memory.data() + plan.base;
  if (is_block_format(plan.format)) return filter_blocks(plan, base, rgba);
  filter(plan, {base, plan.format, format_info(plan.format).channels}, rgba);
}

}  // namespace quadrille::models
