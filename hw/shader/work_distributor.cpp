#include "hw/shader/work_distributor.h"

namespace quadrille::hw {

WorkDistributor::WorkDistributor(sc_core::sc_module_name name, const Clock& clock, int partitions, int cores)
    : Unit(name, Kind::kChooser, clock) {
  add_initiation_rate("rate");
  for (int p = 0; p < partitions; ++p) {
    fragment_in.add(*this, fmt::format("fragment_in_{}", p).c_str(), LinkRole::kFlow, kFragmentStream);
  }
  for (int c = 0; c < cores; ++c) {
    vertex_out.push_back(
        std::make_unique<FifoOut<WarpToken>>(*this, fmt::format("vertex_out_{}", c).c_str(), LinkRole::kFlow, kVertexStream));
    fragment_out.push_back(
        std::make_unique<FifoOut<WarpToken>>(*this, fmt::format("fragment_out_{}", c).c_str(), LinkRole::kFlow, kFragmentStream));
  }
}

const FifoOut<WarpToken>& WorkDistributor::first_with_room(const Outputs& outputs) {
  const FifoOut<WarpToken>* first = outputs[0].get();
  for (const auto& out : outputs) {
    if (out->room() < first->room()) first = out.get();
  }
  return *first;
}

Wake WorkDistributor::vertex_wake() const {
  const Wake wake = Wake(vertex_free_).input(vertex_in);
  return vertex_in.ready() == kNever ? wake : Wake(wake).output(first_with_room(vertex_out));
}

Wake WorkDistributor::fragment_wake() const {
  const Wake wake = fragment_in.earliest(Wake(fragment_free_));
  return wake.at() == kNever ? wake : Wake(wake).output(first_with_room(fragment_out));
}

Wake WorkDistributor::next() const { return Wake::sooner(vertex_wake(), fragment_wake()); }

void WorkDistributor::act(Tick now) {
  if (vertex_wake().at() <= now) {
    hand_out(now, vertex_in, vertex_out, vertex_turn_);
    vertex_free_ = after(now, 1);
    ++stats_.vertex_warps;
  }
  if (fragment_wake().at() <= now) {
    fragment_in.visit_holding(partition_turn_, [&](std::size_t p, FifoIn<WarpToken>& in) {
      if (!in.ready_at(now)) return false;
      hand_out(now, in, fragment_out, fragment_turn_);
      fragment_free_ = after(now, 1);
      ++stats_.fragment_warps;
      partition_turn_ = (p + 1) % fragment_in.size();
      return true;
    });
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
