/// Work distributor: hands vertex batches and fragment warps to the cores that have room, the least loaded first.
///
/// In    vertex_in       batches to shade             fragment_in[p]  warps from the packer of partition p
/// Out   vertex_out[c]   to core c                    fragment_out[c]
/// Time  one vertex and one fragment warp a cycle; partitions take turns
#pragma once

#include "hw/base/fifo_group.h"
#include "hw/base/param.h"
#include "hw/frame/tokens.h"

namespace quadrille::hw {

class WorkDistributor final : public Unit {
 public:
  struct Stats : StatGroup {
    Counter vertex_warps{*this, "vertex_warps", "warp", "Vertex batches handed to cores"};
    Counter fragment_warps{*this, "fragment_warps", "warp", "Fragment warps handed to cores"};
  };
  WorkDistributor(sc_core::sc_module_name name, const Clock& clock, int partitions, int cores);

  static constexpr int kVertexStream = 1, kFragmentStream = 2;
  FifoIn<WarpToken> vertex_in{*this, "vertex_in", LinkRole::kFlow, kVertexStream};
  FifoInGroup<WarpToken> fragment_in;
  std::vector<std::unique_ptr<FifoOut<WarpToken>>> vertex_out;
  std::vector<std::unique_ptr<FifoOut<WarpToken>>> fragment_out;

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const StatGroup* stats() const override { return &stats_; }

 private:
  using Outputs = std::vector<std::unique_ptr<FifoOut<WarpToken>>>;
  [[nodiscard]] static const FifoOut<WarpToken>& first_with_room(const Outputs& outputs);
  [[nodiscard]] Wake vertex_wake() const;
  [[nodiscard]] Wake fragment_wake() const;
  void hand_out(Tick now, FifoIn<WarpToken>& in, Outputs& outputs, std::size_t& turn);

  Stats stats_;
  std::size_t partition_turn_ = 0, vertex_turn_ = 0, fragment_turn_ = 0;
  Tick vertex_free_ = 0, fragment_free_ = 0;
};

}  // namespace quadrille::hw
