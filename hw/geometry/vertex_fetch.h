/// Vertex fetch: reads indices and attributes through its cache, finds reused vertices, and forms batches of
/// up to 32 vertices to shade. Of several geometry front ends each takes its ranges of every draw.
///
/// In    draw_in        draws and pass boundaries
///       release_in[e]  engine e is done with the oldest batch
/// Out   warp_out       a batch to shade
///       batch_out      its primitives, and boundaries, in draw order
/// Mem   indices and attributes, 128-byte lines in 32-byte sectors
/// Time  `indices_per_clk` indices and `attributes_per_clk` attribute fetches a cycle, whichever takes
///       longer; a batch leaves when its lines have arrived
///
/// Vertices are reused by batch, through a FIFO of vertices, or not at all
/// (models/geometry/post_transform.h). Under the FIFO the outputs of a batch stay in its slot while a vertex
/// of it is remembered or a primitive on its way names one; the oldest are forgotten rather than that they
/// hold the last slot.
///
/// Front ends share draws by ranges of `range_primitives` (models/geometry/primitive_shares.h). Each gets all
/// draws, finds its ranges by arithmetic, and sends the marks between draws if it is its turn.
///
/// A primitive's indices are looked up one by one, shared ones of a strip or fan again. A special index
/// (primitive restart) costs a look-up like any other.
/// Not modelled: a post-transform store apart from the batches' slots (docs/deviations.md#D2)
#pragma once

#include "hw/base/fifo_group.h"
#include "hw/base/param.h"
#include "hw/base/waiting_queue.h"
#include "hw/frame/stores.h"
#include "hw/frame/unit_context.h"
#include "hw/geometry/batch_slots.h"
#include "hw/memory/l1_cache.h"
#include "hw/memory/memory_port.h"
#include "models/geometry/post_transform.h"
#include "models/geometry/primitive_shares.h"
#include "models/geometry/primitive_walk.h"

namespace quadrille::hw {

class VertexFetch final : public Unit {
 public:
  struct Params : ParamGroup {
    Param<int> indices_per_clk{
        *this,   "indices_per_clk",
        4,       "index/clk",
        {1, 64}, "Indices looked up a cycle. [G: one triangle a cycle and a little more]"};
    Param<int> attributes_per_clk{*this,    "attributes_per_clk",
                                  8,        "fetch/clk",
                                  {1, 256}, "Attribute fetches a cycle. [G: 8 address lanes]"};
    Param<int> batch_slots{*this,     "batch_slots",
                           32,        "batch",
                           {2, 4096}, "Vertex batches between fetch and set-up. [G: covers shading latency]"};
    PolicyParam<models::VertexReusePolicy> reuse{*this, "reuse", models::vertex_reuse_policies(),
                                                 models::kBatchReuse,
                                                 "A vertex is shaded once a batch, once while a FIFO across "
                                                 "batches holds it, or for every corner. [P: "
                                                 "Kerbl 2018]"};
    Param<int> batch_vertices{*this,
                              "batch_vertices",
                              32,
                              "vertex",
                              {3, 32},
                              "Vertices shaded as one warp, of 32 lanes. [P: Kerbl 2018: a GeForce's batch]",
                              Effect::kTradeOff};
    Param<int> batch_triangles{
        *this,
        "batch_triangles",
        32,
        "triangle",
        {1, 1024},
        "Triangles a batch may name. [P: Kerbl 2018: 32 on a GeForce, 128 on a Radeon]",
        Effect::kTradeOff};
    Param<int> reuse_entries{
        *this,
        "reuse_entries",
        32,
        "vertex",
        {3, 1024},
        "Vertices that the FIFO of reuse=fifo holds; no use otherwise. [G: as many as a batch]",
        Effect::kTradeOff};
    Param<int> range_primitives{
        *this,
        "range_primitives",
        128,
        "primitive",
        {1, 1 << 20},
        "Primitives in a row that one of several geometry front ends takes before the next one does; no use "
        "with one. [G: four batches, so that few vertices are shaded twice]",
        Effect::kTradeOff};
    Param<int> cache_lines{*this,  "cache_lines", 128,
                           "line", {1, 1 << 16},  "Lines of 128 bytes in the vertex cache. [G: 16 KiB]"};
    Param<int> cache_ways{
        *this, "cache_ways", 4, "way", {1, 64}, "Associativity of the vertex cache. [G]", Effect::kTradeOff};
    Param<int> cache_misses{
        *this,  "cache_misses", 64,
        "line", {1, 4096},      "Lines the vertex cache may have under way. [G: bandwidth times latency]"};
  };
  struct Stats : StatGroup {
    Counter indices{*this, "indices", "index",
                    "Indices read (vertex numbers, when a draw has no index buffer)"};
    Counter vertices{*this, "vertices", "vertex", "Vertices put into batches, each to be shaded once"};
    Counter attribute_fetches{*this, "attribute_fetches", "fetch", "Attributes fetched"};
    Counter batches{*this, "batches", "batch", "Vertex batches formed"};
    Counter triangles{*this, "triangles", "triangle", "Triangles named by batches"};
  };
  using CounterParts = Parts<MemoryPortStats, L1CacheStats>;

