/// Clipper: rejects triangles, lines and points outside the view volume, cuts those that cross its near, far
/// or guard-band planes or planes of the user's, and applies the viewport transform. Of a triangle that is
/// not filled it hands the edges or the corners on (polygon mode).
///
/// In    primitive_in    triangles, lines and points as lanes of a shaded batch; boundaries
/// Out   clipped_out[e]  primitives and pieces with window positions, to each raster engine whose part of the
///                       screen they touch; boundaries, to all
/// Time  `triangles_per_clk` primitives a cycle; a cut triangle `clip_clk` cycles and a cut line
///       `line_clip_clk`, and then pieces as many a cycle; a boundary takes the place of a triangle
#pragma once

#include "hw/base/param.h"
#include "hw/base/unit.h"
#include "hw/base/work_rate.h"
#include "hw/frame/stores.h"
#include "hw/frame/tokens.h"
#include "hw/frame/unit_context.h"

#include <memory>
#include <vector>

namespace quadrille::hw {

class Clipper final : public Unit {
 public:
  struct Params : ParamGroup {
    Param<int> triangles_per_clk{
        *this,
        "triangles_per_clk",
        1,
        "triangle/clk",
        {1, 64},
        "Triangles, lines or points judged, or pieces handed on, a cycle; for more than one handed "
        "on link.clipper_to_setup.width must be as "
        "much. [G: one geometry engine]"};
    Param<int> clip_clk{*this,
                        "clip_clk",
                        12,
                        "clk/triangle",
                        {1, 4096},
                        "Cycles to cut a triangle by the planes it crosses. [G: a few cycles a plane]",
                        Effect::kSlower};
    Param<int> line_clip_clk{
        *this,
        "line_clip_clk",
        4,
        "clk/line",
        {1, 4096},
        "Cycles to cut a line at its ends. [G: a third of a triangle's: two ends, and no list "
        "of corners]",
        Effect::kSlower};
  };
  struct Stats : StatGroup {
    Counter triangles{*this, "triangles", "triangle", "Triangles, lines and points taken in"};
    Counter lines{*this, "lines", "line", "Lines among them"};
    Counter points{*this, "points", "point", "Points among them"};
    Counter passed{*this, "passed", "triangle", "Primitives wholly inside, passed on"};
    Counter clipped{*this, "clipped", "triangle", "Primitives cut"};
    Counter outlined{*this, "outlined", "triangle",
                     "Triangles wholly inside of which edges or corners were passed on"};
    Counter culled{*this, "culled", "triangle",
                   "Triangles not to be filled that face the way that is culled, or have no area"};
    Counter rejected{*this, "rejected", "triangle", "Primitives of which nothing is left"};
    Counter not_finite{*this, "not_finite", "triangle",
                       "Primitives dropped because a position is NaN or infinite"};
    Counter pieces{*this, "pieces", "triangle",
                   "What cutting produced, and edges and corners of triangles, passed on"};
    Counter copies{
        *this, "copies", "triangle",
        "Triangles and pieces sent to further raster engines, beyond the first: one for each whose "
        "part of the screen they touch too"};
  };
  Clipper(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
          const Store<BatchSlot>& batches, std::vector<Store<models::ClippedPiece>*> pieces);

  FifoIn<PrimitiveToken> primitive_in{*this, "primitive_in"};
  std::vector<std::unique_ptr<FifoOut<ClippedToken>>> clipped_out;  ///< by raster engine

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const Stats* stats() const override { return &stats_; }
  void audit(Audit& audit) const override;
  void details(Details& details) const override;
  [[nodiscard]] std::vector<Facet> row() const override;

 private:
  void emit_piece(Tick now);
  /// Those that a piece goes to, a bit each.
  [[nodiscard]] std::uint32_t engines_of(const PrimitiveToken& token, const models::ClippedPiece& piece);
  void send(Tick now, const PrimitiveToken& token, const models::ClippedPiece& piece);
  void take_primitive(Tick now);
  /// Positions, point sizes and distances of a primitive's vertices, from their batches.
  void read_vertices(const PrimitiveToken& token, const DrawState& draw);
  [[nodiscard]] std::int64_t cost(const DrawState& draw) const;
  void tally(const DrawState& draw);
  void spend(Tick now, std::int64_t cost);

  const Params& params_;
  const Frame& frame_;
  const Store<BatchSlot>& batches_;
  std::vector<Store<models::ClippedPiece>*>
      pieces_;                       ///< by engine, rings: more slots than the output link can hold
  std::vector<std::uint32_t> ring_;  ///< by engine: the next slot
  const models::ScreenShare screen_;
  Stats stats_;
  models::PrimitiveVertices vertices_;
  models::ClippedPrimitive clipped_;
  int next_piece_ = 0;  ///< of the primitive being emitted
  bool emitting_ = false;
  std::uint32_t turn_ = 0;  ///< of the engines, for what touches no tile
  WorkRate rate_;
  Tick free_ = 0;
};

}  // namespace quadrille::hw
