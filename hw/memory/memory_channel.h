/// Memory channel: the DRAM behind one L2 slice and its controller (models/memory/dram/).
///
/// In    request_in    reads and writes of sectors of a line
/// Out   response_out  the sectors of a read
/// Time  a request waits in the controller's queue until its last burst was commanded; an answer leaves when
///       its data have moved. The way to and from the L2 cache is that of the links and takes no place here.
#pragma once

#include "hw/base/param.h"
#include "hw/base/queue.h"
#include "hw/base/unit.h"
#include "hw/frame/tokens.h"
#include "hw/frame/unit_context.h"
#include "models/memory/dram/controller.h"
#include "models/memory/interleave.h"

#include <array>
#include <optional>
#include <unordered_map>

namespace quadrille::hw {

/// Kinds of DRAM that come with the program (configs/memory/).
enum class MemoryKind : std::uint8_t { kDdr4, kLpddr5, kGddr6, kHbm2 };

class MemoryChannel final : public Unit {
 public:
  struct Params;
  struct Stats;
  MemoryChannel(sc_core::sc_module_name name, const UnitContext& context, const Params& params);
  ~MemoryChannel() override;

  FifoIn<MemoryRequest> request_in{*this, "request_in"};
  FifoOut<MemoryResponse> response_out{*this, "response_out", LinkRole::kReply};

  [[nodiscard]] Wake next() const override;
  void act(Tick now) override;
  [[nodiscard]] bool may_run_ahead() const override { return false; }
  [[nodiscard]] const StatGroup* stats() const override;
  /// What it moved on a client's behalf: bytes read, but of write-backs those written.
  [[nodiscard]] const Counter& bytes_of(MemoryClient client) const;
  /// Bytes that are read for texture units are counted by line too, from here on. Before the run.
  void keep_texture_lines() { texture_lines_.emplace(); }
  /// By line; none unless they are kept.
  [[nodiscard]] const std::optional<std::unordered_map<std::uint32_t, std::uint64_t>>& texture_lines() const {
    return texture_lines_;
  }
  void audit(Audit& audit) const override;
  void details(Details& details) const override;
  [[nodiscard]] std::vector<Facet> row() const override;
  void finish_stats(Tick end) override;
  [[nodiscard]] std::string state_text() const override;
  /// Gets every command that goes to the DRAM.
  void set_trace(std::function<void(const models::DramCommand&)> trace) {
    controller_.set_trace(std::move(trace));
  }

 private:
  struct Held {
    MemoryResponse answer;
    MemoryClient client = MemoryClient::kWriteBack;
    std::uint32_t leg_take = 0;  ///< for a log of legs
  };
  struct Answer {
    Tick at = 0;
    MemoryResponse token;
    std::uint32_t leg_take = 0;
  };
  [[nodiscard]] Wake take_wake() const;
  [[nodiscard]] Wake command_wake() const;
  void take(Tick now, std::int64_t cycle);
  void finish(const models::DramDone& done);
  void send(Tick now);
  void note_occupancy(std::int64_t cycle);
  /// So far, of the mean data bus.
  [[nodiscard]] double bus_cycles(models::BusUse use) const;

