/// Addresses of requests that are more than a plane sampled at one place: volumes, cubes and arrays, several
/// samples along an axis, offsets, gathers, fetches, questions about the level of detail (sample.h).
///
/// Everything is decided lane by lane or quad by quad: which other quads share the warp changes nothing.
/// A footprint is a 2x2 of one slice; a level of a lane has one, or two in a volume, or one for each sample
/// along the longer axis of its pixel's footprint. Where a lane takes the texels of an ellipse, its
/// footprints are the 2x2 that hold them; of the level that it reads, or the finer one of two.
#include "models/base/error.h"
#include "models/texture/cube.h"
#include "models/texture/ellipse_taps.h"
#include "models/texture/level_of_detail.h"
#include "models/texture/operation_places.h"
#include "models/texture/plan_parts.h"
#include "models/texture/sample.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

namespace quadrille::models {
namespace {

/// Wraps an index however far it is outside.
__m256i wrap_far(__m256i index, __m256i size, Wrap wrap) {
  const __m256i near =
      _mm256_andnot_si256(_mm256_cmpgt_epi32(index, size), _mm256_cmpgt_epi32(index, _mm256_set1_epi32(-2)));
  const bool repeats = wrap == Wrap::kRepeat || wrap == Wrap::kMirroredRepeat;
  if (!repeats || bits_of(near) == 0xff) return wrap_texel(index, size, wrap);
  alignas(32) std::array<std::int32_t, kGroupLanes> i, n;
  store_lanes(i.data(), index);
  store_lanes(n.data(), size);
  for (std::size_t lane = 0; lane < kGroupLanes; ++lane) {
    const std::int32_t period = wrap == Wrap::kRepeat ? n[lane] : 2 * n[lane];
    const std::int32_t within = ((i[lane] % period) + period) % period;
    i[lane] = within < n[lane] ? within : period - 1 - within;
  }
  return load_lanes(i.data());
}

class OperationPlanner {
 public:
  OperationPlanner(const TextureView& view, const SamplerState& sampler, const TextureRequest& request,
                   const Precision& precision, TexturePlan& plan)
      : view_(view),
        sampler_(sampler_for(sampler, view.kind)),
        request_(request),
        precision_(precision),
        plan_(plan),
        places_(view, sampler_, request, precision),
        operation_(places_.operation()),
        words_(places_.words()),
        dimensions_(static_cast<std::size_t>(place_dimensions(view.kind))),
        shifted_(operation_.offsets || operation_.offset != TextureOperation{}.offset),
        lines_((start(view, sampler, request, places_.takes_ellipses(), plan), plan)),
        blocks_(plan, plan.weighed ? TexturePlan::kMaxBlocks : TexturePlan::kSampledBlocks) {}

  void run() {
    plan_.ask = operation_.ask;
    plan_.component = operation_.component;
    plan_.compares = operation_.compare;
    plan_.compare = sampler_.compare;
    if (words_.reference >= 0) plan_.reference = request_.word(static_cast<std::size_t>(words_.reference));
    if (operation_.ask == TextureAsk::kFetch) return fetch();
    places_.find();
    if (operation_.ask == TextureAsk::kGather) return gather();
    places_.find_levels(plan_.samples);
    const LaneLevels levels = levels_of(view_.layout, sampler_, places_.lambda, precision_);
    if (operation_.ask == TextureAsk::kQueryLod) return answer_level(levels);
    sample(levels);
  }

 private:
  static void start(const TextureView& view, const SamplerState& sampler, const TextureRequest& request,
                    bool weighed, TexturePlan& plan) {
    begin_plan(view, sampler, request, true, plan);
    plan.kind = view.kind;
    plan.weighed = weighed;
    plan.magnified_lanes = plan.minified_lanes = 0;
    plan.slices = view.kind == ViewKind::k3D;
    plan.levels.fill(0);
    plan.taps.fill(1);
    plan.samples.fill(1.0f);
    plan.level_weight.fill(0.0f);
    plan.finer_level.fill(0);
  }

  void answer_level(const LaneLevels& levels) {
    for (std::size_t lane = 0; lane < kWarpLanes; ++lane) {
      plan_.level_of_detail[0][lane] = static_cast<float>(levels.finer[lane]) + levels.weight[lane];
      plan_.level_of_detail[1][lane] = std::clamp(places_.plain_lambda[lane], -128.0f, 128.0f);
    }
  }

