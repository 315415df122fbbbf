/// What both drivers share: the units of a machine, the marks they leave, and how a run ends.
///
/// `Dispatcher` (default) advances all units inside one SC_METHOD; `NativeDriver` gives each unit its own
/// SC_METHOD and event on SystemC's scheduler, for people who embed units in their own SystemC models. Both
/// produce the same cycles; tests hold them to it.
#pragma once

#include "hw/base/unit.h"

#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace quadrille::hw {

enum class RunEnd : std::uint8_t {
  /// no unit can act any more: the work is done, or the machine is deadlocked (`deadlock_report`)
  kQuiescent,
  kTimeLimit,
};

struct RunLimits {
  Tick max_time = kNever;
  /// Called now and then with the simulated time; for progress bars.
  std::function<void(Tick)> progress;
};

class Driver : public sc_core::sc_module {
 public:
  /// Sets SystemC's time resolution to 1 fs: create the driver before anything that makes an `sc_time`.
  explicit Driver(sc_core::sc_module_name name);
  /// Adds a unit; the order must not matter (tests shuffle it).
  void add(Unit& unit) { units_.push_back(&unit); }
  [[nodiscard]] const std::vector<Unit*>& units() const { return units_; }
  /// Runs until nothing can act or the limit is met. Call once, instead of `sc_start`. Throws what an action
  /// throws.
  RunEnd run(const RunLimits& limits);
  /// Total actions performed by all units.
  [[nodiscard]] std::uint64_t actions() const;
  /// Tick of the latest action of any unit; -1 if there was none.
  [[nodiscard]] Tick last_action() const;
  /// Permutes the units. It must not change anything; tests hold the drivers to it. Before `run`.
  void shuffle(std::uint64_t seed);

 protected:
  /// Ports, links and marks are ready, every unit is marked; create processes here.
  virtual void prepare() = 0;
  /// Does the work of a process. What it throws ends the run and leaves `run`: SystemC would make an error of
  /// its own of it, and of its kind.
  template <class Work>
  void guard(const Work& work) {
    if (failure_) return;
    try {
      work();
    } catch (...) { failure_ = std::current_exception(); }
  }

  std::vector<Unit*> units_;
  std::vector<std::uint64_t> touched_;  ///< one bit a unit: its `next()` may have changed
  RunLimits limits_;

 private:
  std::exception_ptr failure_;  ///< once set, no unit acts any more
};

/// Every link of a machine's units, once: by consumer.
[[nodiscard]] std::vector<FifoBase*> links_of(const std::vector<Unit*>& units);

/// Tokens that lie in the links of these units. Not 0 after a quiescent run: somebody waits for what will
/// never come.
[[nodiscard]] std::int64_t tokens_in_links(const std::vector<Unit*>& units);

/// Who waits for whom at tick `now`: one line a waiting unit.
[[nodiscard]] std::string waiting_report(const std::vector<Unit*>& units, Tick now);
/// Who waits for whom when nothing can act: one line a waiting unit, the shortest cycle of waiting, and the
/// FIFO to blame; without a cycle, the tokens that nobody takes and what their consumers wait for. `now` is
/// the tick of the latest action.
[[nodiscard]] std::string deadlock_report(const std::vector<Unit*>& units, Tick now);

}  // namespace quadrille::hw