  const Params& params_;
  models::Interleave interleave_;
  std::optional<std::unordered_map<std::uint32_t, std::uint64_t>> texture_lines_;
  std::unique_ptr<Stats> stats_;
  models::DramController controller_;
  std::vector<Held> held_;  ///< by the id of the request
  std::vector<std::uint32_t> free_ids_;
  std::vector<models::DramDone> done_;
  Queue<Answer> answers_;  ///< in order of time
  std::int64_t occupancy_noted_ = 0;
  std::optional<models::BusAccount::Cycles> bus_at_end_;  ///< once the frame has ended
};

struct MemoryChannel::Params : ParamGroup {
  using Int = Param<int>;
  static constexpr ParamRange<int> kTime{0, 1 << 20};
  Choice<MemoryKind> kind{*this,
                          "kind",
                          MemoryKind::kGddr6,
                          {"ddr4", "lpddr5", "gddr6", "hbm2"},
                          "The standard: sets gpu.memory_mhz and what follows up to column_slots to the "
                          "values of configs/memory/"};
  Int pseudo_channels{*this,   "pseudo_channels",
                      2,       "channel",
                      {1, 16}, "Independent data buses behind the controller. [configs/memory/gddr6.toml]"};
  Int ranks{*this, "ranks", 1, "rank", {1, 16}, "Ranks of a pseudo-channel. [G]", Effect::kTradeOff};
  Int bank_groups{*this,
                  "bank_groups",
                  4,
                  "group",
                  {1, 64},
                  "Bank groups of a rank. [configs/memory/gddr6.toml]",
                  Effect::kTradeOff};
  Int banks{*this,  "banks",   16,
            "bank", {1, 1024}, "Banks of a rank, in all its groups. [configs/memory/gddr6.toml]"};
  Int rows{*this,
           "rows",
           32768,
           "row",
           {1, 1 << 24},
           "Rows of a bank; lines beyond them begin again at the first. [configs/memory/gddr6.toml]",
           Effect::kNeutral};
  Int row_bytes{*this,
                "row_bytes",
                2048,
                "byte",
                {128, 1 << 20},
                "Bytes of an open row. [configs/memory/gddr6.toml]",
                Effect::kTradeOff};
  Int burst_bytes{*this,
                  "burst_bytes",
                  32,
                  "byte",
                  {32, 128},
                  "Bytes of a column command: 32, 64 or 128. [configs/memory/gddr6.toml]",
                  Effect::kTradeOff};
  Int t_burst{*this,          "t_burst",    2,
              "clk",          {1, 1 << 20}, "Data bus cycles of a burst. [configs/memory/gddr6.toml]",
              Effect::kSlower};
  Int t_rcd{*this,          "t_rcd", 15, "clk", kTime, "Activate to read. [configs/memory/gddr6.toml]",
            Effect::kSlower};
  Int t_rcd_wr{*this,          "t_rcd_wr", 9, "clk", kTime, "Activate to write. [configs/memory/gddr6.toml]",
               Effect::kSlower};
  Int t_rp{*this,          "t_rp", 15, "clk", kTime, "Precharge to activate. [configs/memory/gddr6.toml]",
           Effect::kSlower};
  Int t_ras{*this,          "t_ras", 30, "clk", kTime, "Activate to precharge. [configs/memory/gddr6.toml]",
            Effect::kSlower};
  Int t_rc{*this,          "t_rc", 45,
           "clk",          kTime,  "Activate to activate of a bank. [configs/memory/gddr6.toml]",
           Effect::kSlower};
  Int t_cas{*this,          "t_cas", 14,
            "clk",          kTime,   "Read command to its data. [configs/memory/gddr6.toml]",
            Effect::kSlower};
  Int t_cwl{*this,          "t_cwl", 5,
            "clk",          kTime,   "Write command to its data. [configs/memory/gddr6.toml]",
            Effect::kSlower};
  Int t_ccd_s{*this,
              "t_ccd_s",
              2,
              "clk",
              kTime,
              "Column command to column command, other bank group. [configs/memory/gddr6.toml]",
              Effect::kSlower};
  Int t_ccd_l{*this,
              "t_ccd_l",
              3,
              "clk",
              kTime,
              "Column command to column command, same bank group. [configs/memory/gddr6.toml]",
              Effect::kSlower};
  Int t_rrd_s{*this,
              "t_rrd_s",
              4,
              "clk",
              kTime,
              "Activate to activate of another bank, other group. [configs/memory/gddr6.toml]",
              Effect::kSlower};
  Int t_rrd_l{*this,
              "t_rrd_l",
              4,
              "clk",
              kTime,
              "Activate to activate of another bank, same group. [configs/memory/gddr6.toml]",
              Effect::kSlower};
  Int t_faw{*this,          "t_faw", 16,
            "clk",          kTime,   "Window of four activates of a rank. [configs/memory/gddr6.toml]",
            Effect::kSlower};
  Int t_wr{*this,          "t_wr", 15,
           "clk",          kTime,  "End of write data to precharge. [configs/memory/gddr6.toml]",
           Effect::kSlower};
  Int t_wtr_s{
      *this,          "t_wtr_s", 5,
      "clk",          kTime,     "End of write data to read, other bank group. [configs/memory/gddr6.toml]",
      Effect::kSlower};
  Int t_wtr_l{
      *this,          "t_wtr_l", 6,
      "clk",          kTime,     "End of write data to read, same bank group. [configs/memory/gddr6.toml]",
      Effect::kSlower};
  Int t_rtp{*this,          "t_rtp", 4, "clk", kTime, "Read to precharge. [configs/memory/gddr6.toml]",
            Effect::kSlower};
  Int t_rtw{*this,          "t_rtw", 3,
            "clk",          kTime,   "Idle cycles of the data bus between read and write data. [G]",
            Effect::kSlower};
  Int t_rtrs{*this,          "t_rtrs", 0, "clk", kTime, "Idle cycles of the data bus between two ranks. [G]",
             Effect::kSlower};
  Choice<models::DramRefresh> refresh{*this,
                                      "refresh",
                                      models::DramRefresh::kPerBank,
                                      {"none", "all_bank", "per_bank"},
                                      "What a refresh command refreshes. [configs/memory/gddr6.toml]"};
  Int t_refi{*this, "t_refi",     1900,
             "clk", {1, 1 << 30}, "Mean interval of all-bank refreshes. [configs/memory/gddr6.toml]"};
  Int t_rfc{*this,          "t_rfc", 120, "clk", kTime, "All-bank refresh. [configs/memory/gddr6.toml]",
            Effect::kSlower};
  Int t_rfc_pb{*this,          "t_rfc_pb", 60,
               "clk",          kTime,      "Refresh of one bank. [configs/memory/gddr6.toml]",
               Effect::kSlower};
  Int t_rrefd{
      *this,          "t_rrefd", 8,
      "clk",          kTime,     "Refresh of one bank to an activate of another. [configs/memory/gddr6.toml]",
      Effect::kSlower};
  Int refresh_postpone{*this,
                       "refresh_postpone",
                       8,
                       "refresh",
                       {0, 64},
                       "Refreshes that may be postponed while requests wait. [configs/memory/gddr6.toml]",
                       Effect::kTradeOff};
  Param<bool> separate_buses{*this, "separate_buses", false, "",
                             "Row commands have a bus of their own. [configs/memory/hbm2.toml]"};
  Param<bool> shared_commands{*this,
                              "shared_commands",
                              false,
                              "",
                              "Pseudo-channels share the command buses. [configs/memory/hbm2.toml]",
                              Effect::kSlower};
  Int act_slots{
      *this,          "act_slots", 1,
      "clk",          {1, 64},     "Cycles an activate holds its command bus. [configs/memory/gddr6.toml]",
      Effect::kSlower};
  Int column_slots{*this,
                   "column_slots",
                   1,
                   "clk",
                   {1, 64},
                   "Cycles a column command holds its command bus. [configs/memory/gddr6.toml]",
                   Effect::kSlower};

