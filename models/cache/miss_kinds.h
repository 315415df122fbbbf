/// Why a cache missed: Hill's three kinds [P: Hill 1987], told look-up by look-up by two ideal caches that
/// see the same look-ups.
///
/// - Compulsory: a cache without end would miss too, since something of what is asked for was never there.
/// - Capacity: one of as many lines would miss too if any line could lie anywhere in it and the one that was
///   used longest ago made room.
/// - Conflict: the rest. It is the sets that are too small, a replacement that is not LRU, or lines under way
///   that could not make room.
///
/// Ideal caches have what they ask for at once. Lines come by sectors, as in the cache that they stand beside
/// (models/cache/tag_array.h): a sector that is not there yet is a miss although the line is there.
#pragma once

#include "models/cache/tag_array.h"

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace quadrille::models {

enum class MissKind : std::uint8_t { kCompulsory, kCapacity, kConflict };
inline constexpr std::size_t kMissKinds = 3;

class MissKinds {
 public:
  /// Beside a cache of `lines`, at least one.
  explicit MissKinds(std::size_t lines);

  /// A look-up of `sectors` of a line, of which a miss brings `brought`: those, or more of them. The kind of
  /// miss that it is if the cache misses. `kConflict` says that the ideal caches hit.
  MissKind look_up(std::uint32_t line, SectorMask sectors, SectorMask brought);
  /// The cache forgets all lines, because what they hold has changed: they come for the first time again.
  void forget();

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct Place {
    std::uint32_t line = 0;
    SectorMask valid = 0;
    std::uint32_t newer = kNone, older = kNone;
  };
  struct Seen {
    SectorMask sectors = 0;
    std::uint32_t place = kNone;  ///< in the associative cache
  };
  /// The line's place, as the newest.
  Place& use(std::uint32_t line, Seen& seen);
  void take_out(std::uint32_t place);
  void put_in_front(std::uint32_t place);

  std::unordered_map<std::uint32_t, Seen> seen_;  ///< by line
  std::vector<Place> places_;
  std::size_t used_ = 0;
  std::uint32_t newest_ = kNone, oldest_ = kNone;
};

}  // namespace quadrille::models
