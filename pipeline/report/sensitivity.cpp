#include "pipeline/report/sensitivity.h"

#include "pipeline/machine/planned_links.h"
#include "pipeline/report/report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace quadrille::pipeline {

namespace {

/// How bounds of like length add up: infinity would be perfect overlap, 1 none. [M: `quadrille experiment
/// limits`]
constexpr double kNorm = 48;
/// A slice whose bounds reach so far is all theirs, and one whose bounds reach less is all waiting; between
/// them it is shared. Where places are full, somebody waits for one, and the bounds of units have to reach
/// further; a link's own bound counts its places and need not reach so far. [M: the same]
struct Reach {
  double waiting, work;
};
constexpr Reach kReach{0.5, 0.9}, kReachWithFullPlaces{0.6, 1}, kReachOfLink{0.35, 0.75};
/// A data bus that is held much while nobody waits for memory is no limit to the same degree: writes are left
/// to it, and who reads has enough under way. It counts for so much where no places of what is under way to
/// memory are full for this part of a slice, unless the data alone take most of the slice. [M: the same]
constexpr double kUnawaited = 0.7, kAwaited = 0.1, kAllData = 0.9;
/// Of the waiting of a slice that is not for memory, cores that issue all the time would save so much: warps
/// are what others wait for, and a part of their time is their own issuing. [M: the same]
constexpr double kCoreWaiting = 0.3;
const std::string kCoreIssue = "core.issue";
/// Slices are joined until they are no shorter than this, and no more than so many: within a batch or a tile
/// units take turns, and that is no phase.
constexpr double kShortestSlice = 4000;
constexpr std::size_t kMostSlices = 24;
/// From this part of a slice on, places that are all taken hold it up.
constexpr double kTaken = 0.5;

constexpr std::string_view kMemoryKind = UnitKind<hw::MemoryChannel>::name;

/// Where a kind of places lies: the greater, the further downstream. Who is full because of a full place
/// further on waits for that. Places of what is under way to memory lie at the door of the L2 cache, behind
/// all other units that lead to it; of several of a unit, the one that it names first is the furthest
/// downstream. Units that are not of the plan come before those that are.
struct Downstream {
  std::ptrdiff_t at = 0, kind = 0, named = 0;
  bool operator<(const Downstream& other) const {
    return std::tie(at, kind, named) < std::tie(other.at, other.kind, other.named);
  }
};

Downstream downstream(std::string_view kind, const ResourceFigure& places, std::size_t named) {
  const std::vector<std::string_view>& kinds = kinds_downstream();
  const auto place_of = [&](std::string_view name) -> std::ptrdiff_t {
    const auto found = std::ranges::find(kinds, name);
    return found == kinds.end() ? -1 : found - kinds.begin();
  };
  const std::ptrdiff_t own = place_of(kind), door = place_of(UnitKind<hw::L2Slice>::name);
  return {places.memory ? 2 * door - 1 : 2 * own, own, -static_cast<std::ptrdiff_t>(named)};
}

/// What a slice of the frame took of a bound, and of each resource of it.
struct Bound {
  std::vector<double> use;                        ///< by slice, of the busiest unit
  std::vector<double> work;                       ///< the same without losses
  std::map<std::string, std::vector<double>> of;  ///< by resource
};

class Slices {
 public:
  explicit Slices(const Figures& f) {
    const auto cycles = static_cast<double>(f.frame.cycles);
    if (f.slice_cycles > 0) {
      while (static_cast<double>(joined_) * f.slice_cycles < std::max(kShortestSlice, cycles / kMostSlices))
        ++joined_;
      slice_ = static_cast<double>(joined_) * f.slice_cycles;
    } else slice_ = cycles;
    count_ = static_cast<std::size_t>(std::ceil(cycles / slice_));
    for (std::size_t s = 0; s < count_; ++s)
      lengths_.push_back(std::min(slice_, cycles - static_cast<double>(s) * slice_));
    for (const UnitFigures& unit : f.units) add(unit, cycles);
    for (const LinkFigures& link : f.links) add(link);
  }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] double length(std::size_t s) const { return lengths_[s]; }
  [[nodiscard]] const std::map<std::string, Bound>& rates() const { return rates_; }
  struct Places {
    std::vector<double> full;  ///< by slice: part of the time, of the fullest unit
    Downstream where;
    bool memory = false;  ///< of what is under way to memory, there too
  };
  [[nodiscard]] const std::map<std::string, Places>& places() const { return places_; }

