/// Primitive assembly: waits for a batch to be shaded and hands its primitives on in draw order.
///
/// In    batch_in       batches and boundaries, in order
///       done_in[c]     core c has shaded a batch
/// Out   load_out       a core has done a batch (`slot` is the core)
///       primitive_out  primitives as lanes of their batch, then a batch end; draw and pass boundaries
/// Time  `triangles_per_clk` primitives a cycle; a boundary takes the place of one
#pragma once

#include "hw/base/fifo_group.h"
#include "hw/base/param.h"
#include "hw/base/work_rate.h"
#include "hw/frame/stores.h"
#include "hw/frame/tokens.h"
#include "hw/frame/unit_context.h"

namespace quadrille::hw {

class PrimitiveAssembly final : public Unit {
 public:
  struct Params : ParamGroup {
    Param<int> triangles_per_clk{*this,
                                 "triangles_per_clk",
                                 1,
                                 "triangle/clk",
                                 {1, 64},
                                 "Triangles handed on a cycle; more than link.assembly_to_clipper.width has "
                                 "no effect. [G: one geometry engine]"};
  };
  struct Stats : StatGroup {
    Counter batches{*this, "batches", "batch", "Shaded batches taken apart"};
    Counter vertices{*this, "vertices", "vertex", "Shaded vertices in those batches"};
    Counter triangles{*this, "triangles", "triangle", "Triangles handed to the clipper"};
  };
  PrimitiveAssembly(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
                    const Store<BatchSlot>& batches);

  FifoIn<BatchToken> batch_in{*this, "batch_in"};
  FifoInGroup<VertexDoneToken> done_in;
  FifoOut<PrimitiveToken> primitive_out{*this, "primitive_out"};
  FifoOut<ReleaseToken> load_out{*this, "load_out", LinkRole::kReply};

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const Stats* stats() const override { return &stats_; }
  void audit(Audit& audit) const override;
  void details(Details& details) const override;
  [[nodiscard]] std::vector<Facet> row() const override;
  [[nodiscard]] std::string state_text() const override;

 private:
  [[nodiscard]] Wake emit_wake() const;
  void emit(Tick now);

  const Params& params_;
  const Store<BatchSlot>& batches_;
  Stats stats_;
  std::vector<bool> shaded_;       ///< by batch slot
  std::size_t next_triangle_ = 0;  ///< of the batch at the head
  WorkRate rate_;
  Tick free_ = 0;
};

}  // namespace quadrille::hw
