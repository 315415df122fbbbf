/// Depth unit of one screen partition: owns the partition's depth tiles and their cache, and tests fragments
/// before (early) or after (late) shading.
///
/// In    coverage_in   covered samples of a primitive in a tile; boundaries
///       late_in       shaded warps to test, in order; flush
/// Out   coverage_out  what survives, marked early (tested and written) or late
///       late_out      tested warps; flushed
///       hiz_out       a tile's greatest depth fell
/// Mem   depth tiles; a frame without depth tests needs no links to memory
/// Time  `quads_per_clk` quads of one sample a cycle through either port, one port a cycle, the late one
///       first; waits for the tile's lines
///
/// Stencil values are tested with the depths. Early test-and-write needs a program that does not discard,
/// write depth or take away samples, and no older late fragment of the tile. Else the tile goes late, thinned
/// early where a fragment that fails now fails at its turn too: all writes of the pass lower depths, and
/// "less" is the only test. Late tests come in API order, so every pixel sees its tests and writes in that
/// order.
#pragma once

#include "hw/base/param.h"
#include "hw/base/waiting_queue.h"
#include "hw/frame/stores.h"
#include "hw/frame/unit_context.h"
#include "hw/memory/flush.h"
#include "hw/rop/surface_cache.h"

namespace quadrille::hw {

class DepthUnit final : public Unit {
 public:
  struct Params : ParamGroup {
    Param<int> quads_per_clk{*this,   "quads_per_clk",
                             4,       "quad/clk",
                             {1, 16}, "Quads of one sample tested a cycle. [G: as the fine rasteriser]"};
    Param<int> tiles_in_flight{*this,     "tiles_in_flight",
                               16,        "tile",
                               {1, 4096}, "Tiles waiting for their depths. [G: latency to hide]"};
    Param<int> cache_lines{
        *this,  "cache_lines", 256,
        "line", {1, 1 << 20},  "Lines of 128 bytes in the depth cache; two hold a tile. [G: 32 KiB]"};
    Param<int> cache_ways{
        *this, "cache_ways", 8, "way", {1, 64}, "Associativity of the depth cache. [G]", Effect::kTradeOff};
    Param<int> cache_misses{*this, "cache_misses", 32, "line", {1, 4096}, "Lines under way. [G]"};
    Choice<DepthCompression> compression{
        *this,
        "compression",
        DepthCompression::kNone,
        {"none", "offset", "plane_offset"},
        "How lines of depths are stored: as they are, or as offsets from their least codes where that takes "
        "fewer sectors, or from a plane too. [P: Hasselgren 2006]"};
  };
  struct Stats : StatGroup {
    Counter tiles{*this, "tiles", "tile", "Tiles taken in by the early port, once for each covered sample"};
    Counter fragments_in{
        *this, "fragments_in", "fragment",
        "Fragments taken in by the early port; here and below, of several samples a pixel, samples"};
    Counter early_tested{
        *this, "early_tested", "fragment",
        "Fragments whose depth test was settled before shading: killed, or passed and written"};
    Counter early_killed{
        *this, "early_killed", "fragment",
        "Fragments of those that were killed, also of tiles whose survivors are tested late"};
    Counter fragments_out{*this, "fragments_out", "fragment", "Fragments handed to the warp packer"};
    Counter untested{*this, "untested", "fragment", "Fragments of draws without depth test, passed on"};
    Counter deferred{
        *this, "deferred", "fragment",
        "Fragments handed on to be tested late. What is taken in is tested early, deferred or untested"};
    Counter late_tested{*this, "late_tested", "fragment", "Fragments tested after shading"};
    Counter late_killed{*this, "late_killed", "fragment",
                        "Pixels of which all samples were killed after shading"};
    Counter hiz_sent{*this, "hiz_sent", "update", "Hi-Z updates sent"};
    Counter hiz_dropped{*this, "hiz_dropped", "update", "Hi-Z updates dropped because their link was full"};
    Counter stencil_written{*this, "stencil_written", "fragment",
                            "Fragments that an operation other than keep was done for"};
    Counter late_killed_samples{*this, "late_killed_samples", "sample",
                                "Samples killed after shading, which are the same where a pixel has one"};
    Counter tiles_unread{*this, "tiles_unread", "tile",
                         "Tiles of those that are in front of all that is there, whose depths are not read"};
  };
  using CounterParts =
      Parts<MemoryPortStats, L1CacheStats, SurfaceCacheStats, EncodedReadStats, SurfaceEncoderStats>;
  DepthUnit(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
            const TriangleStore& triangles, WarpStore& warps);