  void sample(const LaneLevels& levels) {
    plan_.finer_level = levels.finer;
    if (!plan_.weighed) plan_.level_weight = levels.weight;
    plan_.magnified_lanes = static_cast<std::uint32_t>(std::popcount(request_.active & levels.magnified));
    plan_.minified_lanes = static_cast<std::uint32_t>(std::popcount(request_.active & ~levels.magnified));
    const LaneMask nearest = (sampler_.mag == Filter::kNearest ? levels.magnified : 0) |
                             (sampler_.min == Filter::kNearest ? ~levels.magnified : 0);
    for (std::size_t group = 0; group < TexturePlan::kGroups; ++group) {
      const std::size_t first = kGroupLanes * group;
      const std::uint32_t active = request_.active >> first & 0xff;
      if (active == 0) continue;
      if (plan_.weighed) {
        plan_.levels[group] = 1;
        ellipses(group, load_lanes(levels.finer.data() + first), active);
        continue;
      }
      int taps = plan_.slices ? 2 : 1;
      for (std::size_t lane = first; lane < first + kGroupLanes; ++lane)
        if ((request_.active >> lane & 1) != 0) taps = std::max(taps, static_cast<int>(plan_.samples[lane]));
      plan_.taps[group] = static_cast<std::uint8_t>(taps);
      const __m256i finer = load_lanes(levels.finer.data() + first);
      const __m256 weight = _mm256_load_ps(levels.weight.data() + first);
      const __m256i mixed = _mm256_castps_si256(_mm256_cmp_ps(weight, _mm256_setzero_ps(), _CMP_GT_OQ));
      const std::uint32_t mixing = active & bits_of(mixed);
      plan_.levels[group] = mixing != 0 ? 2 : 1;
      level(group, 0, finer, active, nearest >> first & 0xff);
      if (mixing != 0) level(group, 1, _mm256_sub_epi32(finer, mixed), mixing, nearest >> first & 0xff);
    }
  }

  /// All footprints of a group in one level.
  void level(std::size_t group, std::size_t which, __m256i level, std::uint32_t used, std::uint32_t nearest) {
    const std::size_t first = kGroupLanes * group, taps = plan_.taps[group];
    const __m256 count = _mm256_loadu_ps(plan_.samples.data() + first);
    for (std::size_t tap = 0; tap < taps; ++tap) {
      __m256 u = load(places_.place[0], first), v = load(places_.place[1], first);
      std::uint32_t lanes = used;
      if (plan_.slices) {
        if (tap == 1) lanes &= ~nearest;
      } else if (taps > 1) {
        const __m256 number = _mm256_set1_ps(static_cast<float>(tap + 1)), one = _mm256_set1_ps(1.0f);
        lanes &= static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_cmp_ps(number, count, _CMP_LE_OQ)));
        const __m256 along =
            _mm256_sub_ps(_mm256_div_ps(number, _mm256_add_ps(count, one)), _mm256_set1_ps(0.5f));
        const __m256 several = _mm256_cmp_ps(count, one, _CMP_GT_OQ);
        u = _mm256_add_ps(u, _mm256_and_ps(several, _mm256_mul_ps(along, load(places_.axis[0], first))));
        v = _mm256_add_ps(v, _mm256_and_ps(several, _mm256_mul_ps(along, load(places_.axis[1], first))));
      }
      footprint(group, which, tap, level, u, v, lanes, nearest);
    }
  }

  /// The centre of a lane's ellipse along an axis, in texels of a level of that size. Where the image does
  /// not repeat, it is held where no ellipse reaches more of the image than it would from farther away.
  [[nodiscard]] static float centre(float place, std::int32_t size, Wrap wrap) {
    constexpr float kFar = 64.0f;
    const bool repeats = wrap == Wrap::kRepeat || wrap == Wrap::kMirroredRepeat;
    const float folded = repeats ? _mm256_cvtss_f32(fold_coordinate(_mm256_set1_ps(place), wrap)) : place;
    const auto texels = static_cast<float>(size);
    return std::clamp(folded * texels - 0.5f, -texels - kFar, 2.0f * texels + kFar);
  }

