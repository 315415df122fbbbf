/// Set-up: edge functions, bounds and planes of each triangle, line and point, culling, and the triangle
/// store that bounds how far geometry runs ahead.
///
/// In    clipped_in[f] primitives with window positions from geometry front end f; boundaries
///       sync_in[p]    triangles before a sequence number are retired in partition p
/// Out   triangle_out  kept primitives and boundaries
///       release_out[f] a vertex batch of front end f may be reused
/// Time  `drawn_per_clk` triangles, `lines_per_clk` lines and `points_per_clk` points a cycle that are kept,
///       `culled_per_clk` that are not; a boundary takes the place of a culled one, a cycle at most; waits
///       while the triangle store is full
///
/// Front ends take ranges of a draw in turn, so set-up takes what one sends until its range or the draw ends,
/// and then what the next one sends: primitives keep the order of the draw.
#pragma once

#include "hw/base/fifo_group.h"
#include "hw/base/param.h"
#include "hw/base/work_rate.h"
#include "hw/frame/stores.h"
#include "hw/frame/tokens.h"
#include "hw/frame/unit_context.h"

namespace quadrille::hw {

class TriangleSetupUnit final : public Unit {
 public:
  struct Params : ParamGroup {
    Param<double> drawn_per_clk{*this,
                                "drawn_per_clk",
                                1,
                                "triangle/clk",
                                {0.001, 64},
                                "Triangles set up a cycle that are kept: 0.5 is two cycles each. More than 1 "
                                "needs width on the links from "
                                "link.assembly_to_clipper to link.coarse_to_fine. [G: one triangle a cycle]"};
    Param<double> culled_per_clk{
        *this,
        "culled_per_clk",
        1,
        "triangle/clk",
        {0.001, 64},
        "Triangles a cycle that are culled. More than 1 needs width on link.assembly_to_clipper and "
        "link.clipper_to_setup. [G: one triangle a cycle]"};
    Param<double> lines_per_clk{
        *this,
        "lines_per_clk",
        0.5,
        "line/clk",
        {0.001, 64},
        "Lines set up a cycle that are kept. [G: two cycles each: up to four edges where a "
        "triangle has three, and a reciprocal root]"};
    Param<double> points_per_clk{
        *this,
        "points_per_clk",
        1,
        "point/clk",
        {0.001, 64},
        "Points set up a cycle that are kept. [G: no edges; the place in the triangle "
        "store is written as a triangle's is]"};
    Param<int> triangle_slots{*this,        "triangle_slots",
                              1024,         "triangle",
                              {1, 1 << 20}, "Triangles between set-up and their last retired fragment. [G]"};
  };
  struct Stats : StatGroup {
    Counter triangles{*this, "triangles", "triangle", "Triangles, lines and points taken in"};
    Counter kept{*this, "kept", "triangle", "Those handed to the rasteriser"};
    Counter lines{*this, "lines", "line", "Lines among those handed on"};
    Counter points{*this, "points", "point", "Points among those handed on"};
    Counter culled{*this, "culled", "triangle", "Triangles that face the way that is culled"};
    Counter zero_area{*this, "zero_area", "triangle",
                      "Triangles without area, and lines without length, on the sub-pixel grid"};
    Counter offscreen{*this, "offscreen", "triangle", "Primitives whose pixels are outside the scissor"};
    Counter no_sample{*this, "no_sample", "triangle", "Primitives whose bounds hold no pixel centre"};
  };
  /// What the unit reads, and the ring of triangles that it fills.
  struct Stores {
    const Store<BatchSlot>& batches;
    std::vector<const Store<ClippedPiece>*> pieces;  ///< by front end
    TriangleStore& triangles;
  };
  TriangleSetupUnit(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
                    const Stores& stores);

  FifoInGroup<ClippedToken> clipped_in;
  FifoInGroup<ReleaseToken> sync_in;
  FifoOut<TriangleToken> triangle_out{*this, "triangle_out"};
  std::vector<std::unique_ptr<FifoOut<ReleaseToken>>> release_out;

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const Stats* stats() const override { return &stats_; }
  void audit(Audit& audit) const override;
  void details(Details& details) const override;
  [[nodiscard]] std::vector<Facet> row() const override;
  [[nodiscard]] std::string state_text() const override;

 private:
  [[nodiscard]] Wake work_wake() const;
  void work(Tick now);
  /// Is it kept?
  bool set_up(Tick now, const ClippedToken& token);
  /// Of a primitive of this draw that is kept.
  [[nodiscard]] std::int64_t cost(const DrawState& draw) const;
  void take_syncs(Tick now);

  const Params& params_;
  const Frame& frame_;
  const Store<BatchSlot>& batches_;
  const std::vector<const Store<ClippedPiece>*> pieces_;
  TriangleStore& triangles_;
  Stats stats_;
  std::uint64_t sequence_ = 0;             ///< of the next kept triangle
  std::uint64_t retired_ = 0;              ///< triangles before this are retired everywhere
  std::vector<std::uint64_t> retired_by_;  ///< by partition of the engine
  std::size_t turn_ = 0;                   ///< the front end whose range it is
  WorkRate rate_;
  Tick free_ = 0;
};

}  // namespace quadrille::hw
