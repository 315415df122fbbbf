/// A hardware unit: an `sc_module` that answers when it could act next, and acts.
///
/// `next()` gives the earliest tick at which some action is possible, and which port was satisfied last;
/// `act(now)` consumes, computes through `models/` and produces. Units never call each other: a push or a pop
/// marks the peer, and the driver asks it again. The base class charges every cycle once:
///   busy     an initiation slot is in use (`occupy`)
///   waiting  for something of its own that is under way: its latency, or a timer
///   starved  waiting for an input          blocked  waiting for an output
///   idle     no token of any draw in flight can still reach the unit
#pragma once

#include "hw/base/audit.h"
#include "hw/base/counter.h"
#include "hw/base/details.h"
#include "hw/base/facet.h"
#include "hw/base/fifo.h"
#include "hw/base/resource.h"

#include <array>
#include <functional>
#include <utility>
#include <vector>

namespace quadrille::hw {

class ChargeLog;
class LegLog;

/// The answer of `next()`: the earliest tick of an action and what it had to wait for. Build it from the
/// unit's own readiness, then inputs, then outputs.
class Wake {
 public:
  /// An action that only needs the unit's own resource, free at `own`.
  explicit Wake(Tick own = 0) : own_(own) {}
  static Wake never(const PortBase& cause) {
    Wake w;
    w.wait_ = kNever;
    w.cause_ = &cause;
    return w;
  }
  template <class T>
  Wake& input(const FifoIn<T>& port) {
    return constrain(port.ready(), port, false);
  }
  template <class T>
  Wake& output(const FifoOut<T>& port) {
    return constrain(port.room(), port, true);
  }
  /// Waits until `t` for something that will arrive through, or be freed by, `port`.
  Wake& until(Tick t, const PortBase& port) {
    return constrain(t, port, port.direction() == PortBase::Direction::kOut);
  }

  /// The same action, but not before `t`: the unit's own state allows none earlier.
  [[nodiscard]] Wake not_before(Tick t) const {
    Wake w = *this;
    if (w.own_ < t) w.own_ = t;
    return w;
  }

  [[nodiscard]] Tick at() const { return own_ > wait_ ? own_ : wait_; }
  /// End of the waiting on others: max over inputs and outputs.
  [[nodiscard]] Tick waited_until() const { return wait_; }
  /// The port satisfied last; null if there was none to wait for.
  [[nodiscard]] const PortBase* cause() const { return cause_; }
  /// The sooner of two possible actions; the first on a tie.
  [[nodiscard]] static Wake sooner(const Wake& a, const Wake& b) {
    const bool second = b.at() < a.at();
    Wake w;
    w.own_ = second ? b.own_ : a.own_;
    w.wait_ = second ? b.wait_ : a.wait_;
    w.cause_ = second ? b.cause_ : a.cause_;
    return w;
  }

 private:
  // Plain selections, here and above: which constraint comes last is the least predictable branch of a
  // simulation.
  Wake& constrain(Tick t, const PortBase& port, bool wins_ties) {
    const bool last = t > wait_ - static_cast<Tick>(wins_ties);
    wait_ = last ? t : wait_;
    cause_ = last ? &port : cause_;
    return *this;
  }
  Tick own_ = 0, wait_ = 0;
  const PortBase* cause_ = nullptr;
};

/// Intervals in which no draw was in flight, recorded by the command processor and shared by all units of a
/// machine.
class QuietLog {
 public:
  struct Interval {
    Tick from = 0, to = 0;
  };
  void add(Tick from, Tick to) {
    if (to > from) intervals_.push_back({from, to});
  }
  [[nodiscard]] const std::vector<Interval>& intervals() const { return intervals_; }
  [[nodiscard]] bool any_after(Tick t) const { return !intervals_.empty() && intervals_.back().to > t; }

 private:
  std::vector<Interval> intervals_;
};

class Unit : public sc_core::sc_module {
 public:
  /// Fixed-order: what it does next depends only on its own state and on token contents, so it may be
  /// simulated ahead until a FIFO stops it. Chooser: it sees which input is ready first or whether there is
  /// room, so it waits until nothing earlier can still happen.
  enum class Kind : std::uint8_t { kFixedOrder, kChooser };

  Unit(sc_core::sc_module_name name, Kind kind, const Clock& clock);