  PolicyParam<models::DramMappingPolicy> mapping{
      *this, "mapping", models::dram_mappings(), models::kRowMapping,
      "What neighbouring lines of a channel lie in: other bank groups, or one row. [G: more row hits]"};
  Param<bool> bank_hash{*this,
                        "bank_hash",
                        true,
                        "",
                        "Banks are exchanged by the row's number. [P: Zhang 2000]",
                        Effect::kTradeOff};
  PolicyParam<models::DramSchedulerPolicy> scheduler{
      *this, "scheduler", models::dram_schedulers(), models::kFirstReadyScheduler,
      "Which request is served: the oldest, or hits to open rows first. [P: Rixner 2000]"};
  Int in_order_ahead{*this,   "in_order_ahead",
                     0,       "request",
                     {0, 64}, "In order: rows of so many requests behind the oldest are opened meanwhile"};
  Int age_cap{*this,
              "age_cap",
              1000,
              "clk",
              kTime,
              "After that long the oldest request goes before younger hits to its bank. [G]",
              Effect::kTradeOff};
  PolicyParam<models::DramWriteDrainPolicy> write_drain{
      *this, "write_drain", models::dram_write_drains(), models::kWatermarkWriteDrain,
      "Writes are served like reads, or kept back and drained in runs. [P: Stuecheli 2010]"};
  Int write_high{*this,
                 "write_high",
                 88,
                 "%",
                 {1, 100},
                 "Part of write_queue that starts a drain. [G: most of it, for long runs]",
                 Effect::kTradeOff};
  Int write_low{
      *this, "write_low", 12, "%", {0, 99}, "Part of write_queue that ends it. [G]", Effect::kTradeOff};
  PolicyParam<models::DramPagePolicyEntry> page{
      *this, "page", models::dram_page_policies(), models::kOpenPages,
      "Rows stay open, close with their last waiting burst, or close after page_idle"};
  Int page_idle{*this,
                "page_idle",
                200,
                "clk",
                kTime,
                "Cycles without a burst after which an adaptive page closes. [G]",
                Effect::kTradeOff};
  Int queue_depth{*this,     "queue_depth",
                  64,        "request",
                  {1, 4096}, "Reads that the controller holds. [G: as many as it needs to find open rows]"};
  Int write_queue{*this,     "write_queue",
                  128,       "request",
                  {1, 4096}, "Writes that the controller holds. [G: they wait for a run, reads do not]"};
  Int path_clk{*this,
               "path_clk",
               60,
               "clk",
               {0, 1 << 20},
               "Controller and wires: GPU cycles, added to link.memory_to_l2's latency. [G: about 100 ns "
               "idle latency in all]",
               Effect::kSlower};