  /// All footprints of a group's ellipses; each lane has as many as it needs.
  void ellipses(std::size_t group, __m256i level, std::uint32_t used) {
    const std::size_t first = kGroupLanes * group;
    alignas(32) std::array<std::int32_t, kGroupLanes> levels;
    store_lanes(levels.data(), level);
    EllipseTaps taps(plan_.weight[group]);
    std::array<EllipseFootprint, kMaxEllipseFootprints> of_lane;
    for (std::size_t lane = 0; lane < kGroupLanes; ++lane) {
      if ((used >> lane & 1) == 0) continue;
      const auto l = static_cast<std::size_t>(levels[lane]);
      const std::int32_t width = view_.layout.width[l], height = view_.layout.height[l];
      const float x = centre(places_.place[0][first + lane], width, sampler_.wrap_u),
                  y = centre(places_.place[1][first + lane], height, sampler_.wrap_v);
      const int count = ellipse_footprints(places_.ellipse_of(first + lane, width, height), x, y, of_lane);
      taps.add(lane, std::span(of_lane).first(static_cast<std::size_t>(count)));
    }
    plan_.taps[group] = static_cast<std::uint8_t>(taps.count());
    const LevelVectors at = level_vectors(view_.layout, level, 0xff);
    for (std::size_t tap = 0; tap < taps.count(); ++tap)
      footprint(group, 0, tap, level, at, moved(pair_from(taps.column(tap)), 0, first),
                moved(pair_from(taps.row(tap)), 1, first), taps.lanes(tap), 0);
  }
  /// A texel and the next one.
  [[nodiscard]] static AxisTexels pair_from(__m256i texel) {
    return {texel, _mm256_add_epi32(texel, _mm256_set1_epi32(1)), _mm256_setzero_si256()};
  }

  /// The axis' texels, moved by the operation's offset along it.
  [[nodiscard]] AxisTexels texels_along(std::size_t axis, std::size_t first, __m256 c, __m256i size,
                                        Wrap wrap, std::uint32_t nearest) const {
    return moved(axis_texels(fold_coordinate(c, wrap), size, precision_.subtexel_bits, nearest), axis, first);
  }
  [[nodiscard]] AxisTexels moved(AxisTexels t, std::size_t axis, std::size_t first) const {
    if (!shifted_ || axis >= dimensions_ || is_cube(view_.kind)) return t;
    const __m256i by = offset(axis, first);
    t.first = _mm256_add_epi32(t.first, by);
    t.second = _mm256_add_epi32(t.second, by);
    return t;
  }

  /// Of eight lanes, and no more than the arithmetic of indices holds.
  [[nodiscard]] __m256i offset(std::size_t axis, std::size_t first) const {
    __m256i by = _mm256_set1_epi32(operation_.offset.at(axis));
    if (operation_.offsets) {
      const __m256i word =
          _mm256_castps_si256(load(request_.word(static_cast<std::size_t>(words_.offset) + axis), first));
      const __m256i most = _mm256_set1_epi32(1 << 20);
      const __m256i limited =
          _mm256_max_epi32(_mm256_min_epi32(word, most), _mm256_sub_epi32(_mm256_setzero_si256(), most));
      by = _mm256_add_epi32(by, limited);
    }
    return by;
  }

  [[nodiscard]] AxisTexels wrapped_texels(const AxisTexels& t, __m256i size, Wrap wrap) const {
    if (!shifted_ && !plan_.weighed) return wrapped(t, size, wrap);
    return {wrap_far(t.first, size, wrap), wrap_far(t.second, size, wrap), t.weight};
  }

  void footprint(std::size_t group, std::size_t which, std::size_t tap, __m256i level, __m256 u, __m256 v,
                 std::uint32_t lanes, std::uint32_t nearest) {
    const std::size_t first = kGroupLanes * group;
    // Of unused lanes too, each lane's own level: slices start by level, and what is read lies in the image.
    const LevelVectors at = level_vectors(view_.layout, level, 0xff);
    footprint(group, which, tap, level, at, texels_along(0, first, u, at.width, sampler_.wrap_u, nearest),
              texels_along(1, first, v, at.height, sampler_.wrap_v, nearest), lanes, nearest);
  }

