#include "hw/texture/texture_use.h"

#include <bit>

namespace quadrille::hw {

void TextureUse::add(const TextureUse& other) {
  for (std::uint64_t TextureUse::*const count :
       {&TextureUse::requests, &TextureUse::lanes, &TextureUse::texels, &TextureUse::nearest,
        &TextureUse::linear, &TextureUse::two_levels, &TextureUse::several_samples, &TextureUse::look_ups,
        &TextureUse::misses, &TextureUse::read_bytes})
    this->*count += other.*count;
  for (std::size_t level = 0; level < levels.size(); ++level) levels[level] += other.levels[level];
}

void TextureUseLog::note(std::uint32_t texture, const models::SamplerState& sampler,
                         const models::TexturePlan& plan) {
  TextureUse& use = by_texture_[texture];
  const auto lanes = static_cast<std::uint64_t>(std::popcount(plan.active));
  ++use.requests;
  use.lanes += lanes;
  use.texels += plan.texels;
  if (plan.general && plan.ask == models::TextureAsk::kQueryLod) return;
  std::uint64_t nearest = 0;
  if (plan.general && plan.ask == models::TextureAsk::kFetch) nearest = lanes;
  else if (!plan.general || plan.ask == models::TextureAsk::kSample)
    nearest = (sampler.mag == models::Filter::kNearest ? plan.magnified_lanes : 0) +
              (sampler.min == models::Filter::kNearest ? plan.minified_lanes : 0);
  use.nearest += nearest;
  use.linear += lanes - nearest;
  for (std::size_t lane = 0; lane < models::kWarpLanes; ++lane) {
    if ((plan.active >> lane & 1) == 0) continue;
    ++use.levels[static_cast<std::size_t>(plan.finer_level[lane])];
    use.two_levels += plan.level_weight[lane] > 0 ? 1 : 0;
    use.several_samples += plan.general && plan.samples[lane] > 1 ? 1 : 0;
  }
}

}  // namespace quadrille::hw
