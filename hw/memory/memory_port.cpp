#include "hw/memory/memory_port.h"

#include "models/memory/device_memory.h"

#include <bit>

namespace quadrille::hw {

MemoryPort::MemoryPort(Unit& owner, StatGroup& stats, int slices) : stats_(stats) {
  for (int i = 0; i < slices; ++i) {
    request_out.push_back(std::make_unique<FifoOut<MemoryRequest>>(owner, fmt::format("memory_out_{}", i).c_str(), LinkRole::kReply));
    response_in.push_back(std::make_unique<FifoIn<MemoryResponse>>(owner, fmt::format("memory_in_{}", i).c_str(), LinkRole::kReply));
  }
}

void MemoryPort::read(std::uint32_t line, std::uint8_t sectors, std::uint32_t tag) {
  ++stats_.reads;
  stats_.read_bytes += models::kSectorBytes * static_cast<unsigned>(std::popcount(sectors));
  queue_.push_back({line, tag, sectors, MemoryRequest::Kind::kRead});
}

void MemoryPort::write(std::uint32_t line, std::uint8_t sectors) {
  ++stats_.writes;
  stats_.write_bytes += models::kSectorBytes * static_cast<unsigned>(std::popcount(sectors));
  queue_.push_back({line, 0, sectors, MemoryRequest::Kind::kWrite});
}

void MemoryPort::fence(std::uint32_t tag) {
  // Any line of each slice will do: consecutive lines of a group visit every slice once.
  for (int i = 0; i < slices(); ++i) queue_.push_back({static_cast<std::uint32_t>(i), tag, 0, MemoryRequest::Kind::kFence});
}

Wake MemoryPort::send_wake() const {
  const std::uint32_t slice = slice_of(queue_.front().line, static_cast<std::uint32_t>(slices()));
  return Wake().output(*request_out[slice]);
}

void MemoryPort::send(Tick now) {
  while (!queue_.empty()) {
    FifoOut<MemoryRequest>& out = *request_out[slice_of(queue_.front().line, static_cast<std::uint32_t>(slices()))];
    if (!out.room_at(now)) return;
    out.push(now, queue_.front());
    queue_.pop_front();
  }
}

Wake MemoryPort::receive_wake() const {
  Wake first = Wake().input(*response_in[0]);
  for (std::size_t i = 1; i < response_in.size(); ++i) first = Wake::sooner(first, Wake().input(*response_in[i]));
  return first;
}

std::optional<MemoryResponse> MemoryPort::receive(Tick now) {
  for (auto& in : response_in) {
    if (in->ready_at(now)) return in->pop(now);
  }
  return std::nullopt;
}

}  // namespace quadrille::hw