  void footprint(std::size_t group, std::size_t which, std::size_t tap, __m256i level, const LevelVectors& at,
                 const AxisTexels& columns, const AxisTexels& rows, std::uint32_t lanes,
                 std::uint32_t nearest) {
    const std::size_t first = kGroupLanes * group;
    TexturePlan::Footprint& out = plan_.footprint[group][which * plan_.taps[group] + tap];
    const AxisTexels x = wrapped_texels(columns, at.width, sampler_.wrap_u),
                     y = wrapped_texels(rows, at.height, sampler_.wrap_v);
    out.border = has_border(sampler_) ? beyond_border(sampler_, at, columns, rows) : 0;
    out.missing = 0;
    __m256i slice = load(places_.slice, first);
    if (plan_.slices) slice = slice_of_volume(group, which, tap, level, nearest, out);
    store_texels(at, level, slice, x, y, out);
    if (is_cube(view_.kind) && sampler_.seamless) join_faces(level, slice, columns, rows, nearest, out);
    collect(lanes, nearest, out);
  }

  /// Notes what a footprint reads.
  void collect(std::uint32_t lanes, std::uint32_t nearest, TexturePlan::Footprint& out) {
    const std::uint32_t unread = out.border | out.missing;
    __m256i texel[4];
    for (std::size_t corner = 0; corner < 4; ++corner) texel[corner] = load_lanes(out.texel[corner].data());
    lines_.add(texel, lanes, unread);
    if (view_.layout.in_blocks()) blocks_.add(out, lanes);
    count_work(plan_, lanes, nearest, unread);
  }

  void store_texels(const LevelVectors& at, __m256i level, __m256i slice, const AxisTexels& x,
                    const AxisTexels& y, TexturePlan::Footprint& out) const {
    const __m256i apart = _mm256_i32gather_epi32(view_.layout.slice_texels.data(), level, 4);
    const __m256i start = _mm256_add_epi32(at.first, _mm256_mullo_epi32(slice, apart));
    const TextureLayout& layout = view_.layout;
    const __m256i column[2] = {x_index(x.first, at.pitch, layout), x_index(x.second, at.pitch, layout)},
                  row[2] = {y_index(y.first, at.pitch, layout), y_index(y.second, at.pitch, layout)};
    for (std::size_t corner = 0; corner < 4; ++corner)
      store_lanes(out.texel[corner].data(),
                  _mm256_add_epi32(start, _mm256_add_epi32(column[corner % 2], row[corner / 2])));
    store_lanes(out.frac_x.data(), x.weight);
    store_lanes(out.frac_y.data(), y.weight);
  }

  /// The first or second slice that a lane reads; beyond a border all its corners are.
  __m256i slice_of_volume(std::size_t group, std::size_t which, std::size_t tap, __m256i level,
                          std::uint32_t nearest, TexturePlan::Footprint& out) {
    const std::size_t first = kGroupLanes * group;
    const __m256i depth = _mm256_i32gather_epi32(view_.layout.slices.data(), level, 4);
    const AxisTexels raw =
        texels_along(2, first, load(places_.place[2], first), depth, sampler_.wrap_w, nearest);
    const __m256i index = tap == 0 ? raw.first : raw.second;
    store(plan_.slice_weight[which], first,
          _mm256_mul_ps(_mm256_cvtepi32_ps(raw.weight), _mm256_set1_ps(1.0f / 256.0f)));
    out.border |= bits_of(outside(index, depth, sampler_.wrap_w)) * 0x01010101u;
    return shifted_ ? wrap_far(index, depth, sampler_.wrap_w) : wrap_texel(index, depth, sampler_.wrap_w);
  }

  /// Corners beyond an edge of their face lie on the face behind it; those beyond a corner are missing.
  void join_faces(__m256i level, __m256i slice, const AxisTexels& columns, const AxisTexels& rows,
                  std::uint32_t nearest, TexturePlan::Footprint& out) const {
    alignas(32) std::array<std::int32_t, kGroupLanes> levels, slices, x[2], y[2];
    store_lanes(levels.data(), level);
    store_lanes(slices.data(), slice);
    store_lanes(x[0].data(), columns.first);
    store_lanes(x[1].data(), columns.second);
    store_lanes(y[0].data(), rows.first);
    store_lanes(y[1].data(), rows.second);
    constexpr auto kFaces = static_cast<std::int32_t>(kCubeFaces);
    for (std::size_t lane = 0; lane < kGroupLanes; ++lane) {
      if ((nearest >> lane & 1) != 0) continue;
      const auto l = static_cast<std::uint32_t>(levels[lane]);
      const std::int32_t n = view_.layout.width[l];
      for (std::size_t corner = 0; corner < 4; ++corner) {
        const std::int32_t i = x[corner % 2][lane], j = y[corner / 2][lane];
        const bool beside = i < 0 || i >= n, above = j < 0 || j >= n;
        if (beside && above) out.missing |= 1u << (8 * corner + lane);
        if (beside == above) continue;
        const CubeTexel on = beyond_edge({slices[lane] % kFaces, i, j}, n);
        out.texel[corner][lane] = static_cast<std::int32_t>(
            view_.layout.texel_index(l, static_cast<std::uint32_t>(on.x), static_cast<std::uint32_t>(on.y),
                                     static_cast<std::uint32_t>(slices[lane] / kFaces * kFaces + on.face)));
      }
    }
  }

