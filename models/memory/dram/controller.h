/// A memory controller and the DRAM behind it: takes requests for lines, sends commands, and says when each
/// request's data have moved.
///
/// Cycles are those of the command clock. A caller puts requests in while there is `room`, asks for the
/// `next` cycle in which a command can go out, and steps the controller at that cycle or later; requests
/// arrive in order of time. Between two requests nothing else happens: refresh and idle rows of a controller
/// without requests are caught up with when the next one arrives. A pseudo-channel sends at most one command
/// a cycle on each of its buses.
#pragma once

#include "models/memory/dram/bus_account.h"
#include "models/memory/dram/command.h"
#include "models/memory/dram/device.h"
#include "models/memory/dram/mapping.h"
#include "models/memory/dram/page_policy.h"
#include "models/memory/dram/refresh.h"
#include "models/memory/dram/request_queue.h"
#include "models/memory/dram/scheduler.h"
#include "models/memory/dram/write_drain.h"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace quadrille::models {

struct DramControllerParams {
  DramTiming timing;
  const DramMappingPolicy* mapping = &kRowMapping;
  bool hash = true;
  const DramSchedulerPolicy* scheduler = &kFirstReadyScheduler;
  int in_order_ahead = 0;  ///< in order: requests behind the oldest whose rows are prepared
  std::int64_t age_cap = 1000;
  const DramWriteDrainPolicy* write_drain = &kWatermarkWriteDrain;
  int write_high = 112, write_low = 16;  ///< of the whole controller
  const DramPagePolicyEntry* page = &kOpenPages;
  std::int64_t page_idle = 200;
  int reads = 64, writes = 128;  ///< requests that it holds
};

struct DramRequest {
  std::uint64_t line = 0;    ///< of the channel's own address space
  std::uint8_t sectors = 0;  ///< of 32 bytes, a bit each
  bool write = false;
  std::uint32_t id = 0;  ///< comes back with the answer
};

/// its row was open; its bank was closed; another row was open
enum class DramRowOutcome : std::uint8_t { kHit, kMiss, kConflict };

struct DramDone {
  std::uint32_t id = 0;
  bool write = false;
  DramRowOutcome row = DramRowOutcome::kHit;
  std::int64_t arrived = 0, done = 0;  ///< cycles: taken in; last data moved
};

struct DramCommandCounts {
  std::uint64_t activates = 0, precharges = 0, reads = 0, writes = 0, refreshes = 0;
};

class DramController {
 public:
  using Cycle = std::int64_t;
  using Trace = std::function<void(const DramCommand&)>;
  static constexpr Cycle kNever = INT64_MAX;

  explicit DramController(const DramControllerParams& params);
  ~DramController();
  DramController(const DramController&) = delete;
  DramController& operator=(const DramController&) = delete;

  [[nodiscard]] bool room(bool write) const {
    return held_[write] < (write ? params_.writes : params_.reads);
  }
  [[nodiscard]] int held(bool write) const { return held_[write]; }
  /// At `now`, not before any earlier call.
  void take(const DramRequest& request, Cycle now);
  /// First cycle, not before `now`, in which a command can go out for what is held; kNever when nothing is.
  [[nodiscard]] Cycle next() const {
    if (!fresh_) update();
    return next_;
  }
  /// Sends the commands of cycle `now`, which is not before next(). Requests whose last command went out are
  /// added to `done`.
  void step(Cycle now, std::vector<DramDone>& done);
  /// The cycles of the data buses up to `end`, summed over the pseudo-channels: `end` times their number.
  /// Nothing may be held.
  [[nodiscard]] BusAccount::Cycles bus_cycles(Cycle end) const;
  /// Cycles of a use so far, summed over the pseudo-channels.
  [[nodiscard]] std::int64_t charged(BusUse use) const;
  [[nodiscard]] const DramCommandCounts& counts() const { return counts_; }
  /// Gets every command, in order of time for each pseudo-channel.
  void set_trace(Trace trace) { trace_ = std::move(trace); }
  [[nodiscard]] const DramTiming& timing() const { return params_.timing; }

 private:
  class PseudoChannel;
  struct PseudoChannels;
  [[nodiscard]] int held() const { return held_[0] + held_[1]; }
  void update() const;
  void step_channels(Cycle now, std::vector<DramDone>& done, const Trace& trace);
  /// Does what a controller without requests would have done before `now`.
  void catch_up(Cycle now);
  /// The same, command by command.
  void step_idle(Cycle end, const Trace& trace);
  /// Once refresh repeats, leaves out the rounds of it that end before `now`.
  void skip_rounds(Cycle now);
  /// Commands of the next round of refresh, from its begin on; empty when others than refreshes were sent.
  [[nodiscard]] std::vector<std::array<Cycle, 4>> idle_round(Cycle round);

  DramControllerParams params_;
  std::unique_ptr<DramMapping> mapping_;
  std::unique_ptr<PseudoChannels> parts_;
  int held_[2] = {0, 0};
  std::uint64_t seq_ = 0;
  Cycle now_ = 0, caught_up_ = 0;
  mutable Cycle next_ = kNever;
  mutable bool fresh_ = true;  ///< next_ was found after the last change
  std::size_t turn_ = 0;       ///< who goes first where a command bus is shared
  DramCommandCounts counts_;
  Trace trace_;
};

}  // namespace quadrille::models