  FifoIn<CoverageToken> coverage_in{*this, "coverage_in"};
  FifoIn<LateToken> late_in{*this, "late_in", LinkRole::kReply};
  FifoOut<CoverageToken> coverage_out{*this, "coverage_out"};
  FifoOut<LateToken> late_out{*this, "late_out", LinkRole::kReply};
  FifoOut<HiZToken> hiz_out{*this, "hiz_out", LinkRole::kReply};

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const Stats* stats() const override { return &stats_; }
  void audit(Audit& audit) const override;
  void details(Details& details) const override;
  [[nodiscard]] std::vector<Facet> row() const override;
  [[nodiscard]] std::string state_text() const override;
  [[nodiscard]] MemoryPort& memory_port() { return port_; }
  static constexpr MemoryClient kMemoryClient = MemoryClient::kDepth;

 private:
  /// Marks, in the number by which the cache knows who waits, an entry of the late port.
  static constexpr std::uint32_t kLateBit = 0x80000000u;
  struct EarlyEntry {
    CoverageToken token;
    int missing = 0;
    Tick ready = 0;
    bool acquired = false;
    AcquiredLines done{};  ///< of `SurfaceCache::acquire`
  };
  struct LateEntry {
    LateToken token;
    int missing = 0;
    Tick ready = 0;
    bool acquired = false;
    int parts = 0;         ///< quads, of each sample, whose tiles are acquired
    AcquiredLines done{};  ///< of `SurfaceCache::acquire`, of the next one
  };

  // Early port.
  [[nodiscard]] Wake early_take_wake() const;
  [[nodiscard]] Wake early_test_wake() const;
  void take_early(Tick now);
  void test_early(Tick now);
  [[nodiscard]] bool hands_on(const CoverageToken& token);
  [[nodiscard]] bool early_ready(Tick now) const;
  [[nodiscard]] bool late_ready(Tick now) const;
  /// Thins the token's coverage and decides whether it goes late. False, with nothing changed, when the cache
  /// has no place for what it would write.
  [[nodiscard]] bool test_tile(const DrawState& draw, CoverageToken& token, Tick now);
  // Late port.
  [[nodiscard]] Wake late_take_wake() const;
  [[nodiscard]] Wake late_test_wake() const;
  void take_late(Tick now);
  bool test_late(Tick now);
  models::LaneMask test_quad(const DrawState& draw, WarpSlot& warp, int quad, Tick now);
  /// Calls `visit(quad, lanes, sample)` for the live samples of a warp until it answers false, which is then
  /// the answer.
  template <class Visit>
  bool visit_samples(const WarpSlot& warp, const Visit& visit) const {
    const int samples = frame_.draw(warp.draw).samples().count;
    for (int q = 0; q < warp.quads; ++q) {
      for (int s = 0; s < samples; ++s) {
        const models::LaneMask lanes = warp.lanes_of(q, samples, s);
        if (lanes != 0 && !visit(warp.quad[static_cast<std::size_t>(q)], lanes, s)) return false;
      }
    }
    return true;
  }
  // Both.
  void acquire_waiting(Tick now);
  [[nodiscard]] SectorWishes early_wishes(const CoverageToken& token) const;
  bool acquire_early(EarlyEntry& entry, std::uint32_t number);
  bool acquire_late(LateEntry& entry, std::uint32_t number);
  void take_answers(Tick now);
  [[nodiscard]] Wake flush_wake() const;
  [[nodiscard]] bool waits_for_late(const CoverageToken& token) const;
  void begin_pass(PassId pass);
  void send_hiz(Tick now, std::uint32_t tile_x, std::uint32_t tile_y);
  [[nodiscard]] models::DepthPlane plane(std::uint32_t tile_x, std::uint32_t tile_y, std::uint32_t sample);
  /// Of all its samples.
  [[nodiscard]] float greatest_depth(std::uint32_t tile_x, std::uint32_t tile_y);
  [[nodiscard]] std::size_t tile_number(std::uint32_t tile_x, std::uint32_t tile_y) const;

  const Params& params_;
  const Frame& frame_;
  models::DeviceMemory& device_;
  const TriangleStore& triangles_;
  WarpStore& warps_;
  const PartitionId partition_;
  const std::uint32_t partitions_;
  Stats stats_;
  MemoryPort port_;
  SurfaceCache cache_;
  PassId pass_;
  WaitingQueue<EarlyEntry> early_;
  WaitingQueue<LateEntry> late_;
  bool stalled_ = false;                       ///< the cache had no place; a fill will make one
  bool lowering_ = true;                       ///< no draw of the pass so far can raise a depth
  std::vector<std::uint32_t> late_in_flight_;  ///< quads by tile
  bool some_wait_for_late_ = false;            ///< draws of the frame: `waits_for_late`
  bool tile_late_ = false;                     ///< of the tile whose samples come now: it goes late
  bool tile_passed_on_ = false;                ///< a sample of it was
  std::vector<float> known_max_;               ///< by tile: what Hi-Z was told
  Flush flush_{port_};
  Tick free_ = 0, take_free_ = 0;
};

}  // namespace quadrille::hw
