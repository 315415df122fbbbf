/// What the two planners of texture requests share: the place of a level, wrapping along an axis, the list of
/// distinct lines, the count of work.
#pragma once

#include "models/texture/address.h"
#include "models/texture/block/block_format.h"
#include "models/texture/sample.h"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace quadrille::models {

/// Size and place of the level that each of eight lanes reads.
struct LevelVectors {
  __m256i width, height, pitch, first;
};

/// Lanes of a group nearly always agree on the level; only those of `used` matter.
inline LevelVectors level_vectors(const TextureLayout& layout, __m256i level, std::uint32_t used) {
  alignas(32) std::array<std::int32_t, 8> lanes;
  store_lanes(lanes.data(), level);
  const auto common = static_cast<std::size_t>(lanes[static_cast<std::size_t>(std::countr_zero(used) & 7)]);
  const std::uint32_t agree = bits_of(_mm256_cmpeq_epi32(level, _mm256_set1_epi32(static_cast<int>(common))));
  if ((agree & used) == used) {
    return {_mm256_set1_epi32(layout.width[common]), _mm256_set1_epi32(layout.height[common]),
            _mm256_set1_epi32(layout.pitch[common]), _mm256_set1_epi32(layout.first[common])};
  }
  const auto gather = [level](const std::array<std::int32_t, 16>& by_level) {
    return _mm256_i32gather_epi32(by_level.data(), level, 4);
  };
  return {gather(layout.width), gather(layout.height), gather(layout.pitch), gather(layout.first)};
}

/// What both planners fill in before they plan.
inline void begin_plan(const TextureView& view, const SamplerState& sampler, const TextureRequest& request,
                       bool general, TexturePlan& plan) {
  plan.general = general;
  plan.active = request.active;
  plan.base = view.base;
  plan.format = view.format;
  plan.border = sampler.border;
  if (plan.border == BorderColor::kOwn) plan.border_bits = sampler.border_bits;
  plan.components = view.components;
  plan.plane_row_shift = view.layout.plane_row_shift();
  plan.bilinear_quads = plan.texels = 0;
}

/// Collects the distinct lines of a request.
class LineCollector {
 public:
  explicit LineCollector(TexturePlan& plan)
      : plan_(plan),
        texel_shift_(plan.plane_row_shift != 0 ? 0
                                               : std::countr_zero(format_bytes(plan.format)) -
                                                     block_places(plan.format).place_bits) {
    plan_.line_count = 0;
  }

  /// Adds the lines of one footprint, in order of corner and lane; lanes outside `used` touch nothing, and so
  /// do corners of `border`.
  void add(const __m256i (&texel)[4], std::uint32_t used, std::uint32_t border) {
    add_places(texel, used, border);
    if (plan_.plane_row_shift == 0) return;
    for (int component = 1; component < 4; ++component) {
      __m256i byte[4];
      for (std::size_t corner = 0; corner < 4; ++corner)
        byte[corner] = plane_indices(texel[corner], plan_.plane_row_shift, component);
      add_places(byte, used, border);
    }
  }

 private:
  void add_places(const __m256i (&texel)[4], std::uint32_t used, std::uint32_t border) {
    const __m256i base_line = _mm256_set1_epi32(static_cast<int>(plan_.base / kLineBytes));
    const __m256i mask = lanes_of(used);
    __m256i line[4], sector[4];
    alignas(32) std::array<std::uint32_t, 32> numbers;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      line[corner] = _mm256_add_epi32(base_line, _mm256_srli_epi32(texel[corner], 7 - texel_shift_));
      const __m256i which =
          _mm256_and_si256(_mm256_srli_epi32(texel[corner], 5 - texel_shift_), _mm256_set1_epi32(3));
      sector[corner] = _mm256_and_si256(_mm256_sllv_epi32(_mm256_set1_epi32(1), which), mask);
      _mm256_store_si256(reinterpret_cast<__m256i*>(numbers.data() + 8 * corner), line[corner]);
    }
    for (std::size_t corner = 0; border != 0 && corner < 4; ++corner)
      sector[corner] = _mm256_andnot_si256(lanes_of(border >> (8 * corner)), sector[corner]);
    std::uint32_t left = used * 0x01010101u & ~border;
    while (left != 0) {
      const std::uint32_t number = numbers[static_cast<std::size_t>(std::countr_zero(left))];
      const __m256i wanted = _mm256_set1_epi32(static_cast<int>(number));
      __m256i sectors = _mm256_setzero_si256();
      for (int corner = 0; corner < 4; ++corner) {
        const __m256i equal = _mm256_cmpeq_epi32(line[corner], wanted);
        sectors = _mm256_or_si256(sectors, _mm256_and_si256(equal, sector[corner]));
        left &= ~(bits_of(equal) << (8 * corner));
      }
      note(number, any_lane(sectors));
    }
  }

  /// Bitwise or over eight lanes.
  static std::uint32_t any_lane(__m256i v) {
    __m128i half = _mm_or_si128(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
    half = _mm_or_si128(half, _mm_shuffle_epi32(half, 0x4e));
    half = _mm_or_si128(half, _mm_shuffle_epi32(half, 0xb1));
    return static_cast<std::uint32_t>(_mm_cvtsi128_si32(half));
  }

  /// Adds sectors of one line. A table leads to the line that last had this hash; only if that is another one
  /// is the list searched.
  void note(std::uint32_t number, std::uint32_t sectors) {
    const std::size_t bucket = (number ^ number >> 6) & 63;
    const std::uint64_t bit = std::uint64_t{1} << bucket;
    std::size_t index = (seen_ & bit) != 0 ? latest_[bucket] : static_cast<std::size_t>(plan_.line_count);
    if ((seen_ & bit) != 0 && plan_.lines[index].line != number) index = search(number);
    if (index == static_cast<std::size_t>(plan_.line_count)) {
      plan_.lines[index] = {number, 0};
      ++plan_.line_count;
    }
    plan_.lines[index].sectors |= sectors;
    seen_ |= bit;
    latest_[bucket] = static_cast<std::uint16_t>(index);
  }

  /// Place of a line in the list, or the list's length.
  [[nodiscard]] std::size_t search(std::uint32_t number) const {
    const auto count = static_cast<std::size_t>(plan_.line_count);
    std::size_t i = 0;
    while (i < count && plan_.lines[i].line != number) ++i;
    return i;
  }

  TexturePlan& plan_;
  int texel_shift_;         // log2 of a texel's bytes; below 0 where a block has more places than bytes
  std::uint64_t seen_ = 0;  // buckets of which `latest_` is set
  std::array<std::uint16_t, 64> latest_;  // index of the line that a hash met last
};