  VertexFetch(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
              Store<BatchSlot>& batches);

  FifoIn<DrawToken> draw_in{*this, "draw_in"};
  FifoInGroup<ReleaseToken> release_in;  ///< by raster engine
  FifoOut<VertexWarpToken> warp_out{*this, "warp_out"};
  FifoOut<BatchToken> batch_out{*this, "batch_out"};

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const Stats* stats() const override { return &stats_; }
  void audit(Audit& audit) const override;
  void details(Details& details) const override;
  [[nodiscard]] std::vector<Facet> row() const override;
  [[nodiscard]] std::string state_text() const override;
  [[nodiscard]] MemoryPort& memory_port() { return port_; }
  static constexpr MemoryClient kMemoryClient = MemoryClient::kVertexFetch;

 private:
  /// A batch or a boundary on its way out, in order.
  struct Pending {
    TokenKind kind = TokenKind::kWork;
    FramePart part;
    std::uint32_t slot = 0;
    int missing = 0;  ///< look-ups not complete
    Tick ready = 0;
  };
  struct Line {
    std::uint32_t line;
    std::uint8_t sectors;
  };
  [[nodiscard]] Wake build_wake() const;
  [[nodiscard]] Wake leave_wake() const;
  void take_releases(Tick now);
  void build(Tick now);
  void look_up(Tick now);
  /// A batch may name vertices of earlier ones only; then there is nothing to shade.
  [[nodiscard]] bool shades(const Pending& head) const;
  void leave(Tick now);
  void start_draw(DrawId draw);
  void start_instance();
  /// Goes to the next range of this front end. Is there one with a primitive?
  bool start_range();
  /// Is there another primitive in this range?
  [[nodiscard]] bool primitive_left();
  void form_batch(Tick now);
  /// Takes primitives into the batch while they fit.
  void take_primitives(BatchSlot& batch);
  /// Counts the index at a position, and its bytes among the look-ups of this batch.
  void fetch_index(std::uint32_t position);
  /// Does so for the special indices that the walk has passed.
  void fetch_passed();
  void fetch_attributes(BatchSlot& batch);
  void touch_bytes(std::uint64_t address, std::uint32_t bytes);
  /// Number of a line among the look-ups of this batch; adds it if it is new.
  [[nodiscard]] std::size_t touched_line(std::uint32_t line);

  const Params& params_;
  const Frame& frame_;
  const models::DeviceMemory& device_;
  Store<BatchSlot>& batches_;
  Stats stats_;
  std::vector<std::uint64_t> released_by_;  ///< batches, by raster engine
  std::uint64_t released_ = 0;              ///< by all of them
  MemoryPort port_;
  L1Cache cache_;
  std::unique_ptr<models::VertexReuse> reuse_;

  static constexpr std::uint32_t kNoInstance = ~std::uint32_t{0};
  bool drawing_ = false;
  DrawId draw_;
  std::uint32_t instance_ = kNoInstance;
  models::PrimitiveWalk walk_;         ///< at the next primitive to take
  std::vector<std::uint32_t> passed_;  ///< positions of special indices that no batch has paid for
  models::PrimitiveShares shares_;
  std::uint32_t range_end_ = 0;  ///< the primitive behind the last one of the range
  BatchSlots slots_;
  WaitingQueue<Pending> pending_;
  std::vector<Line> lines_;       ///< look-ups of the newest batch
  std::size_t next_line_ = 0;     ///< the first of them not done
  std::size_t last_touched_ = 0;  ///< the one of them that was needed last
  bool stalled_ = false;          ///< the cache had no place for it
  std::uint32_t fetches_ = 0, indices_ = 0;
  Tick free_ = 0;
};

}  // namespace quadrille::hw
