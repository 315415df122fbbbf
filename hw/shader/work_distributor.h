/// Work distributor: hands vertex batches and fragment warps to the cores.
///
/// In    vertex_in[f]     batches to shade, from geometry front end f
///       fragment_in[p]   warps from the packer of partition p
///       load_in[p]       a warp of a core is done: from the ROP of partition p; the last ones from the
///                        primitive assemblies
/// Out   vertex_out[c]    to core c
///       fragment_out[c]  to core c
/// Time  one vertex and one fragment warp a cycle; front ends and partitions take turns
///
/// `policy` says who gets a warp: cores in turn; fragments by where they are on the screen; or the core with
/// the fewest warps, sent and not reported done, which is what is known here of its load. A core is skipped
/// while it has no room, but under `tile` its warps wait. Batches have no place on the screen and go by load
/// then.
#pragma once

#include "hw/base/fifo_group.h"
#include "hw/base/param.h"
#include "hw/frame/tokens.h"
#include "hw/frame/unit_context.h"
#include "hw/shader/distribution.h"

namespace quadrille::hw {

class WorkDistributor final : public Unit {
 public:
  struct Params : ParamGroup {
    PolicyParam<DistributionPolicy> policy{*this, "policy", distribution_policies(), kLeastLoadedDistribution,
                                           "Which core gets a warp: the next in turn, the one of its part of "
                                           "the screen, or the one with the fewest. "
                                           "[M: warp policies: fewest cycles]"};
    Param<int> block_tiles{
        *this,
        "block_tiles",
        4,
        "tile",
        {1, 2048},
        "policy=tile: side of the squares of 8x8-pixel tiles whose warps go to one core. [G]",
        Effect::kTradeOff};
  };
  struct Stats : StatGroup {
    Counter vertex_warps{*this, "vertex_warps", "warp", "Vertex batches handed to cores"};
    Counter fragment_warps{*this, "fragment_warps", "warp", "Fragment warps handed to cores"};
  };
  WorkDistributor(sc_core::sc_module_name name, const UnitContext& context, const Params& params);

  static constexpr int kVertexStream = 1, kFragmentStream = 2;
  FifoInGroup<VertexWarpToken> vertex_in;      ///< by geometry front end
  FifoInGroup<FragmentWarpToken> fragment_in;  ///< by partition
  FifoInGroup<ReleaseToken> load_in;           ///< partitions, then front ends; `slot` is the core
  template <class Token>
  using Outputs = std::vector<std::unique_ptr<FifoOut<Token>>>;  ///< by core
  Outputs<VertexWarpToken> vertex_out;
  Outputs<FragmentWarpToken> fragment_out;

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const Stats* stats() const override { return &stats_; }
  void audit(Audit& audit) const override;
  [[nodiscard]] std::vector<Facet> row() const override;
  [[nodiscard]] std::string state_text() const override;

 private:
  template <class Token>
  [[nodiscard]] static const FifoOut<Token>& first_with_room(const Outputs<Token>& outputs);
  [[nodiscard]] Wake vertex_wake() const;
  [[nodiscard]] Wake fragment_wake() const;
  /// The core that gets the next warp of a kind; `kNone` of the policy where none has room.
  template <class Token>
  [[nodiscard]] std::size_t choose(Tick now, const Outputs<Token>& outputs, std::size_t turn) const;
  template <class Token>
  void hand_out(Tick now, FifoIn<Token>& in, Outputs<Token>& outputs, std::size_t core, std::size_t& turn);
  void hand_out_vertices(Tick now);
  void hand_out_fragments(Tick now);

  std::unique_ptr<Distribution> distribution_;
  bool by_place_;
  Stats stats_;
  std::vector<int> loads_;  ///< by core: warps sent and not reported done
  std::size_t front_end_turn_ = 0, partition_turn_ = 0, vertex_turn_ = 0, fragment_turn_ = 0;
  Tick vertex_free_ = 0, fragment_free_ = 0;
};

}  // namespace quadrille::hw
