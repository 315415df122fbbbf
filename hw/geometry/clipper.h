/// Clipper: rejects triangles outside the view volume, cuts those that cross its near, far or guard-band
/// planes, and applies the viewport transform.
///
/// In    primitive_in  triangles as lanes of a shaded batch; boundaries
/// Out   clipped_out[e] triangles and pieces with window positions, to each raster engine whose part of the
/// screen they touch; boundaries, to all
/// Time  `triangles_per_clk` triangles a cycle; a cut one `clip_clk` cycles, and then its pieces as many a
/// cycle; a boundary takes the place of a triangle
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
    Param<int> triangles_per_clk{*this,
                                 "triangles_per_clk",
                                 1,
                                 "triangle/clk",
                                 {1, 64},
                                 "Triangles judged, or pieces handed on, a cycle; for more than one handed "
                                 "on link.clipper_to_setup.width must be as "
                                 "much. [G: one geometry engine]"};
    Param<int> clip_clk{*this,
                        "clip_clk",
                        12,
                        "clk/triangle",
                        {1, 4096},
                        "Cycles to cut a triangle by the planes it crosses. [G: a few cycles a plane]",
                        Effect::kSlower};
  };
  struct Stats : StatGroup {
    Counter triangles{*this, "triangles", "triangle", "Triangles taken in"};
    Counter passed{*this, "passed", "triangle", "Triangles wholly inside, passed on"};
    Counter clipped{*this, "clipped", "triangle", "Triangles cut"};
    Counter rejected{*this, "rejected", "triangle", "Triangles of which nothing is left"};
    Counter not_finite{*this, "not_finite", "triangle",
                       "Triangles dropped because a position is NaN or infinite"};
    Counter pieces{*this, "pieces", "triangle", "Triangles that cutting produced and passed on"};
    Counter copies{
        *this, "copies", "triangle",
        "Triangles and pieces sent to further raster engines, beyond the first: one for each whose "
        "part of the screen they touch too"};
  };
  Clipper(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
          const Store<BatchSlot>& batches, std::vector<Store<ClippedPiece>*> pieces);

  FifoIn<PrimitiveToken> primitive_in{*this, "primitive_in"};
  std::vector<std::unique_ptr<FifoOut<ClippedToken>>> clipped_out;  ///< by raster engine

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const Stats* stats() const override { return &stats_; }
  void audit(Audit& audit) const override;
  void details(Details& details) const override;
  [[nodiscard]] std::vector<Facet> row() const override;

 private:
  void emit_piece(Tick now, int i);
  /// Those that a piece goes to, a bit each.
  [[nodiscard]] std::uint32_t engines_of(const PrimitiveToken& token, const ClippedPiece& piece);
  void send(Tick now, const PrimitiveToken& token, const ClippedPiece& piece);
  void take_triangle(Tick now);
  void spend(Tick now, std::int64_t cost);

  const Params& params_;
  const Frame& frame_;
  const Store<BatchSlot>& batches_;
  std::vector<Store<ClippedPiece>*> pieces_;  ///< by engine, rings: more slots than the output link can hold
  std::vector<std::uint32_t> ring_;           ///< by engine: the next slot
  const models::ScreenShare screen_;
  Stats stats_;
  models::ClippedPolygon polygon_;
  int next_piece_ = 0;      ///< of the polygon being emitted; 0: none
  std::uint32_t turn_ = 0;  ///< of the engines, for what touches no tile
  WorkRate rate_;
  Tick free_ = 0;
};

}  // namespace quadrille::hw
