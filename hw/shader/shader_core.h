/// Unified shader core: runs vertex and fragment warps of 32 lanes, a clause at a time, on several SIMD
/// units.
///
/// In    vertex_in, fragment_in    warps to run
///       texture_in, storage_in    the requests of a warp have been answered
/// Out   vertex_out[f]             batch of geometry front end f shaded
///       fragment_out[p]           fragment warp shaded
///       texture_out, storage_out  a clause's texture and storage requests
/// Time  an instruction holds its SIMD for 32 / simd_lanes cycles (32 / sfu_lanes for special functions), and
///       one that reads its result waits for the latency of its class (models/shader/timing.h); other warps
///       of the SIMD issue meanwhile, as `scheduler` says (hw/shader/simd.h). A warp stays on the SIMD that
///       it was given, the one with the fewest warps. It needs a slot and its registers; a slot and registers
///       for one fragment warp are never given to vertex warps.
///       Colours leave for the ROPs at `export_bytes_per_clk`, a warp after the other.
/// Not modelled: instruction and constant caches (docs/deviations.md#D4), register bank conflicts (#D5)
#pragma once

#include "hw/base/leg_log.h"
#include "hw/base/param.h"
#include "hw/base/queue.h"
#include "hw/base/unit.h"
#include "hw/frame/tokens.h"
#include "hw/frame/unit_context.h"
#include "hw/shader/core_slots.h"
#include "hw/shader/simd.h"
#include "models/shader/timing.h"

#include <unordered_map>

namespace quadrille::hw {

class ShaderCore final : public Unit {
 public:
  struct Params : ParamGroup {
    Param<int> simds{*this,   "simds",
                     4,       "simd",
                     {1, 64}, "SIMD units, each issuing one instruction at a time. [G: 4 schedulers a core]"};
    Param<int> simd_lanes{
        *this,   "simd_lanes",
        8,       "lane",
        {1, 32}, "Lanes a SIMD computes a cycle; a warp instruction takes 32 / lanes cycles. [G]"};
    Param<int> sfu_lanes{*this,  "sfu_lanes", 2,
                         "lane", {1, 32},     "Special-function lanes of a SIMD. [G: a quarter of the ALU]"};
    Param<int> alu_clk{*this,
                       "alu_clk",
                       8,
                       "clk",
                       {0, 1 << 16},
                       "From an arithmetic instruction to one that reads its result. [G: four cycles to go "
                       "in, four through the pipe]",
                       Effect::kSlower};
    Param<int> sfu_clk{*this,
                       "sfu_clk",
                       20,
                       "clk",
                       {0, 1 << 16},
                       "The same: special functions. [G: sixteen cycles to go in, four through]",
                       Effect::kSlower};
    Param<int> interp_clk{
        *this,          "interp_clk", 12,
        "clk",          {0, 1 << 16}, "The same: interpolated varyings. [G: planes are read first]",
        Effect::kSlower};
    Param<int> const_clk{*this,
                         "const_clk",
                         12,
                         "clk",
                         {0, 1 << 16},
                         "The same: constants that a register indexes. [G: as an address and a read]",
                         Effect::kSlower};
    Param<int> branch_clk{*this,
                          "branch_clk",
                          4,
                          "clk",
                          {0, 1 << 16},
                          "From control flow to the warp's next instruction. [G: the front end is refilled]",
                          Effect::kSlower};
    PolicyParam<SimdSharingPolicy> scheduler{*this, "scheduler", simd_sharing_policies(), kRoundRobinSharing,
                                             "Which warp of a SIMD issues when several could: the longest "
                                             "ready, or all in turn. [G: within 1 % of each "
                                             "other on our scenes at 640x360]"};
    Param<int> warp_slots{*this, "warp_slots", 32, "warp", {2, 1024}, "Warps resident on the core. [G]"};
    Param<int> export_bytes_per_clk{
        *this,
        "export_bytes_per_clk",
        128,
        "B/clk",
        {1, 1 << 16},
        "Bytes of colours, as their attachments store them, that leave the core a cycle. [G: a warp of "
        "4-byte pixels]"};
    Param<int> register_rows{*this, "register_rows", 1024,
                             "row", {16, 1 << 20},   "Register rows of 32 words: 1024 are 128 KiB. [G]"};
  };
  struct Stats : StatGroup {
    Counter vertex_warps{*this, "vertex_warps", "warp", "Vertex warps run"};
    Counter fragment_warps{*this, "fragment_warps", "warp", "Fragment warps run"};
    Counter vertices{*this, "vertices", "vertex", "Vertices shaded (live lanes)"};
    Counter fragments{*this, "fragments", "fragment", "Fragments shaded (live lanes)"};
    Counter helper_lanes{*this, "helper_lanes", "lane", "Lanes that ran only for derivatives"};
    Counter clauses{*this, "clauses", "clause", "Clauses issued"};
    Counter instructions{*this, "instructions", "instruction", "Warp instructions issued"};
    Counter alu{*this, "alu_instructions", "instruction",
                "Warp instructions of the ALU, interpolation, constant and export classes"};
    Counter sfu{*this, "sfu_instructions", "instruction", "Warp instructions of the special-function class"};
    Counter texture{*this, "texture_instructions", "instruction", "Texture requests sent"};
    Counter storage{*this, "storage_instructions", "instruction", "Storage requests sent"};
    Counter lane_operations{*this, "lane_operations", "lane", "Lanes executed, summed over instructions"};
    Counter simd_busy{*this, "simd_busy", "clk", "Cycles in which SIMD units issued, summed over the units"};
    Counter exported_bytes{*this, "exported_bytes", "B",
                           "Colours that left the core for the ROPs, as their attachments store them"};
    Counter operand_waits{
        *this, "operand_waits", "clk",
        "Cycles in which a clause, alone on its SIMD, would wait for its own results, summed over clauses"};
  };
  /// Where the core finds its warps, and their batches and triangles.
  struct Stores {
    Store<CoreSlot>& slots;  ///< the core's own
    Store<BatchSlot>& batches;
    std::vector<WarpStore*> warps;                ///< by partition
    std::vector<const TriangleStore*> triangles;  ///< by raster engine
  };
  /// Cycles of the core's instructions by class. A class without results that others read has the latency of
  /// its issue.
  [[nodiscard]] static models::IssueTiming issue_timing(const Params& params);
  /// Units of its own that a core has in this machine.
  struct Neighbours {
    bool texture = false, load_store = false;
  };
  ShaderCore(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
             const Stores& stores, const Neighbours& neighbours);

