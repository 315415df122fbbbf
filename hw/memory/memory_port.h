/// A client's side of the memory system: one request link and one answer link to each L2 slice, and a queue
/// of requests that wait for room.
///
/// Lines are spread over the slices by models/memory/interleave.h.
#pragma once

#include "hw/base/fifo_group.h"
#include "hw/base/queue.h"
#include "hw/frame/tokens.h"
#include "models/memory/interleave.h"

#include <memory>
#include <optional>

namespace quadrille::hw {

/// Traffic of one client, counted where the client asks.
struct MemoryPortStats {
  explicit MemoryPortStats(StatGroup& group)
      : reads{group, "memory_reads", "request", "Read requests sent to the L2 cache"},
        writes{group, "memory_writes", "request", "Write and atomic requests sent to the L2 cache"},
        read_bytes{group, "read_bytes", "byte", "Bytes asked of the L2 cache"},
        write_bytes{group, "write_bytes", "byte", "Bytes written to the L2 cache"} {}
  Counter reads, writes, read_bytes, write_bytes;
};

class MemoryPort {
 public:
  MemoryPort(Unit& owner, StatGroup& stats, int slices);

  /// Queues a request; it leaves as soon as its slice's link has room.
  void read(std::uint32_t line, std::uint8_t sectors, std::uint32_t tag);
  void write(std::uint32_t line, std::uint8_t sectors);
  /// Writes a part of each of these sectors. The link carries them whole, with a mask.
  void write_part(std::uint32_t line, std::uint8_t sectors);
  /// Updates words of these sectors where they are; the answer, with `tag`, brings the sectors back.
  void atomic(std::uint32_t line, std::uint8_t sectors, std::uint32_t tag);
  /// Asks every slice to answer once all earlier requests of this client have been taken in; `answers` counts
  /// them.
  void fence(std::uint32_t tag);

  [[nodiscard]] bool queue_empty() const { return queue_.empty(); }
  [[nodiscard]] std::size_t queued() const { return queue_.size(); }
  /// When the oldest queued request could leave.
  [[nodiscard]] Wake send_wake() const { return Wake().output(*request_out[queue_.front().slice]); }
  /// Sends what has room at `now`, in order.
  void send(Tick now);
  /// When the next answer is there.
  [[nodiscard]] Wake receive_wake() const { return response_in.earliest(); }
  /// Calls `take(answer)` for every answer that is there at `now`, slice by slice.
  template <class Take>
  void receive(Tick now, Take&& take) {
    response_in.take_ready(now, [&](std::size_t, const MemoryResponse& answer) { take(answer); });
  }

  /// The port through which the answer for a line comes.
  [[nodiscard]] const PortBase& answers_of(std::uint32_t line) const {
    return response_in[interleave_.member_of(line)];
  }

  [[nodiscard]] const MemoryPortStats& stats() const { return stats_; }
  void audit(Audit& audit) const;
  /// Its requests are counted by draw; the bytes too where a client has a count for them.
  void details(Details& details, std::optional<DrawCount> bytes = {},
               std::optional<TileCount> bytes_of_tiles = {}) const;
  [[nodiscard]] int slices() const { return static_cast<int>(request_out.size()); }
  std::vector<std::unique_ptr<FifoOut<MemoryRequest>>> request_out;  ///< by slice
  FifoInGroup<MemoryResponse> response_in;

 private:
  struct Queued {
    MemoryRequest request;
    std::uint32_t slice = 0;
  };
  void queue_write(std::uint32_t line, std::uint8_t sectors, MemoryRequest::Kind kind);
  void queue(MemoryRequest request) {
    if (const WorkLog* log = group_.log(); log != nullptr) [[unlikely]]
      request.draw = log->now().draw;
    queue_.push_back({request, interleave_.member_of(request.line)});
  }

  const StatGroup& group_;
  MemoryPortStats stats_;
  models::Interleave interleave_;
  Queue<Queued> queue_;
};

}  // namespace quadrille::hw
