/// Why the texture units' first-level caches missed (models/cache/miss_kinds.h), and the law that the kinds
/// add up to the misses.
#pragma once

#include "hw/memory/l1_cache.h"

#include <cstdint>
#include <string>

namespace quadrille::pipeline {

class Machine;
struct Figures;

/// Of one texture unit, or the sum of several.
struct MissKindFigures {
  std::string unit;  ///< path; of a sum "texture"
  std::uint64_t look_ups = 0;
  std::uint64_t misses = 0;  ///< as the cache counts them
  hw::MissKindCounts kinds;
  [[nodiscard]] std::uint64_t of(models::MissKind kind) const {
    return kinds.misses[static_cast<std::size_t>(kind)];
  }
  void add(const MissKindFigures& other);
};

/// Before the run: every texture unit counts kinds of misses. Pixels and cycles stay the same.
void keep_miss_kinds(const Machine& machine);
/// After the run: adds `texture_misses` to the figures, and its law.
void collect_miss_kinds(const Machine& machine, Figures& figures);
/// All texture units together.
[[nodiscard]] MissKindFigures all_texture_misses(const Figures& figures);

}  // namespace quadrille::pipeline