  [[nodiscard]] models::DramControllerParams controller() const;
  /// What the data buses move at most, in a cycle of the memory clock.
  [[nodiscard]] double bytes_per_clk() const;
};

struct MemoryChannel::Stats : StatGroup {
  Counter reads{*this, "reads", "access", "Reads"};
  Counter writes{*this, "writes", "access", "Writes"};
  Counter read_bytes{*this, "read_bytes", "byte", "Bytes read"};
  Counter write_bytes{*this, "write_bytes", "byte", "Bytes written"};
  Counter read_bytes_vertex_fetch{*this, "read_bytes_vertex_fetch", "byte",
                                  "Of the bytes read, those for vertex fetch"};
  Counter read_bytes_texture{*this, "read_bytes_texture", "byte", "The same: for the texture units"};
  Counter read_bytes_storage{*this, "read_bytes_storage", "byte", "The same: for the load-store units"};
  Counter read_bytes_depth{*this, "read_bytes_depth", "byte", "The same: for the depth units"};
  Counter read_bytes_color{*this, "read_bytes_color", "byte", "The same: for the ROPs"};
  Counter read_bytes_scan_out{*this, "read_bytes_scan_out", "byte", "The same: for scan-out"};
  Counter row_hits{*this, "row_hits", "access", "Accesses whose row was open"};
  Counter row_misses{*this, "row_misses", "access", "Accesses whose bank was closed"};
  Counter row_conflicts{*this, "row_conflicts", "access", "Accesses for which another row was closed"};
  Counter activates{*this, "activates", "command", "Rows opened"};
  Counter precharges{*this, "precharges", "command", "Rows closed by a command of their own"};
  Counter read_bursts{*this, "read_bursts", "command", "Read commands"};
  Counter write_bursts{*this, "write_bursts", "command", "Write commands"};
  Counter refreshes{*this, "refreshes", "command", "Refresh commands"};
  Counter bus_busy{*this, "bus_busy", "clk",
                   "Cycles the data bus moved data; of several pseudo-channels the mean, here and below"};
  Counter bus_read{*this, "bus_read", "clk", "Cycles the data bus moved data that were read"};
  Counter bus_write{*this, "bus_write", "clk", "Cycles the data bus moved data that were written"};
  Counter bus_refresh{*this, "bus_refresh", "clk", "Cycles the data bus waited for a refresh to end"};
  Counter bus_turnaround{*this, "bus_turnaround", "clk",
                         "Cycles the data bus waited because it changed direction or rank"};
  Counter bus_activation{*this, "bus_activation", "clk", "Cycles the data bus waited for a row to open"};
  Counter bus_spacing{*this, "bus_spacing", "clk",
                      "Cycles between bursts of a bank group, or for the command bus or the policy"};
  Counter bus_idle{*this, "bus_idle", "clk", "Cycles without a request whose data the bus could have moved"};
  Counter queue_occupancy{*this, "queue_occupancy", "request*clk",
                          "Requests in the controller's queue, summed over the cycles"};
  Histogram latency_vertex_fetch{
      *this, "latency_vertex_fetch", "clk",
      "Histogram of the time from the queue to the last data: reads for vertex fetch"};
  Histogram latency_texture{*this, "latency_texture", "clk", "The same: reads for the texture units"};
  Histogram latency_storage{*this, "latency_storage", "clk", "The same: reads for the load-store units"};
  Histogram latency_depth{*this, "latency_depth", "clk", "The same: reads for the depth units"};
  Histogram latency_color{*this, "latency_color", "clk", "The same: reads for the ROPs"};
  Histogram latency_scan_out{*this, "latency_scan_out", "clk", "The same: reads for scan-out"};
  Histogram latency_write_back{*this, "latency_write_back", "clk", "The same: writes"};
  [[nodiscard]] Histogram& latency(MemoryClient client);
  /// What is moved on a client's behalf: bytes read, but of write-backs those written.
  [[nodiscard]] Counter& bytes(MemoryClient client);
};

}  // namespace quadrille::hw