/// Collects the distinct blocks of a request, and lets footprints name them by their places.
class BlockCollector {
 public:
  /// `most`: blocks that the request can have; a power of two.
  BlockCollector(TexturePlan& plan, std::size_t most)
      : plan_(plan), places_(2 * most), place_bits_(block_places(plan.format).place_bits) {
    plan_.block_count = 0;
    if (!is_block_format(plan.format)) return;
    std::fill_n(place_.begin(), places_, kNone);
    line_shift_ = decoded_line_shift(plan.format);
  }
  void add(TexturePlan::Footprint& footprint, std::uint32_t used) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const std::uint32_t read = used & ~((footprint.border | footprint.missing) >> (8 * corner));
      for (std::size_t lane = 0; lane < 8; ++lane) {
        std::int32_t& texel = footprint.texel[corner][lane];
        if ((read >> lane & 1) == 0) {
          texel = 0;
          continue;
        }
        const std::int32_t in_block = texel & ((1 << place_bits_) - 1);
        const std::int32_t place = place_of(static_cast<std::uint32_t>(texel) >> place_bits_);
        plan_.block_lines[static_cast<std::size_t>(place)] |=
            static_cast<std::uint8_t>(1u << (in_block >> line_shift_));
        texel = (place << place_bits_) + in_block;
      }
    }
  }

 private:
  static constexpr std::uint16_t kNone = 0xffff;

  std::int32_t place_of(std::uint32_t block) {
    std::size_t at = (block ^ block >> 9) % places_;
    while (place_[at] != kNone && plan_.blocks[place_[at]] != block) at = (at + 1) % places_;
    if (place_[at] == kNone) {
      place_[at] = static_cast<std::uint16_t>(plan_.block_count);
      plan_.block_lines[place_[at]] = 0;
      plan_.blocks[static_cast<std::size_t>(plan_.block_count++)] = block;
    }
    return place_[at];
  }

  TexturePlan& plan_;
  std::size_t places_;
  int place_bits_;      // log2 of a block's places among the texels' indices
  int line_shift_ = 0;  // log2 of the places that a line of decoded texels has
  std::array<std::uint16_t, std::size_t{2} * TexturePlan::kMaxBlocks>
      place_;  // by hash: index into the plan's blocks
};

/// Texels along one axis, not yet wrapped; `nearest` names lanes whose filter is nearest.
inline AxisTexels axis_texels(__m256 folded, __m256i size, int subtexel_bits, std::uint32_t nearest) {
  if (nearest == 0) return linear_texels(folded, size, subtexel_bits);
  const AxisTexels point = nearest_texels(folded, size);
  return nearest == 0xff ? point
                         : select(linear_texels(folded, size, subtexel_bits), point, lanes_of(nearest));
}

/// Corners beyond the border, as `Footprint::border`.
inline std::uint32_t beyond_border(const SamplerState& sampler, const LevelVectors& at, const AxisTexels& x,
                                   const AxisTexels& y) {
  const __m256i column[2] = {outside(x.first, at.width, sampler.wrap_u),
                             outside(x.second, at.width, sampler.wrap_u)};
  const __m256i row[2] = {outside(y.first, at.height, sampler.wrap_v),
                          outside(y.second, at.height, sampler.wrap_v)};
  std::uint32_t corners = 0;
  for (std::size_t corner = 0; corner < 4; ++corner)
    corners |= bits_of(_mm256_or_si256(column[corner % 2], row[corner / 2])) << (8 * corner);
  return corners;
}

/// Counts a footprint. `nearest`: lanes that read one texel.
inline void count_work(TexturePlan& plan, std::uint32_t used, std::uint32_t nearest, std::uint32_t border) {
  const std::uint32_t passes = std::max(1u, format_bytes(decoded_format(plan.format)) / 4);
  plan.bilinear_quads += passes * (((used & 0x0f) != 0 ? 1u : 0u) + ((used & 0xf0) != 0 ? 1u : 0u));
  plan.texels +=
      static_cast<std::uint32_t>(4 * std::popcount(used & ~nearest) + std::popcount(used & nearest));
  if (border == 0) return;
  plan.texels -= static_cast<std::uint32_t>(std::popcount(border & (used & ~nearest) * 0x01010101u) +
                                            std::popcount(border & (used & nearest)));
}

}  // namespace quadrille::models
