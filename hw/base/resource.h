/// What a unit needs to do its work, and how much of it a frame took: the base of its use, of the frame's
/// speed of light and of what limits it.
///
///   rate     work that can be done at so much a cycle: cycles that the counted work takes at that rate. No
///   frame is shorter than that. loss     cycles in which a rate's resource could not work (a data bus that
///   waits for a row). They are part of what limits the frame, but no work: another order
///            of the same work loses others.
///   places   a number of things that can be under way: cycles in which all places were taken.
/// Rates and losses of one `serial` group follow each other on the same resource, so their cycles add up.
///
/// Both are sampled over the frame, so that a frame of unlike phases can be told from an even one: slice i
/// ends at the start of the frame plus (i + 1) slice lengths. Who wants other numbers of the unit at the same
/// moments asks for rows of them (`keep_rows`).
#pragma once

#include "hw/base/clock.h"

#include <cstdint>
#include <functional>
#include <string_view>
#include <utility>
#include <vector>

namespace quadrille::hw {

struct Resource {
  enum class Kind : std::uint8_t { kRate, kLoss, kPlaces };
  std::string_view name;
  Kind kind = Kind::kRate;
  std::string_view serial = {};
  /// kRate, kLoss: up to a tick that is not before the latest action, of the unit's clock
  std::function<double(Tick)> cycles = {};
  double taken = 0;                    ///< kPlaces: cycles in which it was full, so far
  bool memory = false;                 ///< kPlaces: of what is under way to memory
  std::vector<double> at_end_of = {};  ///< by slice: what it had come to
  [[nodiscard]] double total(Tick at) const { return kind == Kind::kPlaces ? taken : cycles(at); }
};

class Resources {
 public:
  /// Slices of a frame: between half of that and that.
  static constexpr std::size_t kMostSlices = 256;
  /// Length of a slice at first; it doubles whenever a frame would have more than kMostSlices.
  static constexpr Tick kFirstSlice = 512'000'000;  // fs: 512 cycles at 1 GHz

  /// Work up to a tick, in cycles of the unit's clock at its peak rate.
  void add_rate(std::string_view name, std::function<double(Tick)> cycles, std::string_view serial = {}) {
    all_.push_back(
        {.name = name, .kind = Resource::Kind::kRate, .serial = serial, .cycles = std::move(cycles)});
  }
  void add_loss(std::string_view name, std::function<double(Tick)> cycles, std::string_view serial) {
    all_.push_back(
        {.name = name, .kind = Resource::Kind::kLoss, .serial = serial, .cycles = std::move(cycles)});
  }
  /// Are all places taken now? Of several kinds of places, the one named first is the furthest downstream.
  void add_places(std::string_view name, std::function<bool()> full, bool memory = false) {
    places_.push_back({all_.size(), std::move(full)});
    all_.push_back({.name = name, .kind = Resource::Kind::kPlaces, .memory = memory});
  }
  /// `row` is asked at the end of every slice for numbers that grow: equally many each time.
  using Row = std::vector<std::uint64_t>;
  void keep_rows(std::function<Row()> row) { row_ = std::move(row); }
  /// By slice that has ended.
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  /// There is nothing to note.
  [[nodiscard]] bool empty() const { return all_.empty() && !row_; }
  [[nodiscard]] const std::vector<Resource>& all() const { return all_; }
  [[nodiscard]] Tick slice() const { return slice_; }
  /// An action follows at `now`; nothing has changed since `since`. Called before every action of a unit.
  void note(Tick now, Tick since, Tick period) {
    for (const Place& place : places_)
      if (place.full())
        all_[place.of].taken += static_cast<double>(now - since) / static_cast<double>(period);
    if (now >= next_slice_) end_slices(now);
  }
  /// The slices up to `end`, of `slice` each, which is at least `slice()` and a power of two times it.
  void finish(Tick end, Tick slice);

 private:
  void end_slices(Tick now);
  void end_slice(Tick at);
  void double_slice();
  struct Place {
    std::size_t of;  ///< in `all_`
    std::function<bool()> full;
  };
  std::vector<Resource> all_;
  std::vector<Place> places_;
  std::function<Row()> row_;
  std::vector<Row> rows_;
  Tick slice_ = kFirstSlice, next_slice_ = kFirstSlice;
  std::size_t ended_ = 0;  ///< slices
};

}  // namespace quadrille::hw
