/// A driver that holds every unit to the contract of `Unit`: it advances one action at a time, in order of
/// time, and asks all units again after each.
///
/// What it finds wrong:
///   an answer in the past: a unit that could have acted earlier than it said when it was asked before
///   an answer that changes although the unit did not act and nobody touched it: drivers would not ask again
///   two answers in a row that differ: `next()` has to be pure
///   a unit that goes on acting at one tick: its action does nothing
/// A push into a full FIFO and a pop of what is not visible are caught by the FIFO itself.
#pragma once

#include "hw/base/driver.h"

#include <string>
#include <vector>

namespace quadrille::hw {

class StrictDriver final : public Driver {
 public:
  using Driver::Driver;
  /// One line a violation, the first of each unit; empty when the contract was kept.
  [[nodiscard]] const std::vector<std::string>& violations() const { return violations_; }

 protected:
  /// The whole run: no process of SystemC is needed.
  void prepare() override;

 private:
  /// Asks a unit, twice.
  [[nodiscard]] Tick ask(std::size_t unit);
  void perform(std::size_t unit);
  /// Asks all units after an action of `actor` at `now`.
  void ask_all(std::size_t actor, Tick now);
  [[nodiscard]] bool touched(std::size_t unit) const;
  void violation(std::size_t unit, const std::string& text);

  std::vector<Tick> answers_;  ///< by unit
  std::vector<int> repeats_;   ///< by unit: actions at the tick of its latest
  std::vector<bool> accused_;
  std::vector<std::string> violations_;
};

}  // namespace quadrille::hw
