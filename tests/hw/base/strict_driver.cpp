#include "tests/hw/base/strict_driver.h"

#include <algorithm>

namespace quadrille::hw {

namespace {
/// More actions than a unit has reason for at one tick.
constexpr int kMostRepeats = 1000;
}  // namespace

void StrictDriver::violation(std::size_t unit, const std::string& text) {
  if (accused_[unit]) return;
  accused_[unit] = true;
  violations_.push_back(fmt::format("{} {}", units_[unit]->name(), text));
}

bool StrictDriver::touched(std::size_t unit) const {
  return (*units_[unit]->touched_word() & units_[unit]->touched_bit()) != 0;
}

Tick StrictDriver::ask(std::size_t unit) {
  const Tick first = units_[unit]->wake().at(), second = units_[unit]->wake().at();
  if (first != second)
    violation(unit, fmt::format("answers {} fs, and {} fs when it is asked again", first, second));
  return second;
}

void StrictDriver::perform(std::size_t unit) {
  const Tick last = units_[unit]->last_action();
  units_[unit]->perform(units_[unit]->wake());
  repeats_[unit] = units_[unit]->last_action() == last ? repeats_[unit] + 1 : 0;
}

void StrictDriver::ask_all(std::size_t actor, Tick now) {
  for (std::size_t u = 0; u < units_.size(); ++u) {
    const Tick answer = ask(u);
    if (u != actor && answer != answers_[u] && !touched(u))
      violation(u, fmt::format("answers {} fs instead of {} fs, though it did not act and nobody touched it",
                               answer, answers_[u]));
    if (answer < now) violation(u, fmt::format("answers {} fs at {} fs", answer, now));
    answers_[u] = answer;
  }
  std::ranges::fill(touched_, std::uint64_t{0});
}

void StrictDriver::prepare() {
  // All is done here: SystemC has nothing to do when it starts.
  sc_core::sc_report_handler::set_actions(sc_core::SC_ID_NO_SC_START_ACTIVITY_, sc_core::SC_DO_NOTHING);
  answers_.assign(units_.size(), kNever);
  repeats_.assign(units_.size(), 0);
  accused_.assign(units_.size(), false);
  for (std::size_t u = 0; u < units_.size(); ++u) answers_[u] = ask(u);
  std::ranges::fill(touched_, std::uint64_t{0});
  while (true) {
    const auto next = std::ranges::min_element(answers_);
    if (next == answers_.end() || *next > limits_.max_time) return;
    const Tick now = *next;
    const auto actor = static_cast<std::size_t>(next - answers_.begin());
    perform(actor);
    if (repeats_[actor] > kMostRepeats) {
      violation(actor, fmt::format("acts and acts at {} fs", now));
      return;
    }
    ask_all(actor, now);
  }
}

}  // namespace quadrille::hw
