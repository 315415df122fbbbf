/// Fragment warp packer: fills warps of 8 quads from the tiles of one draw, whatever triangles and tiles they
/// come from, and reserves their place in the reorder buffer of the partition.
///
/// In    coverage_in  covered samples of a tile after the early depth test; boundaries
///       release_in   a warp has retired
/// Out   warp_out     a warp to shade
///       order_out    what retires next: warps and boundaries, in order
/// Time  `quads_per_clk` quads a cycle, of each sample if a draw is shaded by sample; partial warps leave at
///       a boundary, when another draw's tile arrives, or after `patience_clk` cycles without input
#pragma once

#include "hw/base/param.h"
#include "hw/base/unit.h"
#include "hw/frame/stores.h"
#include "hw/frame/tokens.h"
#include "hw/frame/unit_context.h"

namespace quadrille::hw {

class WarpPacker final : public Unit {
 public:
  struct Params : ParamGroup {
    Param<int> quads_per_clk{
        *this, "quads_per_clk", 4, "quad/clk", {1, 16}, "Quads packed a cycle. [G: as the fine rasteriser]"};
    Param<int> warp_slots{
        *this,      "warp_slots",
        128,        "warp",
        {1, 65536}, "Reorder buffer: fragment warps of a partition from packing to retirement. [G]"};
    Param<int> launch_clk{
        *this,          "launch_clk", 1,
        "clk",          {0, 64},      "Cycles to send a warp off, in which no quad is packed. [G]",
        Effect::kSlower};
    Param<int> patience_clk{*this,
                            "patience_clk",
                            64,
                            "clk",
                            {1, 1 << 20},
                            "Cycles a partial warp waits for more quads. [G: a few tiles' time]",
                            Effect::kTradeOff};
  };
  struct Stats : StatGroup {
    Counter tiles{*this, "tiles", "tile", "Tiles taken in"};
    Counter fragments{*this, "fragments", "fragment", "Live fragments packed"};
    Counter quads{*this, "quads", "quad", "Quads packed"};
    Counter warps{*this, "warps", "warp", "Warps launched"};
    Counter partial_warps{*this, "partial_warps", "warp", "Warps launched with fewer than 8 quads"};
    Counter timeouts{*this, "timeouts", "warp", "Warps launched because no input came"};
    Counter samples{*this, "samples", "sample",
                    "Live samples of those fragments, which are the same where a pixel has one"};
  };
  WarpPacker(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
             WarpStore& warps);

  FifoIn<CoverageToken> coverage_in{*this, "coverage_in"};
  FifoIn<WarpReleaseToken> release_in{*this, "release_in", LinkRole::kReply};
  FifoOut<FragmentWarpToken> warp_out{*this, "warp_out"};
  FifoOut<OrderToken> order_out{*this, "order_out"};

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const Stats* stats() const override { return &stats_; }
  void audit(Audit& audit) const override;
  void details(Details& details) const override;
  [[nodiscard]] std::vector<Facet> row() const override;
  [[nodiscard]] std::string state_text() const override;

 private:
  [[nodiscard]] Wake work_wake() const;
  [[nodiscard]] Wake launch_wake(Tick own) const;
  [[nodiscard]] Wake input_wake() const;
  [[nodiscard]] bool full() const;
  /// The token at the head may not join the open warp.
  [[nodiscard]] bool must_launch_first() const;
  void work(Tick now);
  /// The tile at the head has more tokens, of samples that are packed with this one.
  [[nodiscard]] bool more_samples(Tick now) const;
  /// Takes the pixels of one sample; the quads of all are packed when the last one of the tile is here.
  void take_sample(Tick now);
  void take_quads(Tick now);
  void open_warp(const CoverageToken& token);
  void add_quad(WarpSlot& warp, const CoverageToken& token, int q);
  void take_boundary(Tick now);
  void launch(Tick now);
  /// Of the warp that was opened as this one, counted from 0.
  [[nodiscard]] WarpSlotId slot_of(std::uint64_t warp) const { return WarpSlotId(warp % warps_.size()); }

  const Params& params_;
  const Frame& frame_;
  WarpStore& warps_;
  const PartitionId partition_;
  Stats stats_;
  std::uint64_t opened_ = 0;  ///< warps opened so far; the open one is opened_ - 1
  std::uint64_t retired_ = 0;
  bool open_ = false;       ///< a partial warp is being filled
  std::uint64_t sync_ = 0;  ///< to be reported when the open warp retires
  /// Of the tile that is being taken, by sample: what the tokens before the head cover.
  std::array<std::uint64_t, models::kMaxSamples> planes_{};
  std::uint64_t covered_ = 0;      ///< pixels of which one of these is
  std::uint32_t taken_quads_ = 0;  ///< quads of the tile at the head that are packed already
  Tick last_input_ = 0;
  Tick free_ = 0;
};

}  // namespace quadrille::hw
