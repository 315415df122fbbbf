/// ROP of one screen partition: retires fragment warps in order, has late ones tested, blends, and writes
/// colours through its cache.
///
/// In    order_in     what retires next: warps and boundaries
///       done_in[c]   core c has shaded a warp
///       late_in      a warp was tested late; depth is flushed
/// Out   late_out     test this warp; flush
///       release_out  a warp slot is free
///       sync_out     triangles before a sequence number are retired
///       retire_out   draw retired; pass flushed
///       load_out     a core has done a warp
/// Mem   colour tiles
/// Time  `quads_per_clk` quads of one sample a cycle and colour attachment (half of that where blending reads
///       the old colour; half of it again for pixels of 8 bytes, a quarter for 16; less where blending
///       floats takes more turns than that); up to `warps_in_flight`
///       warps wait for their lines. Of order-independent draws a quad of one sample takes eight turns a
///       layer of a k-buffer, and a quad eight turns in all of an A-buffer: two each to read and write its
///       heads, four for its nodes. At the end of a pass it puts those over the colours (hw/rop/compose.h),
///       and resolves several samples a pixel (hw/rop/resolve.h).
#pragma once

#include "hw/base/fifo_group.h"
#include "hw/base/param.h"
#include "hw/base/waiting_queue.h"
#include "hw/frame/stores.h"
#include "hw/frame/unit_context.h"
#include "hw/memory/flush.h"
#include "hw/rop/compose.h"
#include "hw/rop/resolve.h"
#include "hw/rop/surface_cache.h"
#include "hw/rop/transparency_buffer.h"

namespace quadrille::hw {

class Rop final : public Unit {
 public:
  struct Params : ParamGroup {
    Param<int> quads_per_clk{*this,   "quads_per_clk",
                             4,       "quad/clk",
                             {1, 16}, "Quads of one sample written a cycle. [G: as the fine rasteriser]"};
    Param<int> warps_in_flight{*this,     "warps_in_flight",
                               16,        "warp",
                               {1, 4096}, "Warps waiting for their colours. [G: latency to hide]"};
    Param<int> cache_lines{
        *this,  "cache_lines", 256,
        "line", {1, 1 << 20},  "Lines of 128 bytes in the colour cache; two hold a tile. [G: 32 KiB]"};
    Param<int> cache_ways{
        *this, "cache_ways", 8, "way", {1, 64}, "Associativity of the colour cache. [G]", Effect::kTradeOff};
    Param<int> cache_misses{*this, "cache_misses", 32, "line", {1, 4096}, "Lines under way. [G]"};
    Param<int> half_blend_turns{
        *this,
        "half_blend_turns",
        1,
        "turn",
        {1, 64},
        "Turns in which a quad of floats of 16 bits or fewer is blended, however many channels it has; its "
        "path to the cache takes at least two. [G: no slower than the path]",
        Effect::kSlower};
    Param<int> float_blend_turns{
        *this,
        "float_blend_turns",
        1,
        "turn",
        {1, 64},
        "The same: floats of 32 bits, for each channel. [G: no slower than the path]",
        Effect::kSlower};
    Choice<ColorCompression> compression{
        *this,
        "compression",
        ColorCompression::kNone,
        {"none", "offset", "samples_offset"},
        "How lines of colours are stored: as they are, or as offsets from their least codes where that takes "
        "fewer sectors, and lines of later samples that equal those of the first not at all."};
  };
  struct Stats : StatGroup {
    Counter warps{*this, "warps", "warp", "Warps retired"};
    Counter fragments_in{*this, "fragments_in", "fragment",
                         "Live fragments of those warps when they were packed"};
    Counter discarded{*this, "discarded", "fragment", "Fragments that their program discarded"};
    Counter late_discarded{*this, "late_discarded", "fragment",
                           "Fragments of those that would have been tested late"};
    Counter late_killed{*this, "late_killed", "fragment", "Fragments that failed the late depth test"};
    Counter written{*this, "written", "fragment", "Fragments written to the attachments"};
    Counter pixels_written{
        *this, "pixels_written", "pixel",
        "Pixels of colour attachments written: one for each attachment that the fragment's "
        "program has an output for, and of several samples for each of them"};
    Counter blended{*this, "blended", "pixel", "Pixels of those that were combined with the old colour"};
    Counter draws{*this, "draws", "draw", "Draws retired"};
    Counter resolved{*this, "resolved_tiles", "tile",
                     "Tiles of colour attachments resolved from their samples"};
    Counter resolved_clear{*this, "resolved_clear", "tile",
                           "Tiles of those that nothing was drawn to, which move nothing"};
    Counter samples_discarded{
        *this, "samples_discarded", "sample",
        "Samples whose fragments were discarded, or that a mask of samples or alpha to coverage took away; "
        "here and below, where a pixel has one sample, fragments"};
    Counter samples_written{*this, "samples_written", "sample", "Samples of the fragments written"};
    Counter bytes_in{*this, "bytes_in", "B",
                     "Colours that came with the warps, as their attachments store them"};
  };
  using CounterParts = Parts<MemoryPortStats, L1CacheStats, SurfaceCacheStats, EncodedReadStats,
                             SurfaceEncoderStats, TransparencyStats>;
  Rop(sc_core::sc_module_name name, const UnitContext& context, const Params& params, WarpStore& warps);

