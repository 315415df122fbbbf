/// Load-store unit of one core: moves what its warps read from storage buffers and write to them.
///
/// In    request_in   the storage requests of one clause (up to 8 warp instructions)
/// Out   response_out loads and atomic operations of the clause have their results, stores are on their way
/// Mem   loads that miss the first-level cache; stores, which go through it; atomic operations, which the L2
///       cache does
/// Time  the lanes of an instruction are gathered to lines of 128 bytes, `lines_per_clk` a cycle; updates of
///       one word by several lanes are as many. Groups are answered in order, `response_clk` after their last
///       line. A pass begins with an empty cache, since earlier ones may have written.
///
/// Values are there when the instruction has executed (models/memory/storage.h says why that is right): here
/// they take their time.
#pragma once

#include "hw/base/param.h"
#include "hw/base/waiting_queue.h"
#include "hw/frame/tokens.h"
#include "hw/frame/unit_context.h"
#include "hw/memory/l1_cache.h"
#include "hw/memory/memory_port.h"
#include "hw/shader/core_slots.h"
#include "models/shader/storage_lines.h"

namespace quadrille::hw {

class LoadStoreUnit final : public Unit {
 public:
  struct Params : ParamGroup {
    Param<int> lines_per_clk{*this,      "lines_per_clk", 1,
                             "line/clk", {1, 64},         "Lines that go through the unit a cycle. [G]"};
    Param<int> response_clk{
        *this,          "response_clk", 8,
        "clk",          {0, 1 << 16},   "From a group's last line to its answer. [G: lanes get their words]",
        Effect::kSlower};
    Param<int> groups_in_flight{*this,     "groups_in_flight",
                                32,        "group",
                                {1, 4096}, "Clauses' requests that wait for their lines. [G]"};
    Param<int> requests_queued{*this,     "requests_queued",
                               32,        "request",
                               {1, 4096}, "Requests for the L2 cache that wait for their link. [G]"};
    Param<int> cache_lines{*this,  "cache_lines", 128,
                           "line", {1, 1 << 20},  "Lines of 128 bytes in the first-level cache. [G: 16 KiB]"};
    Param<int> cache_ways{*this,
                          "cache_ways",
                          4,
                          "way",
                          {1, 64},
                          "Associativity of the first-level cache. [G]",
                          Effect::kTradeOff};
    Param<int> cache_misses{*this,  "cache_misses", 32,
                            "line", {1, 4096},      "Lines under way. [G: bandwidth times latency]"};
  };
  struct Stats : StatGroup {
    Counter groups{*this, "groups", "group", "Clauses' request groups taken in"};
    Counter requests{*this, "requests", "request", "Warp storage instructions"};
    Counter loads{*this, "loads", "lane", "Words that lanes read"};
    Counter stores{*this, "stores", "lane", "Words that lanes wrote"};
    Counter atomics{*this, "atomics", "lane", "Atomic operations of lanes"};
    Counter lines{*this, "lines", "line",
                  "Lines that instructions touched; several updates of a word count each"};
    Counter groups_answered{*this, "groups_answered", "group", "Groups that were answered"};
  };
  using CounterParts = Parts<MemoryPortStats, L1CacheStats>;
  LoadStoreUnit(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
                Store<CoreSlot>& slots);

  static constexpr MemoryClient kMemoryClient = MemoryClient::kStorage;
  FifoIn<StorageToken> request_in{*this, "request_in"};
  FifoOut<StorageToken> response_out{*this, "response_out", LinkRole::kReply};

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] const Stats* stats() const override { return &stats_; }
  void audit(Audit& audit) const override;
  void details(Details& details) const override;
  [[nodiscard]] std::vector<Facet> row() const override;
  [[nodiscard]] std::string state_text() const override;
  [[nodiscard]] MemoryPort& memory_port() { return port_; }

 private:
  struct Group {
    StorageToken token;
    int missing = 0;  ///< lines without an answer
    Tick ready = 0;
    std::uint32_t leg_take = 0;  ///< for a log of legs: of its request, or of the latest answer it waited for
  };
  struct Line {
    models::StorageLine line;
    models::Op op = models::Op::kLoadBuffer;
  };
  [[nodiscard]] Wake line_wake() const;
  [[nodiscard]] Wake answer_wake() const;
  [[nodiscard]] bool queue_full() const;
  void take(Tick now);
  void gather(const CoreSlot& slot, const StorageToken& token);
  void move_lines(Tick now);
  /// False when there is no place for it now.
  [[nodiscard]] bool move(const Line& moved);

  const Params& params_;
  const Frame& frame_;
  Store<CoreSlot>& slots_;
  Stats stats_;
  MemoryPort port_;
  L1Cache cache_;
  PassId pass_;  ///< of the latest request
  WaitingQueue<Group> groups_;
  std::vector<Line> lines_;  ///< of the newest group
  std::vector<models::StorageLine> gathered_;
  std::size_t next_line_ = 0;
  bool stalled_ = false;  ///< the cache had no place; a fill will make one
  Tick line_free_ = 0;
};

}  // namespace quadrille::hw
