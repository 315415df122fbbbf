/// Texture unit of one core: level of detail and addresses, a first-level cache that fetches ahead of the
/// filter, and the filter.
///
/// In    request_in    the texture requests of one clause (up to 8 warp instructions)
/// Out   response_out  their texels are filtered, in order
/// Mem   misses of the first-level cache, 128-byte lines in 32-byte sectors
/// Time  addresses: `address_quads_per_clk` quads and level a cycle, `tags_per_clk` distinct lines a cycle;
///       decoder: `decode_blocks_per_clk` blocks of compressed textures a cycle, beside the filter; one of
///       ASTC takes the place of `astc_decode_slots`;
///       filter: `filter_quads_per_clk` bilinear quads a cycle. Requests wait in between for their lines, so
///       a miss delays but does not stop the look-ups behind it. [P: Igehy 1998, prefetching texture cache]
#pragma once

#include "hw/base/param.h"
#include "hw/base/waiting_queue.h"
#include "hw/frame/tokens.h"
#include "hw/frame/unit_context.h"
#include "hw/memory/l1_cache.h"
#include "hw/memory/memory_port.h"
#include "hw/shader/core_slots.h"
#include "hw/texture/texture_use.h"

namespace quadrille::hw {

/// Of what a miss fetches: `texture.fetched_sectors`.
enum class FetchedSectors : std::uint8_t { kOne, kTwo, kLine };

/// What lines of compressed textures the first-level cache holds.
enum class BlocksHeld : std::uint8_t {
  kCompressed,  ///< as they lie in memory; blocks are decoded each time that a request reads them
  kDecoded      ///< decoded when they come, so that a line holds fewer texels and a hit costs no decoding
};

class TextureUnit final : public Unit {
 public:
  struct Params : ParamGroup {
    Param<int> address_quads_per_clk{*this,   "address_quads_per_clk",
                                     2,       "quad/clk",
                                     {1, 64}, "Quads and mip levels addressed a cycle. [G]"};
    Param<int> filter_quads_per_clk{*this,   "filter_quads_per_clk",
                                    2,       "quad/clk",
                                    {1, 64}, "Bilinear quads filtered a cycle. [G: 8 texels x 4 channels]"};
    Param<int> tags_per_clk{*this,      "tags_per_clk", 4,
                            "line/clk", {1, 64},        "Distinct lines looked up a cycle. [G: 4 tag banks]"};
    Param<int> tag_banks{
        *this,
        "tag_banks",
        1,
        "bank",
        {1, 64},
        "Banks of the tags, which share `tags_per_clk` evenly; 2x2 neighbouring lines of tiled "
        "textures lie in four. One bank: any lines go together. [P: Hakura 1997]",
        Effect::kTradeOff};
    Param<int> filter_clk{*this,
                          "filter_clk",
                          8,
                          "clk",
                          {0, 1 << 16},
                          "Latency of the filter, paid after the last line of a group arrived. [G]",
                          Effect::kSlower};
    Param<int> groups_in_flight{
        *this,   "groups_in_flight", 32,
        "group", {1, 4096},          "Clauses' requests between addresses and filter. [G: latency to hide]"};
    Param<int> cache_lines{*this,  "cache_lines", 256,
                           "line", {1, 1 << 20},  "Lines of 128 bytes in the first-level cache. [G: 32 KiB]"};
    Param<int> cache_ways{*this,
                          "cache_ways",
                          8,
                          "way",
                          {1, 64},
                          "Associativity of the first-level cache. [G]",
                          Effect::kTradeOff};
    Choice<models::Tiling> layout{*this,
                                  "layout",
                                  models::Tiling::kTiled,
                                  {"tiled", "linear", "morton", "williams"},
                                  "Where the driver puts the texels of a texture: tiles of 32x32 that hold "
                                  "the lines of neighbours, rows, "
                                  "Morton order, or Williams' pyramid, whose components lie apart (colours "
                                  "of 4x8 bits; else tiled). [G: "
                                  "GPUs tile; P: Williams 1983]"};
    PolicyParam<models::ReplacementPolicy> replacement{
        *this, "replacement", models::replacement_policies(), models::kLruReplacement,
        "Which line of a full set makes room. [G: as caches are modelled]"};
    Param<int> cache_misses{*this,  "cache_misses", 64,
                            "line", {1, 4096},      "Lines under way. [G: bandwidth times latency]"};
    Choice<FetchedSectors> fetched_sectors{
        *this,
        "fetched_sectors",
        FetchedSectors::kOne,
        {"one", "two", "line"},
        "Sectors of 32 bytes that a miss fetches beside those that were asked for: none, the other one of a "
        "pair, or all of the line. [G: sectored caches]"};
    Choice<BlocksHeld> blocks_held{
        *this,
        "blocks_held",
        BlocksHeld::kCompressed,
        {"compressed", "decoded"},
        "What the first-level cache holds of compressed textures: blocks, decoded for every request that "
        "reads "
        "them, or decoded texels, which take two to 64 times the room. [G: room]"};
    Param<int> decode_blocks_per_clk{
        *this,
        "decode_blocks_per_clk",
        8,
        "block/clk",
        {1, 64},
        "Blocks of compressed textures decoded a cycle. [G: a quad may touch four, two quads a clock]"};
    Param<int> astc_decode_slots{
        *this,
        "astc_decode_slots",
        2,
        "slot",
        {1, 64},
        "Blocks of other codes in whose place the decoder takes one of ASTC, which has integers to unpack "
        "and "
        "weights to interpolate. [G: a texel a clock and decoder is what the code was designed for, KDF]",
        Effect::kSlower};
  };
  struct Stats : StatGroup {
    Histogram latency{*this, "latency", "clk",
                      "Cycles from the arrival of a group of requests to its answer"};
    Counter groups{*this, "groups", "group", "Clauses' request groups taken in"};
    Counter requests{*this, "requests", "request", "Warp texture instructions"};
    Counter lanes{*this, "lanes", "lane", "Lanes that sampled"};
    Counter bilinear_quads{
        *this, "bilinear_quads", "quad",
        "Bilinear quad operations, two a quad for a trilinear one; twice as many for texels "
        "of 8 bytes, four times for 16"};
    Counter texels{*this, "texels", "texel", "Texels read from the cache"};
    Counter blocks_decoded{
        *this, "blocks_decoded", "block",
        "Blocks of compressed textures decoded: distinct ones of a request, or those of the "
        "lines that were fetched"};
    Counter decode_slots{
        *this, "decode_slots", "slot",
        "Places of the decoder that these took: `astc_decode_slots` a block of ASTC, else one"};
    Counter bank_conflict_clk{
        *this, "bank_conflict_clk", "clk",
        "Cycles by which look-ups of groups took longer because their lines met in banks of the tags"};
    Counter cache_emptied{
        *this, "cache_emptied", "time",
        "Times that the cache forgot all lines, since a pass samples what earlier ones drew"};
    Counter groups_answered{*this, "groups_answered", "group", "Groups whose texels went back"};
  };
  using CounterParts = Parts<MemoryPortStats, L1CacheStats, EncodedReadStats, SectorStats>;
  TextureUnit(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
              Store<CoreSlot>& slots);