  FifoIn<OrderToken> order_in{*this, "order_in"};
  FifoInGroup<FragmentDoneToken> done_in;
  /// `slot` is the core that has done a warp
  FifoOut<ReleaseToken> load_out{*this, "load_out", LinkRole::kReply};
  FifoIn<LateToken> late_in{*this, "late_in", LinkRole::kReply};
  FifoOut<LateToken> late_out{*this, "late_out", LinkRole::kReply};
  FifoOut<WarpReleaseToken> release_out{*this, "release_out", LinkRole::kReply};
  FifoOut<ReleaseToken> sync_out{*this, "sync_out", LinkRole::kReply};
  FifoOut<RetireToken> retire_out{*this, "retire_out", LinkRole::kReply};

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const Stats* stats() const override { return &stats_; }
  void audit(Audit& audit) const override;
  void details(Details& details) const override;
  [[nodiscard]] std::vector<Facet> row() const override;
  [[nodiscard]] std::string state_text() const override;
  [[nodiscard]] MemoryPort& memory_port() { return port_; }
  static constexpr MemoryClient kMemoryClient = MemoryClient::kColor;

 private:
  /// Stages of an entry of the reorder buffer, in order.
  enum class Stage : std::uint8_t { kShading, kTesting, kTested, kAcquired };
  struct Entry {
    OrderToken token;
    Stage stage = Stage::kShading;
    int missing = 0;
    Tick ready = 0;
    int shaded = 0;                       ///< live lanes after discard
    std::uint64_t discarded_samples = 0;  ///< discarded with their lanes, or taken from live ones
    int parts = 0;                        ///< touched tiles, of each attachment, that are acquired
    AcquiredLines done{};                 ///< of `SurfaceCache::acquire`, of the next one
  };

  [[nodiscard]] Wake test_wake() const;
  [[nodiscard]] Wake acquire_wake() const;
  [[nodiscard]] Wake retire_wake() const;
  [[nodiscard]] Wake end_wake(Tick at) const;
  [[nodiscard]] Wake outputs_of(const Entry& entry, Wake wake) const;
  void take_inputs(Tick now);
  void take_late(Tick now);
  void end_pass();
  void begin_resolve();
  void begin_flush();
  void compose(Tick now);
  void resolve(Tick now);
  void test(Tick now);
  void acquire(Tick now);
  bool acquire_colors(Entry& entry, std::uint32_t number);
  void retire(Tick now);
  void retire_boundary(Tick now, const Entry& entry);
  bool claim_colors(const WarpSlot& warp);
  /// Returns the cycles that it takes.
  int write_colors(const WarpSlot& warp);
  int write_quads(const WarpSlot& warp);
  void write_samples(const DrawState& draw, const WarpSlot& warp, const QuadOfWarp& part);
  /// Turns that a quad takes at an attachment.
  [[nodiscard]] int quad_turns(const DrawState& draw, std::size_t color) const;

  const Params& params_;
  const Frame& frame_;
  models::DeviceMemory& device_;
  WarpStore& warps_;
  const PartitionId partition_;
  const std::uint32_t partitions_;
  Stats stats_;
  MemoryPort port_;
  SurfaceCache cache_;
  PassId pass_;
  WaitingQueue<Entry> entries_;
  /// entries from the front that are past these stages (tested: test sent or not needed)
  std::size_t tested_ = 0, acquired_ = 0;
  std::size_t awaiting_ = 0;  ///< entries from the front whose late answer is in or not needed
  std::vector<bool> shaded_;  ///< by warp slot
  /// no place for the colours of the next entry; a fill will make one
  bool stalled_ = false;
  bool claim_stalled_ = false;  ///< the same for the head, whose lines were evicted
  bool depth_flushes_ = false;  ///< the pass is over, and the depth unit flushes before this one
  bool depth_flushed_ = false;  ///< it has; the lines that nobody waits for come before this one flushes
  TransparencyBuffer transparency_;
  Compose compose_;
  Resolve resolve_;
  Flush flush_{port_};
  Tick free_ = 0, test_free_ = 0, acquire_free_ = 0;
};

}  // namespace quadrille::hw
