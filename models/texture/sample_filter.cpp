/// The filter half of the texture unit: fetches the texels of a plan, decodes, weighs (sample.h).
#include "models/rop/quad_codec.h"
#include "models/texture/block/block_format.h"
#include "models/texture/lanes.h"
#include "models/texture/rgba8_filter.h"
#include "models/texture/sample.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

namespace quadrille::models {
namespace {

/// Components of eight texels, decoded: those of lanes 0 to 3, and of the others.
struct TexelColors {
  QuadColor half[2];
  [[nodiscard]] __m256 operator[](std::size_t c) const { return _mm256_set_m128(half[1][c], half[0][c]); }
};

/// A component of what lies beyond an image of that format: the bits of a float or an integer.
std::uint32_t border_bits(const TexturePlan& plan, Format format, std::size_t c) {
  const bool integers = number_kind(format) != NumberKind::kFloat;
  if (plan.border != BorderColor::kOwn) {
    const bool is_one =
        plan.border == BorderColor::kOpaqueWhite || (plan.border == BorderColor::kOpaqueBlack && c == 3);
    return !is_one ? 0 : integers ? 1 : std::bit_cast<std::uint32_t>(1.0f);
  }
  const Numeric numeric = format_info(format).numeric;
  const auto value = std::bit_cast<float>(plan.border_bits[c]);
  if (numeric == Numeric::kUnorm || numeric == Numeric::kSrgb)
    return std::bit_cast<std::uint32_t>(std::clamp(value, 0.0f, 1.0f));
  if (numeric == Numeric::kSnorm) return std::bit_cast<std::uint32_t>(std::clamp(value, -1.0f, 1.0f));
  return plan.border_bits[c];
}

/// Texels beyond the border: of the components that the format has.
void put_border(std::uint32_t lanes, const TexturePlan& plan, const TexelSource& source,
                TexelColors& colors) {
  const __m256 beyond = _mm256_castsi256_ps(lanes_of(lanes));
  for (std::size_t c = 0; c < source.channels; ++c) {
    const auto bits = static_cast<int>(border_bits(plan, source.format, c));
    const __m128 border = _mm_castsi128_ps(_mm_set1_epi32(bits));
    colors.half[0][c] = _mm_blendv_ps(colors.half[0][c], border, _mm256_castps256_ps128(beyond));
    colors.half[1][c] = _mm_blendv_ps(colors.half[1][c], border, _mm256_extractf128_ps(beyond, 1));
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
      source.fetch(texel[4 * half + i], format.bytes, quad.data() + i * format.bytes);
    colors.half[half] = decode_quad(format, load_quad(quad.data(), format.bytes));
  }
  if (const std::uint32_t beyond = f.border >> (8 * corner) & 0xff; beyond != 0)
    put_border(beyond, plan, source, colors);
  return colors;
}

/// All ones in the lanes where `reference` compares so with the texel.
__m256 passes(CompareOp op, __m256 reference, __m256 texel) {
  switch (op) {
    case CompareOp::kNever: break;
    case CompareOp::kLess: return _mm256_cmp_ps(reference, texel, _CMP_LT_OQ);
    case CompareOp::kEqual: return _mm256_cmp_ps(reference, texel, _CMP_EQ_OQ);
    case CompareOp::kLessOrEqual: return _mm256_cmp_ps(reference, texel, _CMP_LE_OQ);
    case CompareOp::kGreater: return _mm256_cmp_ps(reference, texel, _CMP_GT_OQ);
    case CompareOp::kNotEqual: return _mm256_cmp_ps(reference, texel, _CMP_NEQ_UQ);
    case CompareOp::kGreaterOrEqual: return _mm256_cmp_ps(reference, texel, _CMP_GE_OQ);
    case CompareOp::kAlways: return _mm256_castsi256_ps(_mm256_set1_epi32(-1));
  }
  return _mm256_setzero_ps();
}

/// Depths become what their comparison gives: 1 or 0. A reference for a format of 0 to 1 is limited to that.
void compare_corners(const TexturePlan& plan, std::size_t group, const FormatInfo& format,
                     TexelColors (&corner)[4]) {
  const __m256 one = _mm256_set1_ps(1.0f);
  __m256 reference = _mm256_loadu_ps(plan.reference.data() + 8 * group);
  if (format.numeric == Numeric::kUnorm)
    reference = _mm256_min_ps(_mm256_max_ps(reference, _mm256_setzero_ps()), one);
  for (TexelColors& texel : corner) {
    const __m256 result = _mm256_and_ps(passes(plan.compare, reference, texel[0]), one);
    texel.half[0][0] = _mm256_castps256_ps128(result);
    texel.half[1][0] = _mm256_extractf128_ps(result, 1);
  }
}

/// A corner that no face of the cube has is the mean of the other three, or of integers one of them.
void fill_missing(std::uint32_t missing, bool integers, TexelColors (&corner)[4]) {
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t lanes = missing >> (8 * i) & 0xff;
    if (lanes == 0) continue;
    const __m256i mask = lanes_of(lanes);
    const __m128 masks[2] = {_mm_castsi128_ps(_mm256_castsi256_si128(mask)),
                             _mm_castsi128_ps(_mm256_extracti128_si256(mask, 1))};
    for (std::size_t half = 0; half < 2; ++half)
      for (std::size_t c = 0; c < 4; ++c) {
        const auto at = [&](std::size_t k) { return corner[(i + k) % 4].half[half][c]; };
        const __m128 mean =
            integers ? at(1) : _mm_div_ps(_mm_add_ps(_mm_add_ps(at(1), at(2)), at(3)), _mm_set1_ps(3.0f));
        corner[i].half[half][c] = _mm_blendv_ps(at(0), mean, masks[half]);
      }
  }
}

/// Between a and b. What has no weight counts for nothing, also where it is infinite.
__m256 lerp_lanes(__m256 a, __m256 b, __m256 w) {
  const __m256 mixed = _mm256_add_ps(a, _mm256_mul_ps(_mm256_sub_ps(b, a), w));
  return _mm256_blendv_ps(mixed, a, _mm256_cmp_ps(w, _mm256_setzero_ps(), _CMP_EQ_OQ));
}

/// Any format, by its row of the table: all channels are numbers. Channels that it lacks are 0, alpha is 1.
LaneColor filter_any(const TexturePlan& plan, std::size_t group, const TexturePlan::Footprint& f,
                     const TexelSource& source) {
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
  TexelColors corner[4];
  for (std::size_t i = 0; i < 4; ++i) corner[i] = fetch_colors(plan, f, i, source);
  if (plan.general && plan.compares) compare_corners(plan, group, format_info(source.format), corner);
  if (f.missing != 0) fill_missing(f.missing, false, corner);
  LaneColor color;
  for (std::size_t c = 0; c < 4; ++c)
    color.channel[c] = lerp_lanes(lerp_lanes(corner[0][c], corner[1][c], wx),
                                  lerp_lanes(corner[2][c], corner[3][c], wx), wy);
  return color;
}

/// The mean of an ellipse's texels by their weights. What has no weight counts for nothing, also where it is
/// infinite.
LaneColor filter_ellipse(const TexturePlan& plan, std::size_t group, const TexelSource& source) {
  const __m256 zero = _mm256_setzero_ps();
  LaneColor sum{{zero, zero, zero, zero}};
  __m256 weights = zero;
  for (std::size_t tap = 0; tap < plan.taps[group]; ++tap) {
    TexelColors corner[4];
    for (std::size_t i = 0; i < 4; ++i) corner[i] = fetch_colors(plan, plan.footprint[group][tap], i, source);
    if (plan.compares) compare_corners(plan, group, format_info(source.format), corner);
    for (std::size_t i = 0; i < 4; ++i) {
      const __m256 weight = _mm256_loadu_ps(plan.weight[group][tap][i].data());
      const __m256 counts = _mm256_cmp_ps(weight, zero, _CMP_GT_OQ);
      weights = _mm256_add_ps(weights, weight);
      for (std::size_t c = 0; c < 4; ++c)
        sum.channel[c] =
            _mm256_add_ps(sum.channel[c], _mm256_and_ps(counts, _mm256_mul_ps(corner[i][c], weight)));
    }
  }
  // Lanes without an ellipse have no weights.
  weights = _mm256_blendv_ps(_mm256_set1_ps(1.0f), weights, _mm256_cmp_ps(weights, zero, _CMP_GT_OQ));
  for (__m256& channel : sum.channel) channel = _mm256_div_ps(channel, weights);
  return sum;
}

/// Which of the ways above: the two for RGBA8 are the fast ones. Of BGRA8, red and blue are exchanged.
enum class Way : std::uint8_t { kUnorm, kSrgb, kAny };

bool is_bgra(Format format) { return format == Format::kB8G8R8A8Unorm || format == Format::kB8G8R8A8Srgb; }
Way way_of(Format format) {
  if (format == Format::kR8G8B8A8Unorm || format == Format::kB8G8R8A8Unorm) return Way::kUnorm;
  return format == Format::kR8G8B8A8Srgb || format == Format::kB8G8R8A8Srgb ? Way::kSrgb : Way::kAny;
}

/// A cube's corners, comparisons, ellipses and borders of an own colour are done with numbers. So that no
/// lane's way depends on another's, all of such plans is.
Way way_of(const TexturePlan& plan, Format format) {
  const bool numbers = plan.border == BorderColor::kOwn ||
                       (plan.general && (plan.compares || plan.weighed || is_cube(plan.kind) ||
                                         plan.ask != TextureAsk::kSample));
  return numbers ? Way::kAny : way_of(format);
}

template <Way way>
LaneColor filter_tap(const TexturePlan& plan, std::size_t group, std::size_t tap, const TexelSource& source) {
  const TexturePlan::Footprint& footprint = plan.footprint[group][tap];
  if constexpr (way == Way::kSrgb) return filter_srgb(fetch_rgba8(footprint, source, plan.border));
  else if constexpr (way == Way::kUnorm) return filter_unorm(fetch_rgba8(footprint, source, plan.border));
  else return filter_any(plan, group, footprint, source);
}

/// The mean of a level's samples along an axis, or what lies between its two slices.
template <Way way>
LaneColor filter_level(const TexturePlan& plan, std::size_t group, std::size_t level,
                       const TexelSource& source) {
  if constexpr (way == Way::kAny)
    if (plan.general && plan.weighed) return filter_ellipse(plan, group, source);
  const std::size_t taps = plan.general ? plan.taps[group] : 1;
  LaneColor color = filter_tap<way>(plan, group, level * taps, source);
  if (taps == 1) return color;
  if (plan.slices) {
    const LaneColor behind = filter_tap<way>(plan, group, level * taps + 1, source);
    const __m256 weight = _mm256_loadu_ps(plan.slice_weight[level].data() + 8 * group);
    for (std::size_t c = 0; c < 4; ++c)
      color.channel[c] = lerp_lanes(color.channel[c], behind.channel[c], weight);
    return color;
  }
  const __m256 count = _mm256_loadu_ps(plan.samples.data() + 8 * group);
  for (std::size_t tap = 1; tap < taps; ++tap) {
    const LaneColor more = filter_tap<way>(plan, group, level * taps + tap, source);
    const __m256 counts = _mm256_cmp_ps(_mm256_set1_ps(static_cast<float>(tap + 1)), count, _CMP_LE_OQ);
    for (std::size_t c = 0; c < 4; ++c)
      color.channel[c] =
          _mm256_blendv_ps(color.channel[c], _mm256_add_ps(color.channel[c], more.channel[c]), counts);
  }
  for (std::size_t c = 0; c < 4; ++c) color.channel[c] = _mm256_div_ps(color.channel[c], count);
  return color;
}

template <Way way>
void filter_group(const TexturePlan& plan, std::size_t group, const TexelSource& source,
                  std::array<LaneFloats, 4>& rgba) {
  LaneColor color = filter_level<way>(plan, group, 0, source);
  if (plan.levels[group] == 2) {
    const LaneColor coarser = filter_level<way>(plan, group, 1, source);
    const __m256 weight = _mm256_load_ps(plan.level_weight.data() + 8 * group);
    for (std::size_t c = 0; c < 4; ++c) {
      if constexpr (way == Way::kAny) {
        color.channel[c] = lerp_lanes(color.channel[c], coarser.channel[c], weight);
      } else {
        color.channel[c] = _mm256_add_ps(
            color.channel[c], _mm256_mul_ps(_mm256_sub_ps(coarser.channel[c], color.channel[c]), weight));
      }
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

/// 1 of a format of integers, else 1.0.
__m256 one_of(Format format) {
  return number_kind(format) == NumberKind::kFloat ? _mm256_set1_ps(1.0f)
                                                   : _mm256_castsi256_ps(_mm256_set1_epi32(1));
}

/// Components in the order that the view shows.
void map_components(const TexturePlan& plan, std::array<LaneFloats, 4>& rgba) {
  const std::array<LaneFloats, 4> texel = rgba;
  for (std::size_t c = 0; c < 4; ++c) {
    const ComponentSource source = plan.components[c];
    if (source <= ComponentSource::kAlpha) {
      rgba[c] = texel[static_cast<std::size_t>(source)];
      continue;
    }
    const __m256 number = source == ComponentSource::kOne ? one_of(plan.format) : _mm256_setzero_ps();
    for (std::size_t lane = 0; lane < kWarpLanes; lane += 8) _mm256_storeu_ps(rgba[c].data() + lane, number);
  }
}

/// A component of the corners: lower left, lower right, upper right, upper left. [VK1.3 #textures-gather]
void gather_group(const TexturePlan& plan, std::size_t group, const TexelSource& source,
                  std::array<LaneFloats, 4>& rgba) {
  const TexturePlan::Footprint& f = plan.footprint[group][0];
  TexelColors corner[4];
  for (std::size_t i = 0; i < 4; ++i) corner[i] = fetch_colors(plan, f, i, source);
  if (plan.compares) compare_corners(plan, group, format_info(source.format), corner);
  if (f.missing != 0) fill_missing(f.missing, number_kind(source.format) != NumberKind::kFloat, corner);
  constexpr std::size_t kOrder[4] = {2, 3, 1, 0};
  const ComponentSource shown = plan.compares ? ComponentSource::kRed : plan.components[plan.component];
  const __m256 number = shown == ComponentSource::kOne ? one_of(source.format) : _mm256_setzero_ps();
  for (std::size_t k = 0; k < 4; ++k)
    _mm256_storeu_ps(rgba[k].data() + 8 * group, shown <= ComponentSource::kAlpha
                                                     ? corner[kOrder[k]][static_cast<std::size_t>(shown)]
                                                     : number);
}

void answer_level(const TexturePlan& plan, std::array<LaneFloats, 4>& rgba) {
  rgba = {};
  rgba[0] = plan.level_of_detail[0];
  rgba[1] = plan.level_of_detail[1];
}

void filter(const TexturePlan& plan, const TexelSource& source, std::array<LaneFloats, 4>& rgba) {
  const bool gathers = plan.general && plan.ask == TextureAsk::kGather;
  const Way way = way_of(plan, source.format);
  for (std::size_t group = 0; group < TexturePlan::kGroups; ++group) {
    if (plan.levels[group] == 0) {
      for (LaneFloats& channel : rgba) _mm256_storeu_ps(channel.data() + 8 * group, _mm256_setzero_ps());
    } else if (gathers) {
      gather_group(plan, group, source, rgba);
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
  // Kept from request to request: a plan may have thousands of blocks, and nearly all have few.
  thread_local std::vector<std::byte> texels;
  const BlockCode code = block_code(plan.format);
  const BlockCodeInfo& info = block_code_info(code);
  // Texels of a block lie together, and blocks as far apart as their indices have them.
  const std::size_t bytes = std::size_t{info.texels()} * info.decoded_bytes;
  const std::size_t apart = std::size_t{info.decoded_bytes} << block_places(plan.format).place_bits;
  texels.resize(std::max({texels.size(), apart, static_cast<std::size_t>(plan.block_count) * apart}));
  BlockTexels block;
  for (std::size_t i = 0; i < static_cast<std::size_t>(plan.block_count); ++i) {
    decode_block(code, {base + std::size_t{plan.blocks[i]} * info.bytes, info.bytes}, block);
    std::memcpy(texels.data() + i * apart, block.bytes.data(), bytes);
  }
  // Lanes that read nothing name the first texel, whose components that the format lacks are still read.
  if (plan.block_count == 0) {
    constexpr std::array<std::byte, kMaxBlockBytes> kZeros{};
    decode_block(code, {kZeros.data(), info.bytes}, block);
    std::memcpy(texels.data(), block.bytes.data(), bytes);
  }
  filter(plan, {texels.data(), decoded_format(plan.format), format_info(plan.format).channels}, rgba);
}

}  // namespace

void filter_texture(const TexturePlan& plan, const DeviceMemory& memory, std::array<LaneFloats, 4>& rgba) {
  if (plan.general && plan.ask == TextureAsk::kQueryLod) return answer_level(plan, rgba);
  const std::byte* const base = memory.data() + plan.base;
  if (is_block_format(plan.format)) filter_blocks(plan, base, rgba);
  else filter(plan, {base, plan.format, format_info(plan.format).channels, plan.plane_row_shift}, rgba);
  const bool mapped = plan.components != kSameComponents;
  if (mapped && !(plan.general && (plan.compares || plan.ask == TextureAsk::kGather)))
    map_components(plan, rgba);
}

}  // namespace quadrille::models
