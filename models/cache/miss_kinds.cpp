#include "models/cache/miss_kinds.h"

#include "models/base/error.h"

namespace quadrille::models {

MissKinds::MissKinds(std::size_t lines) : places_(lines) {
  QUADRILLE_CHECK(lines > 0 && lines < kNone, "a cache of {} lines", lines);
}

MissKind MissKinds::look_up(std::uint32_t line, SectorMask sectors, SectorMask brought) {
  Seen& seen = seen_[line];
  const bool first = (sectors & ~seen.sectors) != 0;
  if (first) seen.sectors |= brought;
  Place& place = use(line, seen);
  const bool absent = (sectors & ~place.valid) != 0;
  if (absent) place.valid |= brought;
  return first ? MissKind::kCompulsory : absent ? MissKind::kCapacity : MissKind::kConflict;
}

MissKinds::Place& MissKinds::use(std::uint32_t line, Seen& seen) {
  if (seen.place == kNone) {
    const bool room = used_ < places_.size();
    seen.place = room ? static_cast<std::uint32_t>(used_++) : oldest_;
    if (!room) {
      take_out(oldest_);
      seen_.find(places_[seen.place].line)->second.place = kNone;
    }
    places_[seen.place] = {line, 0, kNone, kNone};
    put_in_front(seen.place);
  } else if (seen.place != newest_) {
    take_out(seen.place);
    put_in_front(seen.place);
  }
  return places_[seen.place];
}

void MissKinds::take_out(std::uint32_t place) {
  const std::uint32_t newer = places_[place].newer, older = places_[place].older;
  (newer == kNone ? newest_ : places_[newer].older) = older;
  (older == kNone ? oldest_ : places_[older].newer) = newer;
}

void MissKinds::put_in_front(std::uint32_t place) {
  places_[place].newer = kNone;
  places_[place].older = newest_;
  (newest_ == kNone ? oldest_ : places_[newest_].newer) = place;
  newest_ = place;
}

void MissKinds::forget() {
  seen_.clear();
  used_ = 0;
  newest_ = oldest_ = kNone;
}

}  // namespace quadrille::models
