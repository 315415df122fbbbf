/// L2 slice: one bank of the shared cache in front of one memory channel. Write-back, write-allocate,
/// sectored.
///
/// In    request_in[c]    sectors of a line, from client c
///       fill_in          a line's sectors from the channel
/// Out   response_out[c]  answers to reads and fences
///       memory_out       misses and write-backs
/// Time  one request a cycle, clients take turns; updates of one word by atomic requests follow each other at
///       that rate. `hit_clk` after its look-up a hit is answered and a miss goes to the channel; its fill is
///       answered when it comes. A line that is under way serves all who ask for it.
///
/// Ports are named for their client: those of texture_3 are texture_in_3 and texture_out_3.
#pragma once

#include "hw/base/fifo_group.h"
#include "hw/base/param.h"
#include "hw/base/queue.h"
#include "hw/frame/tokens.h"
#include "hw/frame/unit_context.h"
#include "hw/memory/write_back.h"
#include "models/cache/miss_table.h"
#include "models/cache/tag_array.h"
#include "models/memory/interleave.h"

#include <bit>
#include <memory>
#include <optional>

namespace quadrille::hw {

class L2Slice final : public Unit {
 public:
  struct Params : ParamGroup {
    Param<int> cache_lines{*this,  "cache_lines", 4096,
                           "line", {1, 1 << 24},  "Lines of 128 bytes in a slice. [G: 512 KiB]"};
    Param<int> cache_ways{*this, "cache_ways", 16, "way", {1, 64}, "Associativity. [G]", Effect::kTradeOff};
    PolicyParam<models::ReplacementPolicy> replacement{
        *this, "replacement", models::replacement_policies(), models::kLruReplacement,
        "Which line of a full set makes room. [G: as caches are modelled]"};
    Param<int> cache_misses{
        *this,  "cache_misses", 128,
        "line", {1, 65536},     "Lines under way to and from the channel. [G: bandwidth times latency]"};
    Param<int> hit_clk{
        *this,          "hit_clk",    20,
        "clk",          {1, 1 << 20}, "Latency from look-up to answer, or to the channel for a miss. [G]",
        Effect::kSlower};
    PolicyParam<WriteBackPolicy> write_back{
        *this, "write_back", write_back_policies(), kVictimWriteBack,
        "A dirty victim leaves alone, or with the other dirty lines of its block. [P: Lee 2010]"};
    Param<int> write_back_lines{*this,
                                "write_back_lines",
                                128,
                                "line",
                                {1, 4096},
                                "Lines of that block: those that lie in the same rows of all banks. [G]",
                                Effect::kTradeOff};
  };
  struct Stats : StatGroup {
    Counter requests{*this, "requests", "request", "Read and write requests looked up"};
    Counter hits{*this, "hits", "request", "Requests whose sectors were there, and writes of whole sectors"};
    Counter merged{*this, "merged", "request", "Requests whose sectors were on their way already"};
    Counter misses{*this, "misses", "request",
                   "Requests for which a sector was fetched from the memory channel"};
    Counter read_bytes{*this, "read_bytes", "byte", "Bytes answered to clients"};
    Counter write_bytes{*this, "write_bytes", "byte", "Bytes written by clients"};
    Counter surface_write_bytes{*this, "surface_write_bytes", "byte",
                                "Bytes of those that depth units and ROPs wrote"};
    Counter fill_bytes{*this, "fill_bytes", "byte", "Bytes read from the memory channel"};
    Counter writeback_bytes{*this, "writeback_bytes", "byte", "Bytes written back to the memory channel"};
    Counter early_write_backs{*this, "early_write_backs", "line",
                              "Lines written back with a victim of their block"};
  };
  struct Client {
    std::string name;
    MemoryClient kind = MemoryClient::kVertexFetch;
  };
  /// `slices` of the machine, this one among them.
  L2Slice(sc_core::sc_module_name name, const UnitContext& context, const Params& params,
          const std::vector<Client>& clients);

  FifoInGroup<MemoryRequest> request_in;
  std::vector<std::unique_ptr<FifoOut<MemoryResponse>>> response_out;
  FifoIn<MemoryResponse> fill_in{*this, "fill_in", LinkRole::kReply};
  FifoOut<MemoryRequest> memory_out{*this, "memory_out"};

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] bool may_run_ahead() const override { return false; }
  [[nodiscard]] const Stats* stats() const override { return &stats_; }
  void audit(Audit& audit) const override;
  void details(Details& details) const override;
  [[nodiscard]] std::vector<Facet> row() const override;
  [[nodiscard]] std::string state_text() const override;

 private:
  struct Waiter {
    std::uint32_t client = 0;
    MemoryResponse answer;
  };
  struct Answer {
    Tick at = 0;
    MemoryResponse token;
  };
  struct ToMemory {
    Tick at = 0;  ///< the look-up's latency is over
    MemoryRequest token;
  };
  [[nodiscard]] Wake look_up_wake() const;
  [[nodiscard]] bool can_look_up() const;
  void send_answers(Tick now);
  void look_up(Tick now, std::uint32_t client);
  /// False when the line has no place now; nothing was changed.
  bool read(Tick now, std::uint32_t client, const MemoryRequest& request);
  bool write(Tick now, const MemoryRequest& request);
  bool write_part(Tick now, std::uint32_t client, const MemoryRequest& request);
  [[nodiscard]] bool all_there(const MemoryRequest& request) const;
  /// Marks what is written dirty once the rest is there, which is fetched; the tag of the line's miss,
  /// none when the line has no place now.
  std::optional<std::uint32_t> write_when_fetched(Tick now, std::uint32_t client,
                                                  const MemoryRequest& request);
  bool atomic(Tick now, std::uint32_t client, const MemoryRequest& request);
  /// Asks the channel for what the request lacks, and returns the tag of the line's miss; none when the line
  /// has no place now.
  std::optional<std::uint32_t> fetch(Tick now, std::uint32_t client, const MemoryRequest& request);
  [[nodiscard]] int place(Tick now, std::uint32_t line);
  void write_back(Tick now, std::uint32_t line, std::uint8_t sectors);
  void write_back_others(Tick now, std::uint32_t victim);
  void send_to_memory(Tick now);
  void take_fill(Tick now);
  void answer(Tick at, std::uint32_t client, const MemoryResponse& token);
  /// Calls `visit(client)` for the clients that have answers.
  template <class Visit>
  void visit_answering(Visit&& visit) const {
    for (std::size_t w = 0; w < answering_.size(); ++w) {
      for (std::uint64_t bits = answering_[w]; bits != 0; bits &= bits - 1)
        visit(w * 64 + static_cast<std::size_t>(std::countr_zero(bits)));
    }
  }

  const Params& params_;
  Stats stats_;
  models::TagArray tags_;
  models::MissTable<Waiter> misses_;
  std::vector<std::uint8_t> parts_;       ///< by slot: sectors on their way that were written in part
  std::vector<Queue<Answer>> answers_;    ///< by client, in order of time
  std::vector<std::uint64_t> answering_;  ///< a bit a client: it has answers
  Tick answer_due_ = kNever;              ///< no client has an answer due before
  models::Interleave interleave_;
  std::unique_ptr<WriteBack> write_back_;
  std::vector<MemoryClient> client_kinds_;
  Queue<ToMemory> to_memory_;
  std::size_t turn_ = 0;
  bool stalled_ = false;  ///< the line in turn had no place; a fill will make one
  Tick free_ = 0;
};

}  // namespace quadrille::hw
