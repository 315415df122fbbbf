#include "pipeline/report/miss_kinds.h"

#include "pipeline/report/figures.h"

#include <numeric>

namespace quadrille::pipeline {

void MissKindFigures::add(const MissKindFigures& other) {
  look_ups += other.look_ups;
  misses += other.misses;
  for (std::size_t i = 0; i < kinds.misses.size(); ++i) kinds.misses[i] += other.kinds.misses[i];
  kinds.associative_misses += other.kinds.associative_misses;
}

void keep_miss_kinds(const Machine& machine) {
  for (hw::TextureUnit* unit : machine.all<hw::TextureUnit>()) unit->keep_miss_kinds();
}

void collect_miss_kinds(const Machine& machine, Figures& figures) {
  std::vector<MissKindFigures>& all = figures.texture_misses.emplace();
  for (const hw::TextureUnit* unit : machine.all<hw::TextureUnit>()) {
    const hw::MissKindCounts* kinds = unit->miss_kinds();
    QUADRILLE_CHECK(kinds != nullptr, "{} kept no kinds of misses", unit->name());
    const hw::L1CacheStats& cache = unit->cache_stats();
    all.push_back({unit->name(), cache.requests.value(), cache.misses.value(), *kinds});
  }
  const MissKindFigures sum = all_texture_misses(figures);
  figures.checks.push_back(
      {"texture misses of all kinds = counted by the caches",
       "texture_misses.compulsory + capacity + conflict", "texture.cache_misses",
       std::accumulate(sum.kinds.misses.begin(), sum.kinds.misses.end(), std::uint64_t{0}), sum.misses});
}

MissKindFigures all_texture_misses(const Figures& figures) {
  MissKindFigures sum{"texture", 0, 0, {}};
  for (const MissKindFigures& unit : *figures.texture_misses) sum.add(unit);
  return sum;
}

}  // namespace quadrille::pipeline