  FifoIn<TextureToken> request_in{*this, "request_in"};
  FifoOut<TextureToken> response_out{*this, "response_out", LinkRole::kReply};

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const Stats* stats() const override { return &stats_; }
  void audit(Audit& audit) const override;
  void details(Details& details) const override;
  [[nodiscard]] std::vector<Facet> row() const override;
  [[nodiscard]] std::string state_text() const override;
  [[nodiscard]] MemoryPort& memory_port() { return port_; }
  /// Why its cache misses is counted from here on, beside what is counted anyway. Before the run.
  void keep_miss_kinds() { cache_.keep_miss_kinds(); }
  /// Null unless it is kept.
  [[nodiscard]] const MissKindCounts* miss_kinds() const { return cache_.miss_kinds(); }
  [[nodiscard]] const L1CacheStats& cache_stats() const { return cache_.stats(); }
  [[nodiscard]] const MemoryPortStats& port_stats() const { return port_.stats(); }
  [[nodiscard]] const Counter& lanes() const { return stats_.lanes; }
  /// What is asked of each of so many textures is counted from here on. Before the run.
  void keep_use(std::size_t textures) { use_.emplace(textures); }
  /// Null unless it is kept.
  [[nodiscard]] const TextureUseLog* use() const { return use_ ? &*use_ : nullptr; }
  static constexpr MemoryClient kMemoryClient = MemoryClient::kTexture;

 private:
  struct Group {
    TextureToken token;
    int missing = 0;                 ///< look-ups not complete
    std::int64_t filter_cycles = 0;  ///< of the filter, or of the decoder beside it if that takes longer
    std::uint32_t decode_slots = 0;  ///< of the decoder
    Tick arrived = 0, ready = 0;
    std::uint32_t leg_take = 0;  ///< for a log of legs: of its request, or of the latest answer it waited for
  };
  /// A line of memory, or one of decoded texels: then `decoded.blocks` is not 0.
  struct LookUp {
    models::TextureLine line{};
    models::DecodedLine decoded{};
    models::Format format = models::Format::kUndefined;  ///< of the texture, where `decoded` counts
    std::uint32_t texture = 0;                           ///< `TextureState::texture`
  };
  [[nodiscard]] Wake address_wake() const;
  [[nodiscard]] Wake answer_wake() const;
  void begin_pass(PassId pass);
  void take(Tick now);
  void note_leg(Tick now) const;
  /// When the filter is through with the group at the front.
  [[nodiscard]] Tick answered_at(const Group& head) const;
  void plan(CoreSlot& slot, const TextureToken& token, Group& group, std::int64_t& address_cycles);
  void look_up(Tick now);
  void add_look_ups(Group& group, std::uint32_t texture);
  /// Cycles that the tags take for the newest group's look-ups.
  [[nodiscard]] std::int64_t tag_cycles();
  void decode(Group& group, std::uint32_t blocks, models::Format format);
  [[nodiscard]] L1Cache::Result access(const LookUp& line);
  /// The same, and notes for which texture.
  [[nodiscard]] L1Cache::Result access_for_use(const LookUp& line);

  const Params& params_;
  const Frame& frame_;
  const models::DeviceMemory& device_;
  Store<CoreSlot>& slots_;
  Stats stats_;
  MemoryPort port_;
  L1Cache cache_;
  EncodedReadStats encoded_;
  SectorStats sectors_;
  std::optional<TextureUseLog> use_;
  PassId pass_;  ///< of the latest request
  models::TexturePlan plan_;
  WaitingQueue<Group> groups_;
  std::vector<LookUp> lines_;  ///< look-ups of the newest group
  std::vector<models::DecodedLine> decoded_lines_;
  std::size_t next_line_ = 0;
  bool stalled_ = false;
  Tick address_free_ = 0, filter_free_ = 0;
};

}  // namespace quadrille::hw
