/// Command processor: walks the frame's passes and draws, keeps a bounded number of draws in flight, and sets
/// barriers between passes.
///
/// In    retire_in[p]  draw retired in partition p, or pass flushed there
///       scan_done_in  the image was read
/// Out   draw_out[f]   draws and pass boundaries, in order, to each geometry front end
///       scan_out      show a pass's target
/// Time  `draw_clk` cycles a draw; waits while `draws_in_flight` draws are not retired everywhere; a pass
///       ends when all partitions have flushed. With `cull_draws` a draw that the driver has found outside of
///       the view volume takes its `draw_clk` cycles, and nothing is sent for it
/// Not modelled: fetching and parsing the command buffer itself (docs/deviations.md#D1)
#pragma once

#include "hw/base/fifo_group.h"
#include "hw/base/param.h"
#include "hw/frame/frame.h"
#include "hw/frame/tokens.h"
#include "hw/frame/unit_context.h"

namespace quadrille::hw {

class CommandProcessor final : public Unit {
 public:
  struct Params : ParamGroup {
    Param<int> draw_clk{*this,
                        "draw_clk",
                        16,
                        "clk/draw",
                        {1, 1 << 20},
                        "Cycles to issue a draw's state and launch it. [G: a few register writes a draw]",
                        Effect::kSlower};
    Param<int> draws_in_flight{
        *this,      "draws_in_flight",
        32,         "draw",
        {1, 65536}, "Draws whose state is kept at a time. [G: context slots of the front end]"};
    Param<bool> cull_draws{
        *this, "cull_draws", false, "",
        "Drop draws whose box lies outside the view volume. The test is part of draw_clk."};
  };
  struct Stats : StatGroup {
    Counter draws{*this, "draws", "draw", "Draws issued"};
    Counter draws_culled{*this, "draws_culled", "draw",
                         "Draws dropped: their boxes lie outside the view volume"};
    Counter draws_retired{*this, "draws_retired", "draw", "Draws retired by every partition"};
    Counter passes{*this, "passes", "pass", "Passes begun"};
  };

  CommandProcessor(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
                   QuietLog& quiet);

  FifoInGroup<RetireToken> retire_in;
  FifoIn<ReleaseToken> scan_done_in{*this, "scan_done_in", LinkRole::kReply};
  std::vector<std::unique_ptr<FifoOut<DrawToken>>> draw_out;
  FifoOut<ScanToken> scan_out{*this, "scan_out"};

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const Stats* stats() const override { return &stats_; }
  void audit(Audit& audit) const override;
  [[nodiscard]] std::vector<Facet> row() const override;
  [[nodiscard]] std::string state_text() const override;
  /// All passes done and the last image read.
  [[nodiscard]] bool finished() const { return step_ == Step::kDone; }
  /// Tick at which the last pass was flushed, and at which the last image was read.
  [[nodiscard]] Tick render_end() const { return render_end_; }
  [[nodiscard]] Tick end() const { return end_; }
  /// By draw: tick at which it was issued, and at which every partition had retired it, or the command
  /// processor was done with it.
  [[nodiscard]] const std::vector<Tick>& issued_at() const { return issued_at_; }
  [[nodiscard]] const std::vector<Tick>& retired_at() const { return retired_at_; }

 private:
  enum class Step : std::uint8_t {
    kPassBegin,
    kDraw,
    kDrawEnd,
    kPassEnd,
    kWaitFlush,
    kScan,
    kWaitScan,
    kDone
  };
  [[nodiscard]] Wake issue_wake() const;
  /// When every front end can take a token.
  [[nodiscard]] Wake draw_wake() const;
  void send(Tick now, const DrawToken& token);
  /// The next draw is dropped.
  [[nodiscard]] bool culls() const { return params_.cull_draws && frame_.draw(DrawId(draw_)).outside_view; }
  /// The next draw is sent, and as many are under way as may be.
  [[nodiscard]] bool all_in_flight() const {
    return sent_.size() - retired_ >= static_cast<std::size_t>(params_.draws_in_flight.value()) && !culls();
  }
  [[nodiscard]] Wake retire_wake() const;
  void take_retirements(Tick now);
  void issue(Tick now);
  void cull(Tick now);
  /// Goes on to the next draw of the pass, or to its end.
  void next_draw(const PassState& pass);

  const Params& params_;
  const Frame& frame_;
  QuietLog& quiet_log_;
  Stats stats_;
  Step step_ = Step::kPassBegin;
  std::uint32_t pass_ = 0, draw_ = 0;
  Tick free_ = 0;
  Tick quiet_since_ = 0, render_end_ = 0, end_ = 0;
  std::vector<std::uint32_t> retired_by_;  ///< draws retired, by partition
  std::vector<std::uint32_t> sent_;        ///< draws that were sent, in order
  std::uint32_t retired_ = 0;              ///< of them, retired everywhere
  std::vector<Tick> issued_at_, retired_at_;
  int flushes_ = 0;
};

}  // namespace quadrille::hw
