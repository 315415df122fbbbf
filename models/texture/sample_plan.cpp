/// The address half of the texture unit: levels, texel addresses and the cache lines they fall in (sample.h).
#include "models/base/error.h"
#include "models/texture/level_of_detail.h"
#include "models/texture/plan_parts.h"
#include "models/texture/sample.h"

#include <algorithm>
#include <bit>

namespace quadrille::models {
namespace {

/// What stays the same for all groups of a request.
struct PlanContext {
  const TextureView& view;
  const SamplerState& sampler;
  int subtexel_bits;
};

/// Addresses of a group in one level. `folded_u`, `folded_v` are folded coordinates.
void plan_footprint(const PlanContext& context, __m256 folded_u, __m256 folded_v, __m256i level,
                    std::uint32_t used, std::uint32_t nearest, TexturePlan::Footprint& out,
                    LineCollector& lines, BlockCollector& blocks) {
  const LevelVectors at = level_vectors(context.view.layout, level, used);
  const AxisTexels columns = axis_texels(folded_u, at.width, context.subtexel_bits, nearest),
                   rows = axis_texels(folded_v, at.height, context.subtexel_bits, nearest);
  const AxisTexels x = wrapped(columns, at.width, context.sampler.wrap_u),
                   y = wrapped(rows, at.height, context.sampler.wrap_v);
  out.border = has_border(context.sampler) ? beyond_border(context.sampler, at, columns, rows) : 0;
  out.missing = 0;
  const TextureLayout& layout = context.view.layout;
  const __m256i left = _mm256_add_epi32(at.first, x_index(x.first, at.pitch, layout)),
                right = _mm256_add_epi32(at.first, x_index(x.second, at.pitch, layout));
  const __m256i top = y_index(y.first, at.pitch, layout), bottom = y_index(y.second, at.pitch, layout);
  const __m256i texel[4] = {_mm256_add_epi32(left, top), _mm256_add_epi32(right, top),
                            _mm256_add_epi32(left, bottom), _mm256_add_epi32(right, bottom)};
  for (std::size_t corner = 0; corner < 4; ++corner) store_lanes(out.texel[corner].data(), texel[corner]);
  store_lanes(out.frac_x.data(), x.weight);
  store_lanes(out.frac_y.data(), y.weight);
  lines.add(texel, used, out.border);
  if (layout.in_blocks()) blocks.add(out, used);
}

}  // namespace

void plan_texture(const TextureView& view, const SamplerState& sampler, const TextureRequest& request,
                  const Precision& precision, TexturePlan& plan) {
  QUADRILLE_CHECK(is_texture_request(request.op), "operation {}", static_cast<int>(request.op));
  if (request.operation != nullptr || is_anisotropic(sampler) || view.kind != ViewKind::k2D)
    return plan_operation(view, sampler, request, precision, plan);
  begin_plan(view, sampler, request, false, plan);
  alignas(32) LaneFloats u, v;
  for (std::size_t lane = 0; lane < kWarpLanes; lane += 8) {
    _mm256_store_ps(u.data() + lane, finite_or_zero(_mm256_load_ps(request.u.data() + lane)));
    _mm256_store_ps(v.data() + lane, finite_or_zero(_mm256_load_ps(request.v.data() + lane)));
  }
  const LaneLevels levels = lane_levels(view.layout, sampler, request, u, v, precision);
  plan.finer_level = levels.finer;
  plan.level_weight = levels.weight;
  plan.magnified_lanes = static_cast<std::uint32_t>(std::popcount(request.active & levels.magnified));
  plan.minified_lanes = static_cast<std::uint32_t>(std::popcount(request.active & ~levels.magnified));
  const LaneMask nearest_lanes = (sampler.mag == Filter::kNearest ? levels.magnified : 0) |
                                 (sampler.min == Filter::kNearest ? ~levels.magnified : 0);

  const PlanContext context{view, sampler, precision.subtexel_bits};
  LineCollector lines(plan);
  BlockCollector blocks(plan, TexturePlan::kPlainBlocks);
  for (std::size_t group = 0; group < TexturePlan::kGroups; ++group) {
    const std::size_t lane = 8 * group;
    const std::uint32_t active = request.active >> lane & 0xff, nearest = nearest_lanes >> lane & 0xff;
    plan.levels[group] = 0;
    if (active == 0) continue;
    const __m256 folded_u = fold_coordinate(_mm256_load_ps(u.data() + lane), sampler.wrap_u);
    const __m256 folded_v = fold_coordinate(_mm256_load_ps(v.data() + lane), sampler.wrap_v);
    const __m256i finer = load_lanes(levels.finer.data() + lane);
    plan_footprint(context, folded_u, folded_v, finer, active, nearest, plan.footprint[group][0], lines,
                   blocks);
    count_work(plan, active, nearest, plan.footprint[group][0].border);
    const __m256 weight = _mm256_load_ps(levels.weight.data() + lane);
    const __m256i mixed = _mm256_castps_si256(_mm256_cmp_ps(weight, _mm256_setzero_ps(), _CMP_GT_OQ));
    const std::uint32_t mixing = active & bits_of(mixed);
    plan.levels[group] = mixing != 0 ? 2 : 1;
    if (mixing == 0) continue;
    // + 1 where two levels are mixed: never beyond the last
    const __m256i coarser = _mm256_sub_epi32(finer, mixed);
    plan_footprint(context, folded_u, folded_v, coarser, mixing, nearest, plan.footprint[group][1], lines,
                   blocks);
    count_work(plan, mixing, nearest, plan.footprint[group][1].border);
  }
}

}  // namespace quadrille::models
