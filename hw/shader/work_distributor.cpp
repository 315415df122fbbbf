#include "hw/shader/work_distributor.h"

#include "hw/frame/laws.h"

#include <fmt/ranges.h>

namespace quadrille::hw {

WorkDistributor::WorkDistributor(sc_core::sc_module_name name, const UnitContext& context,
                                 const Params& params)
    : Unit(name, Kind::kChooser, context.clock),
      distribution_(params.policy.value().make({static_cast<std::uint32_t>(context.machine.cores),
                                                static_cast<std::uint32_t>(params.block_tiles.value())})),
      by_place_(distribution_->by_place()),
      loads_(static_cast<std::size_t>(context.machine.cores), 0) {
  add_initiation_rate("rate");
  for (int p = 0; p < context.machine.partitions; ++p) {
    fragment_in.add(*this, fmt::format("fragment_in_{}", p).c_str(), LinkRole::kFlow, kFragmentStream);
  }
  for (int i = 0; i < context.machine.partitions + context.machine.front_ends; ++i)
    load_in.add(*this, fmt::format("load_in_{}", i).c_str(), LinkRole::kReply);
  for (int f = 0; f < context.machine.front_ends; ++f) {
    const std::string port = context.front_end_port("vertex_in", f);
    vertex_in.add(*this, port.c_str(), LinkRole::kFlow, kVertexStream);
  }
  for (int c = 0; c < context.machine.cores; ++c) {
    vertex_out.push_back(std::make_unique<FifoOut<VertexWarpToken>>(
        *this, fmt::format("vertex_out_{}", c).c_str(), LinkRole::kFlow, kVertexStream));
    fragment_out.push_back(std::make_unique<FifoOut<FragmentWarpToken>>(
        *this, fmt::format("fragment_out_{}", c).c_str(), LinkRole::kFlow, kFragmentStream));
  }
}

std::string WorkDistributor::state_text() const {
  return fmt::format("warps out by core: {}", fmt::join(loads_, ", "));
}

template <class Token>
const FifoOut<Token>& WorkDistributor::first_with_room(const Outputs<Token>& outputs) {
  const FifoOut<Token>* first = outputs[0].get();
  for (const auto& out : outputs) {
    if (out->room() < first->room()) first = out.get();
  }
  return *first;
}

Wake WorkDistributor::vertex_wake() const {
  Wake first = vertex_in.earliest(Wake(vertex_free_));
  if (first.at() == kNever) return first;
  return first.output(first_with_room(vertex_out));
}

Wake WorkDistributor::fragment_wake() const {
  Wake first = fragment_in.earliest(Wake(fragment_free_));
  if (first.at() == kNever) return first;
  if (!by_place_) return Wake(first).output(first_with_room(fragment_out));
  bool any = false;
  fragment_in.visit_holding(0, [&](std::size_t, FifoIn<FragmentWarpToken>& in) {
    const Wake wake =
        Wake(fragment_free_).input(in).output(*fragment_out[distribution_->core_at(in.front())]);
    first = any ? Wake::sooner(first, wake) : wake;
    any = true;
    return false;
  });
  return first;
}

Wake WorkDistributor::next() const {
  return Wake::sooner(Wake::sooner(vertex_wake(), fragment_wake()), load_in.earliest());
}

void WorkDistributor::act(Tick now) {
  load_in.take_ready(now, [&](std::size_t, const ReleaseToken& done) { --loads_[done.slot]; });
  if (vertex_wake().at() <= now) hand_out_vertices(now);
  if (fragment_wake().at() <= now) hand_out_fragments(now);
}

void WorkDistributor::hand_out_vertices(Tick now) {
  vertex_in.visit_holding(front_end_turn_, [&](std::size_t f, FifoIn<VertexWarpToken>& in) {
    if (!in.ready_at(now)) return false;
    hand_out(now, in, vertex_out, choose(now, vertex_out, vertex_turn_), vertex_turn_);
    vertex_free_ = after(now, 1);
    ++stats_.vertex_warps;
    front_end_turn_ = (f + 1) % vertex_in.size();
    return true;
  });
}

void WorkDistributor::hand_out_fragments(Tick now) {
  fragment_in.visit_holding(partition_turn_, [&](std::size_t p, FifoIn<FragmentWarpToken>& in) {
    if (!in.ready_at(now)) return false;
    const std::size_t core =
        by_place_ ? distribution_->core_at(in.front()) : choose(now, fragment_out, fragment_turn_);
    if (core == Distribution::kNone || !fragment_out[core]->room_at(now)) return false;
    hand_out(now, in, fragment_out, core, fragment_turn_);
    fragment_free_ = after(now, 1);
    ++stats_.fragment_warps;
    partition_turn_ = (p + 1) % fragment_in.size();
    return true;
  });
}

template <class Token>
std::size_t WorkDistributor::choose(Tick now, const Outputs<Token>& outputs, std::size_t turn) const {
  Distribution::Cores cores{.loads = loads_, .next = turn};
  for (std::size_t c = 0; c < outputs.size(); ++c)
    cores.with_room |= std::uint64_t{outputs[c]->room_at(now)} << c;
  return distribution_->choose(cores);
}

template <class Token>
void WorkDistributor::hand_out(Tick now, FifoIn<Token>& in, Outputs<Token>& outputs, std::size_t core,
                               std::size_t& turn) {
  stats_.working_for(in.front().draw);
  outputs[core]->push(now, in.pop(now));
  ++loads_[core];
  turn = (core + 1) % outputs.size();
  occupy(now, 1);
}

void WorkDistributor::audit(Audit& audit) const {
  audit.right(laws::kWarpsPacked, stats_.fragment_warps.value());
  audit.left(laws::kWarpsDistributed, stats_.fragment_warps.value());
}

std::vector<Facet> WorkDistributor::row() const {
  return {count("vertex warps", stats_.vertex_warps), count("fragment warps", stats_.fragment_warps)};
}

}  // namespace quadrille::hw
