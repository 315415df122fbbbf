#include "hw/shader/work_distributor.h"

namespace quadrille::hw {

WorkDistributor::WorkDistributor(sc_core::sc_module_name name, const Clock& clock, int partitions, int cores)
    : Unit(name, Kind::kChooser, clock) {
  for (int p = 0; p < partitions; ++p) {
    fragment_in.push_back(
        std::make_unique<FifoIn<WarpToken>>(*this, fmt::format("fragment_in_{}", p).c_str(), LinkRole::kFlow, kFragmentStream));
  }
  for (int c = 0; c < cores; ++c) {
    vertex_out.push_back(
        std::make_unique<FifoOut<WarpToken>>(*this, fmt::format("vertex_out_{}", c).c_str(), LinkRole::kFlow, kVertexStream));
    fragment_out.push_back(
        std::make_unique<FifoOut<WarpToken>>(*this, fmt::format("fragment_out_{}", c).c_str(), LinkRole::kFlow, kFragmentStream));
  }
}

Wake WorkDistributor::with_room(Wake input, const Outputs& outputs) {
  const FifoOut<WarpToken>* first = outputs[0].get();
  for (const auto& out : outputs) {
    if (out->room() < first->room()) first = out.get();
  }
  return input.output(*first);
}

Wake WorkDistributor::next() const {
  Wake wake = with_room(Wake(vertex_free_).input(vertex_in), vertex_out);
  for (const auto& in : fragment_in) wake = Wake::sooner(wake, with_room(Wake(fragment_free_).input(*in), fragment_out));
  return wake;
}

void WorkDistributor::act(Tick now) {
  if (with_room(Wake(vertex_free_).input(vertex_in), vertex_out).at() <= now) {
    hand_out(now, vertex_in, vertex_out, vertex_turn_);
    vertex_free_ = after(now, 1);
    ++stats_.vertex_warps;
  }
  for (std::size_t i = 0; i < fragment_in.size(); ++i) {
    FifoIn<WarpToken>& in = *fragment_in[(partition_turn_ + i) % fragment_in.size()];
    if (with_room(Wake(fragment_free_).input(in), fragment_out).at() > now) continue;
    hand_out(now, in, fragment_out, fragment_turn_);
    fragment_free_ = after(now, 1);
    ++stats_.fragment_warps;
    partition_turn_ = (partition_turn_ + i + 1) % fragment_in.size();
    break;
  }
  occupy(now, 1);
}

void WorkDistributor::hand_out(Tick now, FifoIn<WarpToken>& in, Outputs& outputs, std::size_t& turn) {
  // The core with the most free places, the next in turn among equals.
  std::size_t best = outputs.size();
  int most = 0;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const std::size_t c = (turn + i) % outputs.size();
    const int free = outputs[c]->room_at(now) ? outputs[c]->fifo().free_slots(now) : 0;
    if (free > most) {
      most = free;
      best = c;
    }
  }
  outputs[best]->push(now, in.pop(now));
  turn = (best + 1) % outputs.size();
}

}  // namespace quadrille::hw