 private:
  [[nodiscard]] std::vector<double> parts(const ResourceFigure& r, double per_cycle) const {
    std::vector<double> part(count_, 0);
    double before = 0;
    if (r.at_end_of.empty() && lengths_[0] > 0)
      part[0] = std::clamp(r.cycles / (lengths_[0] * per_cycle), 0.0, 1.0);
    if (r.at_end_of.empty()) return part;
    for (std::size_t s = 0; s < count_; ++s) {
      const double until = r.at_end_of[std::min(r.at_end_of.size(), (s + 1) * joined_) - 1];
      if (lengths_[s] > 0) part[s] = std::clamp((until - before) / (lengths_[s] * per_cycle), 0.0, 1.0);
      before = until;
    }
    return part;
  }
  void add(const UnitFigures& unit, double frame_cycles) {
    const std::string kind(without_number(unit.path));
    const double per_cycle = frame_cycles > 0 ? static_cast<double>(unit.cycles) / frame_cycles : 1;
    std::map<std::string, Bound> mine;
    for (std::size_t named = 0; named < unit.resources.size(); ++named) {
      const ResourceFigure& r = unit.resources[named];
      const std::string name = kind + "." + r.name;
      const std::vector<double> part = parts(r, per_cycle);
      if (r.kind == hw::Resource::Kind::kPlaces) {
        Places& places = places_[name];
        places.where = downstream(kind, r, named);
        places.memory = r.memory || kind == UnitKind<hw::L2Slice>::name || kind == kMemoryKind;
        places.full.resize(count_, 0);
        for (std::size_t s = 0; s < count_; ++s) places.full[s] = std::max(places.full[s], part[s]);
        continue;
      }
      Bound& bound = mine[r.serial.empty() ? name : kind + "." + r.serial];
      bound.use.resize(count_, 0);
      bound.work.resize(count_, 0);
      for (std::size_t s = 0; s < count_; ++s) {
        bound.use[s] += part[s];
        if (r.kind == hw::Resource::Kind::kRate) bound.work[s] += part[s];
      }
      bound.of[name] = part;
    }
    for (auto& [name, bound] : mine) merge(rates_[name], bound);
  }
  /// The busiest unit of a kind counts, slice by slice.
  void merge(Bound& all, const Bound& one) const {
    all.use.resize(count_, -1);
    all.work.resize(count_, 0);
    for (const auto& [name, part] : one.of) all.of[name].resize(count_, 0);
    for (std::size_t s = 0; s < count_; ++s) {
      if (one.use[s] <= all.use[s]) continue;
      all.use[s] = one.use[s];
      all.work[s] = one.work[s];
      for (const auto& [name, part] : one.of) all.of[name][s] = part[s];
    }
  }
  void add(const LinkFigures& link) {
    Bound& bound = rates_[link.key];
    if (bound.use.empty() || bound.use[0] < link.use) bound.use.assign(count_, link.use);
    bound.of[link.key] = bound.work = bound.use;
  }

  std::size_t joined_ = 1, count_ = 1;
  double slice_ = 0;
  std::vector<double> lengths_;
  std::map<std::string, Bound> rates_;
  std::map<std::string, Places> places_;
};

/// The full places of a slice that are furthest downstream; empty if none.
std::string_view full_places(const Slices& slices, std::size_t s) {
  std::string_view furthest;
  const Downstream* where = nullptr;
  for (const auto& [name, places] : slices.places()) {
    if (places.full[s] < kTaken || (where != nullptr && places.where < *where)) continue;
    furthest = name;
    where = &places.where;
  }
  return furthest;
}

/// How far a bound counts in a slice, 0..1.
double weight(const Slices& slices, std::size_t s, std::string_view name, const Bound& bound) {
  if (!name.starts_with(kMemoryKind) || bound.work[s] >= kAllData) return 1;
  const bool awaited = std::ranges::any_of(slices.places(), [s](const auto& places) {
    return places.second.memory && places.second.full[s] >= kAwaited;
  });
  return awaited ? 1 : kUnawaited;
}

/// What the bounds of a slice come to together.
struct SliceBounds {
  double sum = 0;     ///< of the powers of the uses
  double reach = 0;   ///< their norm
  bool link = false;  ///< the greatest is a link's
};