  /// The 2x2 of a linear filter in the finest level.
  void gather() {
    for (std::size_t group = 0; group < TexturePlan::kGroups; ++group) {
      const std::uint32_t active = request_.active >> (kGroupLanes * group) & 0xff;
      if (active == 0) continue;
      plan_.levels[group] = 1;
      level(group, 0, _mm256_setzero_si256(), active, 0);
    }
  }

  /// A texel each, by integers; what is outside of the image, its levels or its samples is a transparent
  /// black border.
  void fetch() {
    plan_.border = BorderColor::kTransparentBlack;
    plan_.slices = false;
    for (std::size_t group = 0; group < TexturePlan::kGroups; ++group) {
      const std::uint32_t active = request_.active >> (kGroupLanes * group) & 0xff;
      if (active == 0) continue;
      plan_.levels[group] = 1;
      TexturePlan::Footprint& out = plan_.footprint[group][0];
      out.border = out.missing = 0;
      out.frac_x.fill(0);
      out.frac_y.fill(0);
      for (std::size_t lane = 0; lane < kGroupLanes; ++lane)
        fetch_lane(kGroupLanes * group + lane, lane, out);
      collect(active, active, out);
    }
  }

  void fetch_lane(std::size_t lane, std::size_t place, TexturePlan::Footprint& out) {
    const auto word = [&](std::size_t k) {
      return std::int64_t{std::bit_cast<std::int32_t>(request_.word(k)[lane])};
    };
    const TextureLayout& layout = view_.layout;
    const bool multisampled = is_multisampled(view_.kind);
    const std::int64_t wanted = word(static_cast<std::size_t>(words_.level));
    bool inside = wanted >= 0 && wanted < (multisampled ? layout.samples : layout.levels);
    const std::uint32_t number = inside ? static_cast<std::uint32_t>(wanted) : 0,
                        l = multisampled ? 0 : number, sample = multisampled ? number : 0;
    std::array<std::int64_t, 3> at{};
    for (std::size_t k = 0; k < dimensions_; ++k) {
      at.at(k) = word(k) + operation_.offset.at(k);
      if (operation_.offsets) at.at(k) += word(static_cast<std::size_t>(words_.offset) + k);
    }
    if (is_array(view_.kind)) at[2] = word(dimensions_);
    const std::array<std::int64_t, 3> sizes{layout.width[l], layout.height[l], layout.slices[l]};
    for (std::size_t k = 0; k < 3; ++k) {
      inside = inside && at.at(k) >= 0 && at.at(k) < sizes.at(k);
      at.at(k) = std::clamp<std::int64_t>(at.at(k), 0, sizes.at(k) - 1);
    }
    const auto index = static_cast<std::int32_t>(layout.sample_part(sample) +
                                                 layout.texel_index(l, static_cast<std::uint32_t>(at[0]),
                                                                    static_cast<std::uint32_t>(at[1]),
                                                                    static_cast<std::uint32_t>(at[2])));
    for (auto& corner : out.texel) corner[place] = index;
    if (!inside) out.border |= 0x01010101u << place;
    plan_.finer_level[lane] = static_cast<std::int32_t>(l);
  }

  const TextureView& view_;
  SamplerState sampler_;
  const TextureRequest& request_;
  const Precision& precision_;
  TexturePlan& plan_;
  OperationPlaces places_;
  TextureOperation operation_;
  TextureWords words_;
  std::size_t dimensions_;
  bool shifted_;
  LineCollector lines_;
  BlockCollector blocks_;
};

}  // namespace

void plan_operation(const TextureView& view, const SamplerState& sampler, const TextureRequest& request,
                    const Precision& precision, TexturePlan& plan) {
  OperationPlanner(view, sampler, request, precision, plan).run();
}

}  // namespace quadrille::models