  static constexpr int kVertexStream = 1, kFragmentStream = 2;
  FifoIn<VertexWarpToken> vertex_in{*this, "vertex_in", LinkRole::kFlow, kVertexStream};
  FifoIn<FragmentWarpToken> fragment_in{*this, "fragment_in", LinkRole::kFlow, kFragmentStream};
  std::vector<std::unique_ptr<FifoOut<VertexDoneToken>>> vertex_out;
  std::vector<std::unique_ptr<FifoOut<FragmentDoneToken>>> fragment_out;
  /// absent when no program of the frame reads a texture
  std::unique_ptr<FifoOut<TextureToken>> texture_out;
  std::unique_ptr<FifoIn<TextureToken>> texture_in;
  /// absent when no program of the frame has a storage buffer
  std::unique_ptr<FifoOut<StorageToken>> storage_out;
  std::unique_ptr<FifoIn<StorageToken>> storage_in;

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const Stats* stats() const override { return &stats_; }
  void audit(Audit& audit) const override;
  void details(Details& details) const override;
  [[nodiscard]] std::vector<Facet> row() const override;
  [[nodiscard]] std::string state_text() const override;

 private:
  /// A clause whose results are there at `at`; then its warp makes its requests or is done.
  struct Completion {
    Tick at = 0;
    std::uint32_t slot = 0;
    models::ClauseEnd end = models::ClauseEnd::kProgramEnd;
  };
  struct Ready {
    Tick at = 0;
    std::uint32_t slot = 0;
  };
  [[nodiscard]] bool fits(const models::Program& program, int kept_rows, int kept_slots) const;
  /// Does a warp wait for a slot, or else for registers?
  [[nodiscard]] bool kept_out(bool by_slots) const;
  /// Is there room for the vertex warp, or the fragment warp, at the head of its input?
  [[nodiscard]] bool vertex_fits() const;
  [[nodiscard]] bool fragment_fits() const;
  [[nodiscard]] Wake vertex_wake() const;
  [[nodiscard]] Wake fragment_wake() const;
  [[nodiscard]] Wake issue_wake() const;
  [[nodiscard]] FifoOut<VertexDoneToken>& vertex_out_for(const CoreSlot& slot) const;
  [[nodiscard]] Wake completion_wake(const Completion& done) const;
  [[nodiscard]] const Completion* next_completion(Wake& wake) const;
  void accept_vertex(Tick now);
  void accept_fragment(Tick now);
  /// Takes a free slot for a warp of this draw, and lets it be ready once `launch(slot)` has made it so.
  template <class Launch>
  void accept(const LegLog::Take& take, const Launch& launch);
  void launch_vertex(CoreSlot& slot);
  void launch_fragment(CoreSlot& slot);
  void issue(Tick now);
  [[nodiscard]] Wake simd_wake() const;
  void end_clauses(Tick now);
  void give_simd(CoreSlot& slot);
  [[nodiscard]] const models::ProgramTiming& timing_of(const models::Program& program);
  void complete(Tick now, const Completion& done);
  void retire(Tick now, const Completion& done);
  /// The warp's colours are on their way out until they have passed.
  void export_colors(Tick now, const WarpSlot& work);
  void take_texels(Tick now);
  void take_reply(Tick now, std::uint32_t index, const PortBase& port);
  /// A clause sends its requests, or its warp's results. `exports`: it had to wait for what leaves before it.
  void note_leg(Tick now, const Completion& done, const PortBase& out, bool exports = false) const;

  const Params& params_;
  const Frame& frame_;
  Store<CoreSlot>& slots_;
  Store<BatchSlot>& batches_;
  const std::uint64_t batches_of_front_end_;
  std::vector<WarpStore*> warps_;
  std::vector<const TriangleStore*> triangles_;  ///< by raster engine
  const int fragment_rows_;                      ///< registers of the hungriest fragment program
  Stats stats_;
  std::vector<std::uint32_t> free_slots_;
  int free_rows_;
  models::IssueTiming issue_timing_;
  std::unordered_map<const models::Program*, models::ProgramTiming> timings_;
  models::WarpClock warp_clock_;
  std::vector<Simd> simds_;
  std::vector<int> simd_warps_;  ///< resident, by SIMD
  Queue<Ready> ready_;
  std::vector<Completion> completions_;
  Tick accept_free_ = 0, export_free_ = 0;
};

}  // namespace quadrille::hw