SliceBounds bounds_of(const Slices& slices, std::size_t s) {
  SliceBounds bounds;
  double greatest = -1;
  for (const auto& [name, bound] : slices.rates()) {
    const double use = weight(slices, s, name, bound) * bound.use[s];
    bounds.sum += std::pow(use, kNorm);
    if (use <= greatest) continue;
    greatest = use;
    bounds.link = name.starts_with("link.");
  }
  bounds.reach = std::pow(bounds.sum, 1 / kNorm);
  return bounds;
}

/// What doubling each rate saves of the cycles that the slice's bounds limit.
void add_rates(const Slices& slices, std::size_t s, const SliceBounds& bounds, double cycles,
               std::map<std::string, double>& gains) {
  if (bounds.reach <= 0) return;
  for (const auto& [name, bound] : slices.rates()) {
    const double counts = weight(slices, s, name, bound), use = counts * bound.use[s];
    for (const auto& [resource, part] : bound.of) {
      const double rest = bounds.sum - std::pow(use, kNorm) + std::pow(use - counts * part[s] / 2, kNorm);
      gains[resource] += cycles * (1 - std::pow(std::max(0.0, rest), 1 / kNorm) / bounds.reach);
    }
  }
}

void add_slice(const Slices& slices, std::size_t s, std::map<std::string, double>& gains,
               double& waiting_cycles) {
  const SliceBounds bounds = bounds_of(slices, s);
  const std::string_view full = full_places(slices, s);
  const Reach& between = bounds.link ? kReachOfLink : full.empty() ? kReach : kReachWithFullPlaces;
  const double work =
      std::clamp((bounds.reach - between.waiting) / (between.work - between.waiting), 0.0, 1.0);
  const double waiting = slices.length(s) * (1 - work);
  add_rates(slices, s, bounds, slices.length(s) * work, gains);
  if (full.empty()) waiting_cycles += waiting;
  else gains[std::string(full)] += waiting * (1 - std::max(0.5, std::min(1.0, bounds.reach)));
  const bool for_memory = !full.empty() && slices.places().at(std::string(full)).memory;
  if (const auto issue = slices.rates().find(kCoreIssue); issue != slices.rates().end() && !for_memory)
    gains[kCoreIssue] += waiting * kCoreWaiting * issue->second.use[s];
}

}  // namespace

double use_of(const UnitFigures& unit) {
  std::map<std::string, double> bounds;
  for (const ResourceFigure& r : unit.resources)
    if (r.kind == hw::Resource::Kind::kRate) bounds[r.serial.empty() ? r.name : r.serial] += r.cycles;
  double most = 0;
  for (const auto& [name, cycles] : bounds) most = std::max(most, cycles);
  return unit.cycles > 0 ? most / static_cast<double>(unit.cycles) : 0;
}

SpeedOfLight speed_of_light(const Figures& f) {
  SpeedOfLight light;
  const auto consider = [&](double use, const std::string& resource) {
    const double cycles = use * static_cast<double>(f.frame.cycles);
    if (cycles > light.cycles) light = {cycles, resource};
  };
  for (const UnitFigures& unit : f.units) consider(use_of(unit), std::string(without_number(unit.path)));
  for (const LinkFigures& link : f.links) consider(link.use, link.key);
  return light;
}

Sensitivity sensitivity(const Figures& f) {
  Sensitivity result;
  if (f.units.empty() || f.frame.cycles <= 0) return result;
  const Slices slices(f);
  std::map<std::string, double> gains;
  double waiting = 0;
  for (std::size_t s = 0; s < slices.count(); ++s) add_slice(slices, s, gains, waiting);
  const auto cycles = static_cast<double>(f.frame.cycles);
  for (const auto& [resource, gain] : gains) result.gains.push_back({resource, gain, gain / cycles});
  std::ranges::stable_sort(result.gains, std::ranges::greater{}, &Gain::cycles);
  const auto mean = [&](const std::vector<double>& part) {
    double sum = 0;
    for (std::size_t s = 0; s < slices.count(); ++s) sum += part[s] * slices.length(s);
    return sum / cycles;
  };
  for (const auto& [name, bound] : slices.rates())
    for (const auto& [resource, part] : bound.of) result.uses.push_back({resource, mean(part), false});
  for (const auto& [name, places] : slices.places()) result.uses.push_back({name, mean(places.full), true});
  std::ranges::stable_sort(result.uses, [](const ResourceUse& a, const ResourceUse& b) {
    return a.places != b.places ? b.places : a.use > b.use;
  });
  result.waiting = waiting / cycles;
  return result;
}

}  // namespace quadrille::pipeline