  /// Earliest possible action; kNever while it is unknown. Pure: called as often as the driver likes.
  [[nodiscard]] virtual Wake next() const = 0;
  /// Performs that action. `now` is an edge of the unit's clock: `next().at()`, or the latest action's tick
  /// if that is later.
  virtual void act(Tick now) = 0;
  /// May a window let this chooser run ahead of what can still reach it? Not one that picks the best of all
  /// it holds: each late arrival would be a wrong choice.
  [[nodiscard]] virtual bool may_run_ahead() const { return true; }
  /// One line on what the unit holds, for the deadlock report.
  [[nodiscard]] virtual std::string state_text() const { return {}; }
  [[nodiscard]] virtual const StatGroup* stats() const { return nullptr; }
  /// Adds what it counted to the laws that concern it. After `finish_stats`.
  virtual void audit(Audit& audit) const { (void)audit; }
  /// Names the counters that are kept by draw and by part of the screen.
  virtual void details(Details& details) const { (void)details; }
  /// What its row of the table shows. After `finish_stats`.
  [[nodiscard]] virtual std::vector<Facet> row() const { return {}; }
  /// The frame ended at `end`: counts of time that go on up to there are brought up to date.
  virtual void finish_stats(Tick end) { (void)end; }

  /// What drivers ask: `next()`, but not before the latest action, since the unit's state was another one
  /// then.
  [[nodiscard]] Wake wake() const { return next().not_before(last_action_); }
  /// Charges the gap before the action, then acts. `wake` is what `wake()` answers now.
  void perform(const Wake& wake) {
    const Tick now = wake.at();
    if (!resources_.empty()) resources_.note(now, last_action_ < 0 ? now : last_action_, clock_.period());
    last_action_ = now;
    if (now > accounted_) charge_gap(wake);
    ++actions_;
    act(now);
  }
  /// Charges what is left up to `end` and closes the accounts; for `close_accounts`. After `reachable_until`
  /// no token of a draw was on its way to this unit.
  void close(Tick end, Tick reachable_until);

  [[nodiscard]] Kind unit_kind() const { return kind_; }
  [[nodiscard]] const Clock& clock() const { return clock_; }
  [[nodiscard]] const std::vector<PortBase*>& ports() const { return ports_; }
  void add_port(PortBase& port) { ports_.push_back(&port); }
  /// Binds ports to channels; called once by the driver, after SystemC's elaboration.
  void attach();
  /// Tells the driver that something this unit may have waited for happened.
  void touch() { *touched_word_ |= touched_bit_; }
  void set_touch_flag(std::uint64_t* word, int bit) {
    touched_word_ = word;
    touched_bit_ = std::uint64_t{1} << bit;
  }
  [[nodiscard]] std::uint64_t* touched_word() const { return touched_word_; }
  [[nodiscard]] std::uint64_t touched_bit() const { return touched_bit_; }
  void set_quiet_log(const QuietLog& log) { quiet_ = &log; }
  /// What its time goes to is written into `log`, up to the frame's end. Before the run.
  void keep_charges(ChargeLog& log) { charge_log_ = &log; }
  /// The same of each piece of work, where the unit has many in hand; else `log` stays empty.
  void keep_legs(LegLog& log) { leg_log_ = &log; }

  [[nodiscard]] std::int64_t busy_cycles() const { return to_cycles(busy_); }
  /// The span behind `busy_cycles`, where it is kept; for a log of whom the unit was busy for.
  [[nodiscard]] const std::int64_t& busy_storage() const { return busy_; }
  [[nodiscard]] std::int64_t waiting_cycles() const { return to_cycles(waiting_); }
  [[nodiscard]] std::int64_t starved_cycles() const { return to_cycles(starved_); }
  [[nodiscard]] std::int64_t blocked_cycles() const { return to_cycles(blocked_); }
  [[nodiscard]] std::int64_t idle_cycles() const { return to_cycles(idle_); }
  [[nodiscard]] std::int64_t total_cycles() const { return total_; }
  [[nodiscard]] std::uint64_t actions() const { return actions_; }
  [[nodiscard]] const Resources& resources() const { return resources_; }
  /// Before the run: `row` is asked for its numbers at the end of every slice (`resources().rows()`).
  void keep_rows(std::function<Resources::Row()> row) { resources_.keep_rows(std::move(row)); }
  /// Its slices become those of a machine's common length; for `close_accounts`.
  void finish_resources(Tick end, Tick slice) { resources_.finish(end, slice); }
  /// Tick of the latest action; -1 before the first.
  [[nodiscard]] Tick last_action() const { return last_action_; }
  /// A span of this unit's accounts in cycles.
  [[nodiscard]] std::int64_t to_cycles(std::int64_t span) const {
    return clock_.spans_are_cycles() ? span / clock_.period() : span;
  }

