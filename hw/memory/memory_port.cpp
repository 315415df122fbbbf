#include "hw/memory/memory_port.h"

#include "hw/frame/detail_counts.h"
#include "hw/frame/laws.h"

#include "models/memory/device_memory.h"

#include <algorithm>

namespace quadrille::hw {

MemoryPort::MemoryPort(Unit& owner, StatGroup& stats, int slices)
    : group_(stats), stats_(stats), interleave_(static_cast<std::uint32_t>(std::max(slices, 1))) {
  for (int i = 0; i < slices; ++i) {
    request_out.push_back(std::make_unique<FifoOut<MemoryRequest>>(
        owner, fmt::format("memory_out_{}", i).c_str(), LinkRole::kReply));
    response_in.add(owner, fmt::format("memory_in_{}", i).c_str(), LinkRole::kReply);
  }
}

void MemoryPort::read(std::uint32_t line, std::uint8_t sectors, std::uint32_t tag) {
  ++stats_.reads;
  stats_.read_bytes += models::sector_bytes(sectors);
  queue({line, tag, sectors, MemoryRequest::Kind::kRead});
}

void MemoryPort::write(std::uint32_t line, std::uint8_t sectors) {
  queue_write(line, sectors, MemoryRequest::Kind::kWrite);
}

void MemoryPort::write_part(std::uint32_t line, std::uint8_t sectors) {
  queue_write(line, sectors, MemoryRequest::Kind::kWritePart);
}

void MemoryPort::atomic(std::uint32_t line, std::uint8_t sectors, std::uint32_t tag) {
  const std::uint64_t bytes = models::sector_bytes(sectors);
  ++stats_.writes;
  stats_.write_bytes += bytes;
  stats_.read_bytes += bytes;
  queue({line, tag, sectors, MemoryRequest::Kind::kAtomic});
}

void MemoryPort::queue_write(std::uint32_t line, std::uint8_t sectors, MemoryRequest::Kind kind) {
  ++stats_.writes;
  stats_.write_bytes += models::sector_bytes(sectors);
  queue({line, 0, sectors, kind});
}

void MemoryPort::fence(std::uint32_t tag) {
  // Any line of each slice will do: consecutive lines of a group visit every slice once.
  for (int i = 0; i < slices(); ++i)
    queue({static_cast<std::uint32_t>(i), tag, 0, MemoryRequest::Kind::kFence});
}

void MemoryPort::send(Tick now) {
  while (!queue_.empty()) {
    FifoOut<MemoryRequest>& out = *request_out[queue_.front().slice];
    if (!out.room_at(now)) return;
    out.push(now, queue_.front().request);
    queue_.pop_front();
  }
}

void MemoryPort::audit(Audit& audit) const {
  audit.left(laws::kClientRequests, stats_.reads.value() + stats_.writes.value());
  audit.left(laws::kClientReads, stats_.read_bytes.value());
  audit.left(laws::kClientWrites, stats_.write_bytes.value());
}

void MemoryPort::details(Details& details, std::optional<DrawCount> bytes,
                         std::optional<TileCount> bytes_of_tiles) const {
  for (const Counter* requests : {&stats_.reads, &stats_.writes})
    details.by_draw(DrawCount::kClientRequests, *requests);
  for (const Counter* moved : {&stats_.read_bytes, &stats_.write_bytes}) {
    if (bytes) details.by_draw(*bytes, *moved);
    if (bytes_of_tiles) details.by_tile(*bytes_of_tiles, *moved);
  }
}

}  // namespace quadrille::hw