 protected:
  /// The unit's initiation slot is used for `cycles` from `now` on. Overlapping uses count once.
  void occupy(Tick now, std::int64_t cycles) {
    const Tick until = clock_.after(now, cycles);
    if (until <= accounted_) return;
    busy_ += span(accounted_, until);
    accounted_ = until;
    note_charge(busy_);
  }
  [[nodiscard]] Tick after(Tick now, std::int64_t cycles) const { return clock_.after(now, cycles); }
  /// Null while nobody asks for legs.
  [[nodiscard]] LegLog* leg_log() const { return leg_log_; }
  // What the unit needs for its work, named in its constructor; names are those of the parameters that set
  // them, where one does. The initiation slot is a rate whose work is the busy cycles.
  void add_rate(std::string_view name, std::function<double()> cycles, std::string_view serial = {}) {
    resources_.add_rate(
        name, [cycles = std::move(cycles)](Tick) { return cycles(); }, serial);
  }
  /// Of work that goes on between actions: up to a tick that is not before the latest.
  void add_rate_until(std::string_view name, std::function<double(Tick)> cycles) {
    resources_.add_rate(name, std::move(cycles));
  }
  void add_loss(std::string_view name, std::function<double()> cycles, std::string_view serial) {
    resources_.add_loss(
        name, [cycles = std::move(cycles)](Tick) { return cycles(); }, serial);
  }
  void add_initiation_rate(std::string_view name) {
    add_rate(name, [this] { return static_cast<double>(busy_cycles()); });
  }
  void add_places(std::string_view name, std::function<bool()> full) {
    resources_.add_places(name, std::move(full));
  }
  /// Places of what is under way to memory: they lie further downstream than all but the memory's own.
  void add_memory_places(std::string_view name, std::function<bool()> full) {
    resources_.add_places(name, std::move(full), true);
  }

 private:
  /// Accounts are kept in spans: ticks where every span is a number of cycles (no division on the way), and
  /// elsewhere the cycles that begin in the span.
  [[nodiscard]] std::int64_t span(Tick from, Tick to) const {
    return clock_.spans_are_cycles() ? to - from : clock_.cycles(from, to);
  }
  void charge_gap(const Wake& wake) {
    if (wake.waited_until() > accounted_) charge_wait(wake.waited_until(), wake.cause());
    if (wake.at() > accounted_) {
      waiting_ += span(accounted_, wake.at());
      accounted_ = wake.at();
      note_charge(waiting_);
    }
  }
  void charge_wait(Tick until, const PortBase* cause);
  /// The latest charges, up to `accounted_`: what lies behind the frame's end is taken back once that is
  /// known.
  struct Charge {
    Tick to = 0;
    std::int64_t* of = nullptr;
    const PortBase* port = nullptr;
  };
  /// more than a unit has behind the frame's end, but for a memory channel with much to write back
  static constexpr std::uint32_t kLateCharges = 256;
  void note_charge(std::int64_t& of, const PortBase* port = nullptr) {
    late_[charges_++ % kLateCharges] = {accounted_, &of, port};
    if (charge_log_ != nullptr) [[unlikely]]
      log_charge(of, port);
  }
  void log_charge(const std::int64_t& of, const PortBase* port);
  void take_back_from(Tick end);
  void take_back_rest(Tick end);
  /// Span within [from, to) in which no draw was in flight.
  [[nodiscard]] std::int64_t quiet_span(Tick from, Tick to) const;

  Tick accounted_ = 0;  ///< every cycle before this tick is charged
  Tick last_action_ = -1;
  std::uint64_t actions_ = 0;
  std::int64_t busy_ = 0, waiting_ = 0, starved_ = 0, blocked_ = 0, idle_ = 0;  ///< spans
  std::array<Charge, kLateCharges> late_{};
  std::uint32_t charges_ = 0;
  Resources resources_;
  Clock clock_;
  const QuietLog* quiet_ = nullptr;
  ChargeLog* charge_log_ = nullptr;
  LegLog* leg_log_ = nullptr;
  std::uint64_t unbound_word_ = 0;
  std::uint64_t* touched_word_ = &unbound_word_;
  std::uint64_t touched_bit_ = 1;
  std::int64_t total_ = 0;  ///< cycles
  Kind kind_;
  std::vector<PortBase*> ports_;
};

/// Closes the accounts of all units of a machine: a unit waits until the last tick at which a token of a draw
/// moved on any flow that leads to it, and is idle from there to `end`.
void close_accounts(const std::vector<Unit*>& units, Tick end);

}  // namespace quadrille::hw
